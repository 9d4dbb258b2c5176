// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "bake/skin.h"
#include "knead/formats/asset.h"
#include "knead/formats/material.h"
#include "scene/scene.h"

namespace knead::tools {

/// Turns one level's object into what the runtime needs, and only that: held nodes last, free nodes in METIS
/// nested-dissection order, tetrahedra whose four nodes are all held left out, elasticities as a palette with
/// an index per tetrahedron, the nodes that each tool may touch.
///
/// @param skin the surface that scene.embedding names; unused when the scene has none
///
/// Throws ToolError(bad_input) when a selection of the scene finds no node, when nothing can move, or when
/// the object breaks an invariant of Asset; messages name the line of the scene.
/// The result depends on the arguments only.
[[nodiscard]] Asset bake(const Scene& scene, const Level& level, const MaterialObject& object,
                         const Skin& skin = {});

}  // namespace knead::tools
