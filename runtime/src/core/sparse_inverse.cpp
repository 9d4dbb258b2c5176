// SPDX-License-Identifier: Apache-2.0
#include "core/sparse_inverse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace knead::core {
namespace {

/// Cholesky factor of the lower triangle, in place, column-major. Column by column, so that the inner loop
/// has no sum to wait for. @return false: not positive definite
bool factor(double* a, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        double* const column = a + j * n;
        for (std::size_t k = 0; k < j; ++k) {
            const double* const before = a + k * n;
            const double times = before[j];
            for (std::size_t i = j; i < n; ++i)
                column[i] -= before[i] * times;
        }
        if (!(column[j] > 0)) return false;
        column[j] = std::sqrt(column[j]);
        for (std::size_t i = j + 1; i < n; ++i)
            column[i] /= column[j];
    }
    return true;
}

constexpr std::size_t kLanes = 4;  ///< three and one for the width of a vector

/// The last three columns of L^-T, side by side in rows of kLanes. @param l column-major
void solve_last_three(const double* l, std::size_t n, double* x) {
    for (std::size_t i = n; i-- > 0;) {
        const double* const column = l + i * n;
        std::array<double, kLanes> sum{};
        if (i + 3 >= n) sum[i + 3 - n] = 1;
        for (std::size_t k = i + 1; k < n; ++k)
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                sum[lane] -= column[k] * x[kLanes * k + lane];
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            x[kLanes * i + lane] = sum[lane] / column[i];
    }
}

}  // namespace

template <class S>
SparseInverse<S>::SparseInverse(const MatrixPattern& pattern, const Kernels& kernels)
    : pattern_(pattern),
      kernels_(kernels.sparse<S>()),
      row_begin_(pattern.node_count + 1, 0),
      between_(pattern.node_count) {
    // Columns of the lower triangle are the rows of the upper one.
    for (const std::uint32_t row : pattern.row_nodes)
        ++row_begin_[row + 1];
    for (std::size_t i = 0; i < pattern.node_count; ++i) {
        most_ = std::max<std::size_t>(most_, 3 * row_begin_[i + 1]);
        row_begin_[i + 1] += row_begin_[i];
    }
    nodes_.resize(pattern.row_nodes.size());
    mirror_.resize(pattern.row_nodes.size());
    std::vector<std::uint32_t> next(row_begin_.begin(), row_begin_.end() - 1);
    for (std::uint32_t j = 0; j < pattern.node_count; ++j) {
        for (std::uint32_t k = pattern.column_begin[j]; k < pattern.column_begin[j + 1]; ++k) {
            const std::uint32_t at = next[pattern.row_nodes[k]]++;
            nodes_[at] = j;
            mirror_[at] = k;
        }
    }
    arrange(row_begin_, nodes_, lower_);
    arrange(pattern.column_begin, pattern.row_nodes, upper_);
    small_.resize(most_ * most_);
    solution_.resize(kLanes * most_);
    local_.assign(pattern.node_count, kElsewhere);
}

template <class S>
void SparseInverse<S>::arrange(const std::vector<std::uint32_t>& row_begin,
                               const std::vector<std::uint32_t>& columns, Groups& groups) const {
    const std::size_t at_once = kernels_.at_once, rows = pattern_.node_count;
    const auto length = [&](std::uint32_t row) { return row_begin[row + 1] - row_begin[row]; };
    std::vector<std::uint32_t> order(rows);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return length(a) > length(b); });
    groups.place.resize(columns.size());
    groups.begin.assign(1, 0);
    // Rows missing in the last group: the zeros behind the last node.
    const auto nobody = static_cast<std::int32_t>(4 * rows);
    for (std::size_t first = 0; first < rows; first += at_once) {
        const std::uint32_t begin = groups.begin.back(), longest = length(order[first]);
        groups.begin.push_back(begin + longest);
        groups.columns.resize(at_once * (begin + longest), nobody);
        for (std::size_t lane = 0; lane < at_once; ++lane) {
            const bool real = first + lane < rows;
            groups.rows.push_back(real ? static_cast<std::int32_t>(4 * order[first + lane]) : nobody);
            if (!real) continue;
            const std::uint32_t row = order[first + lane];
            for (std::uint32_t k = 0; k < length(row); ++k) {
                const std::uint32_t block = row_begin[row] + k;
                groups.columns[at_once * (begin + k) + lane] = static_cast<std::int32_t>(4 * columns[block]);
                groups.place[block] = static_cast<std::uint32_t>(12 * at_once * (begin + k) + 4 * lane);
            }
        }
    }
    groups.blocks = AlignedArray<S>(12 * at_once * groups.begin.back());
}

