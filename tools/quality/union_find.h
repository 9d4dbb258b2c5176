// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace knead::tools {

/// Which of n things are connected, after being told pairs that are.
class UnionFind {
  public:
    explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }

    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    /// The smaller root stays, so that the result does not depend on the order of the pairs.
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a < b) parent_[b] = a;
        if (b < a) parent_[a] = b;
    }

    /// Component of each thing, numbered from 0 by their first member.
    std::vector<std::uint32_t> labels() {
        std::vector<std::uint32_t> label(parent_.size());
        std::uint32_t count = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i)
            label[i] = root(i) == i ? count++ : label[root(i)];
        return label;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace knead::tools
