// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/evaluation.h"
#include "evaluate/prepared_scene.h"

namespace knead::tools {

/// A fine object of one seed, and where it comes to rest under each load: what all methods are measured
/// against.
struct EvaluatedObject {
    MaterialObject fine;
    std::string hash;                      ///< of mesh and elasticities
    std::vector<StaticAnswer> references;  ///< [loads] displacements of the reference's mesh
};

/// One method on one mesh of one object.
struct CellTask {
    const PreparedScene* scene = nullptr;
    const EvaluatedObject* object = nullptr;
    const PreparedMesh* level = nullptr;
    Method method;
    std::uint64_t seed = 0;
};

/// What a method makes of an object: the mesh (the level's, unless the method makes its own) and its
/// elasticities.
struct CoarseObject {
    const PreparedMesh* mesh = nullptr;
    std::shared_ptr<PreparedMesh> own_mesh;  ///< set when the method made it
    Material material;                       ///< with tensors: its densities only
    std::vector<ElasticityTensor> tensors;   ///< kmod09: [tetrahedra]; else empty
    std::string problem;                     ///< why the method has no answer, or empty
    [[nodiscard]] bool runs_in_the_runtime() const { return tensors.empty() && problem.empty(); }
};
[[nodiscard]] CoarseObject make_coarse_object(const CellTask& task);

/// The reference of one load, from the cache or solved.
[[nodiscard]] StaticAnswer reference_answer(const PreparedScene& scene, const EvaluatedObject& object,
                                            std::size_t load, ReferenceKind kind, const ResultCache& cache);

/// All loads of one task, in their order; times and bytes are left open. Only what the cache does not know is
/// computed.
[[nodiscard]] std::vector<CellResult> evaluate_cells(const CellTask& task, ReferenceKind kind,
                                                     const ResultCache& cache);

}  // namespace knead::tools