template <class S>
void SparseInverse<S>::make(const double* values, std::uint32_t first, std::uint32_t last) noexcept {
    for (std::uint32_t row = first; row < last; ++row)
        make_row(values, row);
}

/// The small matrix over the nodes of a row, column-major; zero where the pattern has none. Only its lower
/// triangle of blocks is set.
template <class S>
void SparseInverse<S>::gather(const double* values, std::uint32_t row) noexcept {
    const std::uint32_t begin = row_begin_[row];
    const std::size_t count = row_begin_[row + 1] - begin, n = 3 * count;
    std::fill_n(small_.data(), n * n, 0.0);
    for (std::size_t a = 0; a < count; ++a)
        local_[nodes_[begin + a]] = static_cast<std::uint32_t>(a);
    for (std::size_t b = 0; b < count; ++b) {
        const std::uint32_t node = nodes_[begin + b];
        for (std::uint32_t k = pattern_.column_begin[node]; k < pattern_.column_begin[node + 1]; ++k) {
            const std::uint32_t other = pattern_.row_nodes[k];
            if (other > row) break;
            if (local_[other] == kElsewhere) continue;
            const double* const block = values + std::size_t{9} * k;
            double* const to = small_.data() + 3 * b * n + 3 * std::size_t{local_[other]};
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t r = 0; r < 3; ++r)
                    to[c * n + r] = block[3 * c + r];
        }
    }
    for (std::size_t a = 0; a < count; ++a)
        local_[nodes_[begin + a]] = kElsewhere;
}

template <class S>
void SparseInverse<S>::make_row(const double* values, std::uint32_t row) noexcept {
    const std::uint32_t begin = row_begin_[row];
    const std::size_t count = row_begin_[row + 1] - begin, n = 3 * count;
    gather(values, row);
    // A matrix that is positive definite is so over any nodes; if rounding says otherwise, the old row stays.
    if (!factor(small_.data(), n)) return;
    // Row block of G, transposed.
    solve_last_three(small_.data(), n, solution_.data());
    const std::size_t width = 4 * kernels_.at_once;
    for (std::size_t a = 0; a < count; ++a) {
        S* const lower = lower_.blocks.data() + lower_.place[begin + a];
        S* const upper = upper_.blocks.data() + upper_.place[mirror_[begin + a]];
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) {
                const auto g = static_cast<S>(solution_[kLanes * (3 * a + c) + r]);  // G(r, c)
                lower[width * c + r] = g;
                upper[width * r + c] = g;
            }
        }
    }
}

template <class S>
BlockGroups<S> SparseInverse<S>::view(const Groups& groups) noexcept {
    return {groups.begin.size() - 1, groups.begin.data(), groups.rows.data(), groups.columns.data(),
            groups.blocks.data()};
}

template <class S>
void SparseInverse<S>::apply(const NodeField<S>& v, NodeField<S>& out) const noexcept {
    kernels_.multiply(view(lower_), v.data(), between_.data());
    kernels_.multiply(view(upper_), between_.data(), out.data());
}

template class SparseInverse<float>;
template class SparseInverse<double>;

}  // namespace knead::core
