// SPDX-License-Identifier: Apache-2.0
#include "core/factor/rest_matrix.h"

#include <algorithm>
#include <array>

namespace knead::core {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr int kPairs = 10;

/// Rows of each column with repetitions, then each once and sorted.
MatrixPattern build_pattern(const Model& model) {
    const std::uint32_t n = model.free_count;
    MatrixPattern pattern;
    pattern.node_count = n;
    std::vector<std::uint32_t> ends(n + 1, 0);
    const auto for_pairs = [&](auto&& visit) {
        for (const Element& element : model.elements)
            for (const std::uint32_t i : element.nodes)
                for (const std::uint32_t j : element.nodes)
                    if (j < i && i < n) visit(i, j);
    };
    for_pairs([&](std::uint32_t, std::uint32_t j) { ++ends[j + 1]; });
    for (std::uint32_t j = 0; j < n; ++j)
        ends[j + 1] += ends[j];
    std::vector<std::uint32_t> repeated(ends[n]);
    std::vector<std::uint32_t> next(ends.begin(), ends.end() - (n > 0 ? 1 : 0));
    for_pairs([&](std::uint32_t i, std::uint32_t j) { repeated[next[j]++] = i; });

    pattern.column_begin.assign(n + 1, 0);
    pattern.row_nodes.reserve(n + repeated.size() / 2);
    std::vector<std::uint32_t> seen(n, kNone);
    for (std::uint32_t j = 0; j < n; ++j) {
        pattern.row_nodes.push_back(j);
        for (std::uint32_t k = ends[j]; k < ends[j + 1]; ++k) {
            if (seen[repeated[k]] == j) continue;
            seen[repeated[k]] = j;
            pattern.row_nodes.push_back(repeated[k]);
        }
        std::sort(pattern.row_nodes.begin() + pattern.column_begin[j] + 1, pattern.row_nodes.end());
        pattern.column_begin[j + 1] = static_cast<std::uint32_t>(pattern.row_nodes.size());
    }
    return pattern;
}

std::uint32_t find_entry(const MatrixPattern& pattern, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t row = std::max(a, b), column = std::min(a, b);
    if (row >= pattern.node_count) return kNone;
    const auto begin = pattern.row_nodes.begin() + pattern.column_begin[column];
    const auto end = pattern.row_nodes.begin() + pattern.column_begin[column + 1];
    return static_cast<std::uint32_t>(std::lower_bound(begin, end, row) - pattern.row_nodes.begin());
}

}  // namespace

RestMatrix::RestMatrix(const Model& model, Kind kind) : kind_(kind), pattern_(build_pattern(model)) {
    pairs_.reserve(model.elements.size() * kPairs);
    for (const Element& element : model.elements)
        for (int a = 0; a < 4; ++a)
            for (int b = a; b < 4; ++b)
                pairs_.push_back(find_entry(pattern_, element.nodes[a], element.nodes[b]));
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
