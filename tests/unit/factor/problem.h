// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/factor/rest_matrix.h"
#include "core/simd/kernels.h"
#include "support/kuhn_cube.h"

namespace knead::test {

/// A jittered box of tetrahedra as a Model, made without the runtime's own builder: the nodes of the planes
/// z = 0 and z = top are held if `hold`, the others stand in a random order.
struct ProblemOptions {
    std::uint32_t cells = 3;
    bool hold = true;
    double contrast = 100;
    double poissons_ratio = 0.3;
    std::uint64_t seed = 7;
};

inline core::Model make_problem(const ProblemOptions& options) {
    TetMesh mesh = kuhn_cube(options.cells);
    jitter(mesh, 0.1 / options.cells, 0.1, options.seed);
    std::mt19937_64 engine(options.seed);
    const auto plane = static_cast<std::size_t>((options.cells + 1) * (options.cells + 1));
    const std::size_t count = mesh.nodes_m.size();
    std::vector<std::uint32_t> order;
    const auto held = [&](std::size_t i) { return options.hold && (i < plane || i >= count - plane); };
    for (std::uint32_t i = 0; i < count; ++i)
        if (!held(i)) order.push_back(i);
    for (std::size_t k = order.size(); k > 1; --k)
        std::swap(order[k - 1], order[engine() % k]);
    core::Model model;
    model.free_count = static_cast<std::uint32_t>(order.size());
    for (std::uint32_t i = 0; i < count; ++i)
        if (held(i)) order.push_back(i);
    std::vector<std::uint32_t> place(count);
    for (std::uint32_t p = 0; p < count; ++p)
        place[order[p]] = p;
    model.mass_kg.assign(count, 0);
    for (const Tetrahedron& t : mesh.tetrahedra) {
        core::Element element;
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 3; ++d)
                edges(d, k) = mesh.nodes_m[t[k + 1]][d] - mesh.nodes_m[t[0]][d];
        const double volume = edges.determinant() / 6;
        const double e = 1e4 * (engine() % 2 == 0 ? 1.0 : options.contrast);
        const double nu = options.poissons_ratio;
        element.rest_inverse = edges.inverse();
        element.mu_volume = volume * e / (2 * (1 + nu));
        element.lambda_volume = volume * e * nu / ((1 + nu) * (1 - 2 * nu));
        for (int k = 0; k < 4; ++k) {
            element.nodes[k] = place[t[k]];
            model.mass_kg[place[t[k]]] += volume * 1000 / 4;
        }
        model.elements.push_back(element);
    }
    return model;
}

/// The matrix of a RestMatrix, dense.
inline Eigen::MatrixXd dense(const core::RestMatrix& matrix) {
    const auto& pattern = matrix.pattern();
    const int b = matrix.block_size();
    const auto n = static_cast<Eigen::Index>(pattern.node_count);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(b * n, b * n);
    for (std::uint32_t j = 0; j < pattern.node_count; ++j)
        for (std::uint32_t k = pattern.column_begin[j]; k < pattern.column_begin[j + 1]; ++k) {
            const Eigen::Map<const Eigen::MatrixXd> block(matrix.values() + std::size_t{k} * b * b, b, b);
            const Eigen::Index row = pattern.row_nodes[k];
            result.block(b * row, b * j, b, b) = block;
            result.block(b * j, b * row, b, b) = block.transpose();
        }
    return result;
}

/// In [-1, 1].
inline double random_number(std::mt19937_64& engine) {
    return 2.0 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 1.0;
}
inline Eigen::VectorXd random_vector(std::size_t size, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Eigen::VectorXd v(static_cast<Eigen::Index>(size));
    for (double& x : v)
        x = random_number(engine);
    return v;
}

inline std::vector<core::SimdTarget> simd_targets() {
    std::vector<core::SimdTarget> targets;
    for (const auto target : {core::SimdTarget::portable, core::SimdTarget::avx2, core::SimdTarget::avx512})
        if (core::has_simd_target(target)) targets.push_back(target);
    return targets;
}

}  // namespace knead::test
