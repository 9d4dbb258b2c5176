// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// How the numbers of a factor are stored.
enum class FactorStorage : std::uint8_t {
    single_precision,
    fixed_point_16,  ///< whole numbers of 16 bits, one float as the unit of each column of the factor
    double_precision,
};

/// How the panel of a supernode with m columns and r rows below them is stored, in numbers (not nodes).
///
/// The panel is [W; -L_R W], W the inverse of the supernode's triangle: m + r rows, m columns. In fixed point
/// the rows of W are divided by its diagonal, so that all of a panel are transfers of force, without unit and
/// of similar size; the squared diagonal is stored beside it. The panel's rows,
/// padded with zeros to a multiple of `lanes`, are cut into tiles of `lanes` rows, its columns into strips of
/// nearly equal width. A strip is stored tile by tile, from the tile of its first column (above is W's zero
/// triangle), a tile column by column: both directions of a solve read memory as it lies. In fixed point two
/// columns lie together, lane by lane in the high and the low half of 32 bits: the high half is used with the
/// low one as its fraction, so that one shift makes two numbers.
struct FactorLayout {
    std::uint32_t block = 3;       ///< numbers of a node: 3 or 1
    std::uint32_t lanes = 16;      ///< rows of a tile
    std::uint32_t max_width = 24;  ///< columns of a strip; a multiple of `block`
    bool pairs = false;            ///< columns are stored two together; a strip has an even number of them

    /// Columns of storage for a strip of `width` columns.
    [[nodiscard]] std::size_t stored_width(std::size_t width) const noexcept {
        return pairs ? (width + 1) / 2 * 2 : width;
    }

    /// Columns of all strips but the last, which may have fewer. @param columns in nodes
    [[nodiscard]] std::uint32_t strip_width(std::uint32_t columns) const noexcept {
        const std::uint32_t nodes = max_width / block;
        const std::uint32_t strips = (columns + nodes - 1) / nodes;
        return block * ((columns + strips - 1) / strips);
    }

    /// Numbers stored for a panel. @param columns, rows in nodes
    [[nodiscard]] std::size_t value_count(std::size_t columns, std::size_t rows) const noexcept {
        const std::size_t width = strip_width(static_cast<std::uint32_t>(columns));
        const std::size_t m = columns * block;
        const std::size_t tiles = ((columns + rows) * block + lanes - 1) / lanes;
        std::size_t count = 0;
        for (std::size_t c = 0; c < m; c += width)
            count += (tiles - c / lanes) * lanes * stored_width(c + width < m ? width : m - c);
        return count;
    }
};

/// A factor as solves read it: A^-1 = G^T G with G the product of all panels. Plain pointers; owns nothing.
struct FactorView {
    struct Supernode {
        std::uint32_t first;    ///< place of the first column
        std::uint32_t columns;  ///< nodes
        std::uint32_t rows_begin;
        std::uint32_t row_count;  ///< nodes below the columns
        std::size_t values_begin;
    };
    FactorLayout layout;
    const Supernode* supernodes = nullptr;
    std::size_t supernode_count = 0;
    const std::uint32_t* rows = nullptr;      ///< places
    const std::uint32_t* place_of = nullptr;  ///< [node_count]
    std::size_t node_count = 0;
    const void* values = nullptr;
    std::size_t own_stride = 0;       ///< numbers of a vector as long as the longest panel, with room beyond
    const float* units = nullptr;     ///< [node_count * block] of each column, by place; fixed point only
    const float* diagonal = nullptr;  ///< [node_count * block] of W, squared, by place; fixed point only
};

/// The inner loops of SupernodalFactor, one set per instruction set.
struct FactorKernels {
    std::uint32_t vector_bytes;
    std::uint32_t strip_width_blocks;  ///< layout.max_width for block 3
    std::uint32_t strip_width_scalar;  ///< layout.max_width for block 1

    /// out = A^-1 rhs, three numbers for each node, node order. A scalar factor solves the three directions
    /// at once. @param rhs may be out  @param scratch aligned, as long as SupernodalFactor::Scratch makes it
    void (*solve_float)(const FactorView&, FactorStorage, const float* rhs, float* out, float* scratch);
    void (*solve_double)(const FactorView&, const double* rhs, double* out, double* scratch);
    /// Three vectors at once, one after the other in memory, block 3 only.
    void (*solve_three_float)(const FactorView&, FactorStorage, const float* rhs, float* out, float* scratch);
    void (*solve_three_double)(const FactorView&, const double* rhs, double* out, double* scratch);

    /// x -= the columns times their factors. @param columns [count] arrays of `size` numbers, 64-byte aligned
    void (*subtract_columns)(std::size_t size, std::size_t count, const float* const* columns,
                             const float* factors, float* x);

    /// c -= a b: c is rows x columns, a is rows x depth, both column-major; b(k, j) = b[k * bk + j * bj].
    /// Computes whole vectors: reads and writes up to a vector beyond the last row of each column.
    void (*subtract_product)(std::size_t rows, std::size_t columns, std::size_t depth, const double* a,
                             std::size_t lda, const double* b, std::size_t bk, std::size_t bj, double* c,
                             std::size_t ldc);
    /// Cholesky factor of the lower triangle of `a`, in place, and its inverse (`inverse` is n x n
    /// column-major, zero above the diagonal). False: not positive definite, or not finite.
    bool (*factor_block)(std::size_t n, double* a, std::size_t lda, double* inverse);
    /// Stores one strip: `tiles` tiles of `width` columns out of x. False: a number cannot be represented.
    /// @param units [width] out, fixed point only
    bool (*store_strip)(FactorStorage, std::size_t rows, std::size_t tiles, std::size_t width,
                        const double* x, std::size_t ldx, void* out, float* units);
};

}  // namespace knead::core
