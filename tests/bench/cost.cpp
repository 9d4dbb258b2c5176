// SPDX-License-Identifier: Apache-2.0
#include "bench/cost.h"

#include <algorithm>
#include <array>
#include <vector>

#include "bench/core_speed.h"

namespace knead::bench {
namespace {

constexpr double kFloat = 4;
constexpr double kIndex = 4;
/// A number of a factor: two bytes are enough for a preconditioner (the runtime stores 16-bit fixed point).
constexpr double kFactorNumber = 2;
/// What a tetrahedron is: four indices, nine numbers of the inverse rest edges, mu and lambda times volume.
constexpr double kElementBytes = 4 * kIndex + 11 * kFloat;
constexpr double kRotationBytes = 4 * kFloat;  // a quaternion
constexpr double kGradientBytes = 9 * kFloat;  // the fourth is minus the sum of three
constexpr double kVectorBytes = 4 * kFloat;    // a node's three numbers, padded

// Operations on one tetrahedron; a multiply-add counts as two.
constexpr double kEdges = 9;
constexpr double kMatrixProduct = 45;  // 3x3 times 3x3
constexpr double kQuaternionToMatrix = 21;
constexpr double kRotationStep = 45 + 3 + 10 + 30 + 40;  // R^T F, gradient, Hessian, its solution, turn
constexpr double kStress = 18 + 6 + 27;                  // 2 mu (F - R) + lambda tr(..) R
constexpr double kScatter = 9 + 12;                      // fourth column, four sums
constexpr double kSymmetricStress = 9 + 6 + 6;

/// 3x3 blocks below the diagonal of the factor that eliminates the unknown nodes in the asset's order.
double count_factor_blocks(const Body& body) {
    std::vector<int> row(static_cast<std::size_t>(body.rest_m.cols()), -1);
    for (std::size_t i = 0; i < body.active.size(); ++i)
        row[body.active[i]] = static_cast<int>(i);
    // Column j of the factor: its neighbours, and the columns whose first entry below the diagonal is j.
    std::vector<std::vector<int>> column(body.active.size());
    for (const Body::Element& e : body.elements)
        for (const std::uint32_t a : e.nodes)
            for (const std::uint32_t b : e.nodes)
                if (row[a] >= 0 && row[b] > row[a])
                    column[static_cast<std::size_t>(row[a])].push_back(row[b]);
    double count = 0;
    for (std::vector<int>& below : column) {
        std::sort(below.begin(), below.end());
        below.erase(std::unique(below.begin(), below.end()), below.end());
        count += static_cast<double>(below.size());
        if (below.size() < 2) continue;
        std::vector<int>& parent = column[static_cast<std::size_t>(below.front())];
        parent.insert(parent.end(), below.begin() + 1, below.end());
        std::vector<int>().swap(below);
    }
    return count;
}

Work times(const Work& work, double count) {
    return {work.bytes * count, work.flops * count};
}

}  // namespace

StepSizes step_sizes(const Body& body) {
    StepSizes sizes;
    sizes.tetrahedra = static_cast<double>(body.elements.size());
    sizes.nodes = static_cast<double>(body.free_count);
    sizes.unknown_nodes = static_cast<double>(body.active.size());
    sizes.factor_blocks = count_factor_blocks(body);
    return sizes;
}

Work element_pass_work(const StepSizes& s) {
    // Reads the element, reads and writes its rotation, writes its rotated gradients for the products;
    // positions, velocities and forces once per node.
    return {s.tetrahedra * (kElementBytes + 2 * kRotationBytes + kGradientBytes) + s.nodes * 4 * kVectorBytes,
            s.tetrahedra * (kEdges + 3 * kMatrixProduct + 2 * kQuaternionToMatrix + kRotationStep + kStress +
                            kScatter) +
                s.nodes * 12};
}

Work product_work(const StepSizes& s) {
    // Indices, rotated gradients, mu and lambda: as much as an element at rest.
    return {s.tetrahedra * kElementBytes + s.nodes * 2 * kVectorBytes,
            s.tetrahedra * (kEdges + 2 * kMatrixProduct + kSymmetricStress + kScatter) + s.nodes * 6};
}

Work factor_work(const StepSizes& s) {
    // Every block once on the way down and once on the way up; the inverted diagonal blocks in between.
    return {
        2 * s.factor_blocks * 9 * kFactorNumber + s.unknown_nodes * (9 * kFactorNumber + 2 * kVectorBytes),
        2 * s.factor_blocks * 18 + s.unknown_nodes * 18};
}

Work scalar_factor_work(const StepSizes& s) {
    return {2 * s.factor_blocks * kFactorNumber + s.unknown_nodes * (kFactorNumber + 2 * kVectorBytes),
            2 * s.factor_blocks * 6 + s.unknown_nodes * 3};
}

Work jacobi_work(const StepSizes& s) {
    return {s.unknown_nodes * (9 * kFloat + 2 * kVectorBytes), s.unknown_nodes * 15};
}

Work vector_work(const StepSizes& s) {
    // Displacement, residual and direction are updated; two scalar products run along.
    return {s.unknown_nodes * 8 * kVectorBytes, s.unknown_nodes * 3 * 10};
}

Bound step_bound(const StepSizes& sizes, double jacobi_iterations, double flops_per_s) {
    struct Candidate {
        const char* method;
        double iterations;
        Work preconditioner;
    };
    const std::array<Candidate, 3> candidates{{{"3x3 factor", 1, factor_work(sizes)},
                                               {"scalar factor", 2, scalar_factor_work(sizes)},
                                               {"block Jacobi", jacobi_iterations, jacobi_work(sizes)}}};
    Bound best;
    for (const Candidate& c : candidates) {
        const std::array<Work, 4> parts{element_pass_work(sizes), times(product_work(sizes), c.iterations),
                                        times(c.preconditioner, c.iterations),
                                        times(vector_work(sizes), c.iterations)};
        Bound bound;
        bound.method = c.method;
        for (const Work& part : parts) {
            bound.work.bytes += part.bytes;
            bound.work.flops += part.flops;
        }
        // What stays from step to step: elements and rotations, node vectors, the preconditioner.
        const double working_set = sizes.tetrahedra * (kElementBytes + kRotationBytes + kGradientBytes) +
                                   sizes.nodes * 8 * kVectorBytes + 0.5 * c.preconditioner.bytes;
        bound.flops_per_s = flops_per_s;
        bound.bytes_per_s = measure_read_bytes_per_s(static_cast<std::size_t>(working_set));
        for (const Work& part : parts)
            bound.us += 1e6 * std::max(part.bytes / bound.bytes_per_s, part.flops / flops_per_s);
        if (best.method.empty() || bound.us < best.us) best = bound;
    }
    return best;
}

}  // namespace knead::bench
