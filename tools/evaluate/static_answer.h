// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/loads.h"
#include "evaluate/scene_tool.h"
#include "knead/formats/material.h"

namespace knead::tools {

/// A load as one mesh takes it.
struct MeshLoad {
    std::string name;
    AppliedLoad applied;             ///< what is prescribed; for a tool that touches and leaves: what is held
    std::optional<ToolPress> press;  ///< of a tool of the scene
    /// Touches and leaves: solved with contact instead of prescribed nodes.
    [[nodiscard]] bool in_contact() const { return press && press->tool.contact != ToolContact::bonded; }
    /// Everything that a result depends on, as text.
    [[nodiscard]] std::string fingerprint() const;
};

/// Where an object comes to rest under a load, and what the hand feels there.
struct StaticAnswer {
    bool converged = false;
    std::string problem;                ///< why not, or empty
    double force_n = 0;                 ///< felt
    std::vector<Point> displacement_m;  ///< [nodes]
    int linear_solves = 0;
};

/// Asks the reference solver. What it finds no equilibrium for comes back as not converged.
/// @param tensors [tetrahedra] instead of the material's elasticities, or empty; not for tools that touch and
///     leave
[[nodiscard]] StaticAnswer solve(const TetMesh& mesh, const Material& material, const MeshLoad& load,
                                 const std::vector<ElasticityTensor>& tensors = {});

/// To keep an answer in a cache, and back. @return nothing when the bytes are not an answer
[[nodiscard]] std::string to_bytes(const StaticAnswer& answer);
[[nodiscard]] std::optional<StaticAnswer> answer_of(const std::string& bytes);

}  // namespace knead::tools
