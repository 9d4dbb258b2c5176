// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace knead::core {

/// Where a symmetric matrix over nodes may be other than zero: its lower triangle in compressed columns.
///
/// Column j has the rows row_nodes[column_begin[j] .. column_begin[j + 1]), ascending, the first of them j.
struct MatrixPattern {
    std::uint32_t node_count = 0;
    std::vector<std::uint32_t> column_begin;  ///< [node_count + 1]
    std::vector<std::uint32_t> row_nodes;     ///< [column_begin.back()]
};

}  // namespace knead::core
