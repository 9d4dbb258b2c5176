// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "evaluate/cell.h"

namespace knead::tools {

// What the runtime says of an object and how fast. A cell of the method kmod09 is not for it.

/// The runtime can be asked for the scene's tools, and for the press as long as its nodes are simply those of
/// a tool.
[[nodiscard]] bool runtime_knows(const MeshLoad& load);

/// Presses the object until nothing moves: fills runtime_force_n, and problem where it does not come to rest.
void ask_runtime(const PreparedScene& scene, const CoarseObject& coarse, const MeshLoad& load,
                 CellResult& cell);

/// Force over time of the first load that the runtime can do.
[[nodiscard]] std::optional<CurveResult> evaluate_curve(const CellTask& task, const ResultCache& cache);

/// The reference's force over time under the same load: the raw elasticities on the fine mesh, in the
/// runtime.
[[nodiscard]] std::optional<CurveResult> reference_curve(const PreparedScene& scene,
                                                         const EvaluatedObject& object, std::uint64_t seed,
                                                         const ResultCache& cache);

/// Fills step, load_ms and asset_bytes of the cells of a task, if the runtime can run it.
void time_cells(const CellTask& task, int steps, const ResultCache& cache, std::vector<CellResult>& cells);

/// Runtime and plain baseline on one task, which `method` names in the report; nothing where the scene's
/// first tool is not bonded (the baseline knows no contact).
[[nodiscard]] std::optional<SpeedResult> time_speed(const CellTask& task, const std::string& method,
                                                    int steps, const ResultCache& cache);

/// What is in the asset of a material on a mesh.
[[nodiscard]] std::vector<AssetGroup> groups_in_asset(const PreparedScene& scene,
                                                      const MaterialObject& object);

}  // namespace knead::tools
