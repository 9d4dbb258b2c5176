// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/factor/aligned_array.h"
#include "core/types.h"

namespace knead::core {

/// Numbers of the first `nodes` nodes, rounded up to a whole run of the kernels (field_kernels.h). What
/// stands there of further nodes must not matter.
constexpr std::size_t run_of(std::size_t nodes) {
    return (4 * nodes + 15) / 16 * 16;
}

/// A vector for every node, as the kernels want it: x, y, z, 0. Behind the last node stands one of zeros,
/// which lanes without a tetrahedron read and write. S is float or double.
template <class S>
class NodeField {
  public:
    NodeField() = default;
    explicit NodeField(std::size_t nodes) : numbers_(run_of(nodes + 1)) {}

    [[nodiscard]] Vec get(std::size_t node) const noexcept {
        const S* const x = numbers_.data() + 4 * node;
        return {static_cast<Real>(x[0]), static_cast<Real>(x[1]), static_cast<Real>(x[2])};
    }
    void set(std::size_t node, const Vec& value) noexcept {
        for (int k = 0; k < 3; ++k)
            numbers_[4 * node + k] = static_cast<S>(value[k]);
    }
    void add(std::size_t node, const Vec& value) noexcept { set(node, get(node) + value); }

    void fill_zero() noexcept { std::fill_n(data(), size(), S(0)); }
    /// Rounded, if this is narrower. @param other of as many nodes
    template <class T>
    void copy(const NodeField<T>& other) noexcept {
        std::transform(other.data(), other.data() + size(), data(), [](T x) { return static_cast<S>(x); });
    }

    [[nodiscard]] S* data() noexcept { return numbers_.data(); }
    [[nodiscard]] const S* data() const noexcept { return numbers_.data(); }
    /// All numbers; a whole number of the kernels' runs.
    [[nodiscard]] std::size_t size() const noexcept { return numbers_.size(); }

  private:
    AlignedArray<S> numbers_;
};

}  // namespace knead::core
