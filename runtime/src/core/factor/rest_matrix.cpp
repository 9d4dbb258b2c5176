// SPDX-License-Identifier: Apache-2.0
#include "core/factor/rest_matrix.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace knead::core {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr int kPairs = 10;

/// The elements around each unknown node, in compressed rows.
struct Surroundings {
    std::vector<std::uint32_t> begin, elements;

    explicit Surroundings(const Model& model) : begin(model.free_count + 1, 0) {
        const auto for_each = [&](auto&& visit) {
            for (std::uint32_t e = 0; e < model.elements.size(); ++e)
                for (const std::uint32_t node : model.elements[e].nodes)
                    if (node < model.free_count) visit(node, e);
        };
        for_each([&](std::uint32_t node, std::uint32_t) { ++begin[node + 1]; });
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        elements.resize(begin.back());
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        for_each([&](std::uint32_t node, std::uint32_t e) { elements[next[node]++] = e; });
    }
};

/// Row after row, so that the rows of each column come in order. @param use called with row and column, once
/// for each entry
template <class Use>
void for_each_entry(const Model& model, const Surroundings& around, Use&& use) {
    std::vector<std::uint32_t> seen(model.free_count, kNone);
    for (std::uint32_t i = 0; i < model.free_count; ++i) {
        seen[i] = i;
        use(i, i);
        for (std::uint32_t k = around.begin[i]; k < around.begin[i + 1]; ++k) {
            for (const std::uint32_t j : model.elements[around.elements[k]].nodes) {
                if (j >= i || seen[j] == i) continue;
                seen[j] = i;
                use(i, j);
            }
        }
    }
}

/// Number of the pair of an element's nodes a and b, in the order (0, 0), (0, 1), ..., (3, 3).
int pair_number(int a, int b) {
    const int low = std::min(a, b), high = std::max(a, b);
    return low * (7 - low) / 2 + high;
}

/// @param pairs out: [elements][kPairs] entry of each pair of nodes, kNone unless both are unknowns
MatrixPattern build_pattern(const Model& model, std::vector<std::uint32_t>& pairs) {
    const std::uint32_t n = model.free_count;
    const Surroundings around(model);
    MatrixPattern pattern;
    pattern.node_count = n;
    pattern.column_begin.assign(n + 1, 0);
    for_each_entry(model, around, [&](std::uint32_t, std::uint32_t j) { ++pattern.column_begin[j + 1]; });
    std::partial_sum(pattern.column_begin.begin(), pattern.column_begin.end(), pattern.column_begin.begin());
    pattern.row_nodes.resize(pattern.column_begin.back());
    std::vector<std::uint32_t> next(pattern.column_begin.begin(), pattern.column_begin.end() - 1);
    for_each_entry(model, around,
                   [&](std::uint32_t i, std::uint32_t j) { pattern.row_nodes[next[j]++] = i; });

    // Row after row again: the entry that a column comes to next is that of this row.
    std::copy(pattern.column_begin.begin(), pattern.column_begin.end() - 1, next.begin());
    pairs.assign(model.elements.size() * kPairs, kNone);
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t k = around.begin[i]; k < around.begin[i + 1]; ++k) {
            const std::uint32_t e = around.elements[k];
            const auto& nodes = model.elements[e].nodes;
            const auto own = static_cast<int>(std::find(nodes.begin(), nodes.end(), i) - nodes.begin());
            for (int b = 0; b < 4; ++b) {
                const std::uint32_t j = nodes[static_cast<std::size_t>(b)];
                if (j > i) continue;
                while (pattern.row_nodes[next[j]] < i)
                    ++next[j];
                pairs[std::size_t{e} * kPairs + static_cast<std::size_t>(pair_number(own, b))] = next[j];
            }
        }
    }
    return pattern;
}

}  // namespace

RestMatrix::RestMatrix(const Model& model, Kind kind) : kind_(kind), pattern_(build_pattern(model, pairs_)) {
    for (std::uint32_t i = 0; i < pattern_.node_count; ++i)
        mass_kg_.push_back(static_cast<double>(model.mass_kg[i]));
    const auto block = static_cast<std::size_t>(block_size());
    stiffness_.resize(pattern_.row_nodes.size() * block * block);
    values_.resize(stiffness_.size());
    for (std::size_t e = 0; e < model.elements.size(); ++e)
        add_element(model.elements[e], &pairs_[e * kPairs], nullptr);
    set(0, 1);
}

void RestMatrix::rotate(const Model& model, const Mat* rotations) noexcept {
    if (kind_ == Kind::laplacian) return;
    std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
    for (std::size_t e = 0; e < model.elements.size(); ++e)
        add_element(model.elements[e], &pairs_[e * kPairs], &rotations[e]);
}

void RestMatrix::add_element(const Element& element, const std::uint32_t* pairs,
                             const Mat* rotation) noexcept {
    std::array<std::array<double, 3>, 4> g{};
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 3; ++d) {
            double component = static_cast<double>(element.rest_inverse(k, d));
            if (rotation != nullptr) {
                component = 0;
                for (int c = 0; c < 3; ++c)
                    component += static_cast<double>((*rotation)(d, c)) *
                                 static_cast<double>(element.rest_inverse(k, c));
            }
            g[k + 1][d] = component;
            g[0][d] -= component;
        }
    const auto mu = static_cast<double>(element.mu_volume);
    const auto lambda = static_cast<double>(element.lambda_volume);
    for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b) {
            const std::uint32_t entry = *pairs++;
            if (entry == kNone) continue;
            // The entry belongs to the greater node's row.
            const bool swap = element.nodes[a] < element.nodes[b];
            const auto& row = g[swap ? b : a];
            const auto& column = g[swap ? a : b];
            const double dot = row[0] * column[0] + row[1] * column[1] + row[2] * column[2];
            if (kind_ == Kind::laplacian) {
                stiffness_[entry] += (2 * mu + lambda) * dot;
                continue;
            }
            double* block = &stiffness_[std::size_t{9} * entry];
            for (int c = 0; c < 3; ++c) {
                for (int r = 0; r < 3; ++r)
                    block[3 * c + r] += lambda * row[r] * column[c] + mu * column[r] * row[c];
                block[4 * c] += mu * dot;
            }
        }
}

void RestMatrix::set(double dt_s, double inertia) noexcept {
    const double dt2 = dt_s * dt_s;
    for (std::size_t k = 0; k < values_.size(); ++k)
        values_[k] = dt2 * stiffness_[k];
    const std::size_t block = kind_ == Kind::elastic ? 9 : 1;
    for (std::uint32_t j = 0; j < pattern_.node_count; ++j)
        for (std::size_t d = 0; d < block; d += 4)
            values_[pattern_.column_begin[j] * block + d] += inertia * mass_kg_[j];
}

}  // namespace knead::core
