// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/asset_json.h"

namespace knead::tools {
namespace {

const char* word(ToolShape shape) {
    switch (shape) {
        case ToolShape::plate:
            return "plate";
        case ToolShape::sphere:
            return "sphere";
        case ToolShape::capsule:
            return "capsule";
    }
    return "?";
}

const char* word(ToolContact contact) {
    switch (contact) {
        case ToolContact::bonded:
            return "bonded";
        case ToolContact::sticking:
            return "sticking";
        case ToolContact::frictionless:
            return "frictionless";
        case ToolContact::coulomb:
            return "coulomb";
    }
    return "?";
}

}  // namespace

nlohmann::ordered_json asset_json(const Asset& asset, const std::string& content_hash, std::size_t tool) {
    const ToolSet& set = asset.tools[tool];
    return {{"name", asset.name},
            {"level", asset.level},
            {"content_hash", content_hash},
            {"nodes", asset.nodes_m.size()},
            {"tetrahedra", asset.tetrahedra.size()},
            {"tool",
             {{"index", tool},
              {"name", set.name},
              {"shape", word(set.shape)},
              {"contact", word(set.contact)},
              {"nodes", set.nodes.size()}}}};
}

}  // namespace knead::tools
