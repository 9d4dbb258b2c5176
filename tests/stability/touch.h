// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "stability/contact_scene.h"

namespace knead::test {

/// A tool above the cube.
struct Touch {
    ToolShape shape;
    ToolContact contact;
};

inline std::string name_of(const Touch& touch) {
    const char* const shape = touch.shape == ToolShape::plate    ? "plate"
                              : touch.shape == ToolShape::sphere ? "sphere"
                                                                 : "capsule";
    const char* const contact = touch.contact == ToolContact::sticking       ? "sticking"
                                : touch.contact == ToolContact::frictionless ? "frictionless"
                                                                             : "coulomb";
    return std::string(shape) + "_" + contact;
}

inline void PrintTo(const Touch& touch, std::ostream* out) {
    *out << name_of(touch);
}

/// Every shape with every unilateral contact.
inline std::vector<Touch> all_touches() {
    std::vector<Touch> touches;
    for (const ToolShape shape : {ToolShape::plate, ToolShape::sphere, ToolShape::capsule})
        for (const ToolContact contact :
             {ToolContact::frictionless, ToolContact::sticking, ToolContact::coulomb})
            touches.push_back({shape, contact});
    return touches;
}

inline ContactScene touched_cube(const Touch& touch, std::uint32_t cells) {
    Asset asset = scenario_cube(cells);
    asset.tools = {tool_above(asset, touch.shape, touch.contact)};
    return scene_of(asset);
}

}  // namespace knead::test
