// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "core/simd/factor_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {
namespace panels {

// Four doubles are wider than the registers of the portable set; all is inlined, no ABI is concerned.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

#define KNEAD_INLINE [[gnu::always_inline]] inline
#define KNEAD_INLINE_LAMBDA __attribute__((always_inline))

// ---- Stored numbers
// ----------------------------------------------------------------------------------------

/// A number in fixed point, half of a pair.
struct Fixed {
    std::int16_t bits;
};

template <class S>
constexpr int kLanes = KNEAD_SIMD_BYTES / static_cast<int>(sizeof(S));
template <class S>
using Wide = Vector<S, kLanes<S>>;
template <class S>
using Quad = Vector<S, 4>;

template <class V, class S>
KNEAD_INLINE V load(const S* p) {
    V v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
template <class V, class S>
KNEAD_INLINE void store(S* p, const V& v) {
    __builtin_memcpy(p, &v, sizeof v);
}

/// Columns as they are stored for a strip of `Width`.
template <int Width, class T>
constexpr int kStored = sizeof(T) == 2 ? (Width + 1) / 2 * 2 : Width;

/// Calls use(c, column c of the tile as it is computed with) for all columns.
template <int Width, class S, class Use>
KNEAD_INLINE void for_columns(const S* tile, const Use& use) {
#pragma GCC unroll 24
    for (int c = 0; c < Width; ++c)
        use(c, load<Wide<S>>(tile + c * kLanes<S>));
}
/// In units of 2^-16 of the column's.
template <int Width, class S, class Use>
KNEAD_INLINE void for_columns(const Fixed* tile, const Use& use) {
#pragma GCC unroll 12
    for (int c = 0; c < Width; c += 2) {
        const auto pair = load<Vector<std::int32_t, kLanes<S>>>(tile + c * kLanes<S>);
        use(c, __builtin_convertvector(pair, Wide<S>));
        if (c + 1 < Width) use(c + 1, __builtin_convertvector(pair << 16, Wide<S>));
    }
}

constexpr int kStripBlocks = KNEAD_SIMD_BYTES == 64 ? 24 : 12;
constexpr int kStripScalar = KNEAD_SIMD_BYTES == 64 ? 8 : 4;

// ---- One strip, one right-hand side or three -----------------------------------------------------------

/// v (+)= strip y. @param y [Rhs][stride_y]  @param v [Rhs][stride_v], from the strip's first tile
template <int Width, int Rhs, class T, class S>
KNEAD_INLINE void strip_times(const T* tiles, std::size_t count, bool first, const S* y, std::size_t stride_y,
                              S* v, std::size_t stride_v) {
    using V = Wide<S>;
    constexpr std::size_t kTile = std::size_t{kStored<Width, T>} * kLanes<S>;
    constexpr int kChains = 2;  // additions that do not wait for each other
    for (std::size_t t = 0; t < count; ++t, tiles += kTile, v += kLanes<S>) {
        V sums[kChains][Rhs] = {};
        if (!first)
            for (int k = 0; k < Rhs; ++k)
                sums[0][k] = load<V>(v + k * stride_v);
        for_columns<Width, S>(tiles, [&](int c, const V& column) KNEAD_INLINE_LAMBDA {
#pragma GCC unroll 3
            for (int k = 0; k < Rhs; ++k)
                sums[c % kChains][k] += column * y[k * stride_y + c];
        });
        for (int k = 0; k < Rhs; ++k) {
            V sum = sums[0][k];
            for (int chain = 1; chain < kChains; ++chain)
                sum += sums[chain][k];
            store(v + k * stride_v, sum);
        }
    }
}

/// Sums of the lanes of each of `Count` vectors.
template <int Count>
KNEAD_INLINE void sum_lanes(const Wide<double>* v, double* out) {
    for (int c = 0; c < Count; ++c) {
        double sum = 0;
        for (int l = 0; l < kLanes<double>; ++l)
            sum += v[c][l];
        out[c] = sum;
    }
}
KNEAD_INLINE Quad<float> fold(const Wide<float>& v) {
#if KNEAD_SIMD_BYTES == 64
    const auto half = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
                      __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
    return __builtin_shufflevector(half, half, 0, 1, 2, 3) + __builtin_shufflevector(half, half, 4, 5, 6, 7);
#elif KNEAD_SIMD_BYTES == 32
    return __builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7);
#else
    return v;
#endif
}
/// @param out room for Count rounded up to a multiple of 4
template <int Count>
KNEAD_INLINE void sum_lanes(const Wide<float>* v, float* out) {
    using Q = Quad<float>;
#pragma GCC unroll 8
    for (int c = 0; c < Count; c += 4) {
        const Q a = fold(v[c]);
        const Q b = c + 1 < Count ? fold(v[c + 1]) : Q{};
        const Q d = c + 2 < Count ? fold(v[c + 2]) : Q{};
        const Q e = c + 3 < Count ? fold(v[c + 3]) : Q{};
        const Q ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
        const Q de = __builtin_shufflevector(d, e, 0, 4, 1, 5) + __builtin_shufflevector(d, e, 2, 6, 3, 7);
        store(out + c,
              __builtin_shufflevector(ab, de, 0, 1, 4, 5) + __builtin_shufflevector(ab, de, 2, 3, 6, 7));
    }
}

/// x = strip^T u for `Width` columns of a strip that stores `stride` of them. @param u [Rhs][stride_u]
/// @param x [Rhs][stride_x], may write three numbers too many
template <int Width, int Rhs, class T, class S>
KNEAD_INLINE void strip_transposed_times(const T* tiles, std::size_t stride, std::size_t count, const S* u,
                                         std::size_t stride_u, S* x, std::size_t stride_x) {
    using V = Wide<S>;
    V sums[Rhs][Width] = {};
    for (std::size_t t = 0; t < count; ++t, tiles += stride * kLanes<S>, u += kLanes<S>) {
        V rows[Rhs];
        for (int k = 0; k < Rhs; ++k)
            rows[k] = load<V>(u + k * stride_u);
        for_columns<Width, S>(tiles, [&](int c, const V& column) KNEAD_INLINE_LAMBDA {
#pragma GCC unroll 3
            for (int k = 0; k < Rhs; ++k)
                sums[k][c] += column * rows[k];
        });
    }
    for (int k = 0; k < Rhs; ++k)
        sum_lanes<Width>(sums[k], x + k * stride_x);
}

/// Calls `run` with the width as a compile-time number: 3, 6, ... or 1, 2, ...
template <int Width>
struct Constant {
    static constexpr int value = Width;
};
template <int Width, int Step, class Run>
KNEAD_INLINE void with_width(std::size_t width, const Run& run) {
    if constexpr (Width > Step) {
        if (width != Width) return with_width<Width - Step, Step>(width, run);
    }
    run(Constant<Width>{});
}

// ---- Nodes in and out of a supernode's own vectors -------------------------------------------------------
// The work vector has four numbers for each place: of the three, the fourth is never read into a result.
// Block 3: one work vector for each right-hand side; own vectors have three numbers for each node.
// Block 1: the right-hand sides are the three numbers of a place; each has an own vector.

template <int Block, int Rhs, class S>
struct Nodes {
    static constexpr int kBlock = Block;
    static constexpr int kRhs = Rhs;
    S* work;
    std::size_t work_stride;  ///< from one right-hand side to the next
    std::size_t own_stride;

    /// own = work at places place(0), place(1), ...; may write one number beyond the last.
    template <class Place>
    KNEAD_INLINE void gather(std::size_t count, const Place& place, S* own) const {
        if constexpr (Block == 3) {
            for (int k = 0; k < Rhs; ++k)
                for (std::size_t i = 0; i < count; ++i)
                    store(own + k * own_stride + 3 * i,
                          load<Quad<S>>(work + k * work_stride + 4 * std::size_t{place(i)}));
        } else {
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k < Rhs; ++k)
                    own[k * own_stride + i] = work[4 * std::size_t{place(i)} + k];
        }
    }

    /// work at the places = own, or += own.
    template <bool Add, class Place>
    KNEAD_INLINE void scatter(std::size_t count, const Place& place, const S* own) const {
        if constexpr (Block == 3) {
            for (int k = 0; k < Rhs; ++k)
                for (std::size_t i = 0; i < count; ++i) {
                    S* to = work + k * work_stride + 4 * std::size_t{place(i)};
                    Quad<S> v = load<Quad<S>>(own + k * own_stride + 3 * i);
                    if (Add) v += load<Quad<S>>(to);
                    store(to, v);
                }
        } else {
            for (std::size_t i = 0; i < count; ++i) {
                S* to = work + 4 * std::size_t{place(i)};
                Quad<S> v{own[i], own[own_stride + i], own[2 * own_stride + i], S(0)};
                if (Add) v += load<Quad<S>>(to);
                store(to, v);
            }
        }
    }
};

// ---- One supernode ---------------------------------------------------------------------------------------

template <class T, class S>
struct Panel {
    const T* values;
    std::size_t columns, width, tiles, rows;  ///< numbers

    Panel(const FactorView& view, const FactorView::Supernode& s)
        : values(static_cast<const T*>(view.values) + s.values_begin),
          columns(std::size_t{s.columns} * view.layout.block),
          width(view.layout.strip_width(s.columns)),
          rows(std::size_t{s.columns + s.row_count} * view.layout.block) {
        tiles = (rows + kLanes<S> - 1) / kLanes<S>;
    }

    /// run(strip's values, its first column, its width, its first tile)
    template <class Run>
    KNEAD_INLINE void for_strips(const Run& run) const {
        const T* strip = values;
        for (std::size_t c = 0; c < columns; c += width) {
            const std::size_t w = columns - c < width ? columns - c : width;
            const std::size_t tile = c / kLanes<S>;
            run(strip, c, w, tile);
            strip += (tiles - tile) * kLanes<S> * (sizeof(T) == 2 ? (w + 1) / 2 * 2 : w);
        }
    }
};

/// Each of an own vector's first numbers times its factor.
template <class N, class S>
KNEAD_INLINE void scale(std::size_t count, const N& nodes, const float* factors, S* own) {
    for (int k = 0; k < N::kRhs; ++k)
        for (std::size_t i = 0; i < count; ++i)
            own[k * nodes.own_stride + i] *= factors[i];
}

template <class T, class N, class S>
KNEAD_INLINE void forward(const FactorView& view, const FactorView::Supernode& s, const N& nodes, S* y,
                          S* v) {
    constexpr int kBlock = N::kBlock, kRhs = N::kRhs;
    constexpr int kMax = kBlock == 3 ? kStripBlocks : kStripScalar;
    const Panel<T, S> panel(view, s);
    const auto own_place = [&](std::size_t i) { return s.first + i; };
    const std::uint32_t* rows = view.rows + s.rows_begin;
    nodes.gather(s.columns, own_place, y);
    if constexpr (sizeof(T) == 2) scale(panel.columns, nodes, view.units + s.first * std::size_t{kBlock}, y);
    panel.for_strips([&](const T* strip, std::size_t column, std::size_t width, std::size_t tile) {
        with_width<kMax, kBlock>(width, [&](auto w) {
            strip_times<decltype(w)::value, kRhs>(strip, panel.tiles - tile, column == 0, y + column,
                                                  nodes.own_stride, v + tile * kLanes<S>, nodes.own_stride);
        });
    });
    if constexpr (sizeof(T) == 2)
        scale(panel.columns, nodes, view.diagonal + s.first * std::size_t{kBlock}, v);
    nodes.template scatter<false>(s.columns, own_place, v);
    nodes.template scatter<true>(
        s.row_count, [&](std::size_t i) { return rows[i]; }, v + panel.columns);
}

template <class T, class N, class S>
KNEAD_INLINE void backward(const FactorView& view, const FactorView::Supernode& s, const N& nodes, S* x,
                           S* u) {
    constexpr int kBlock = N::kBlock, kRhs = N::kRhs;
    const Panel<T, S> panel(view, s);
    const auto own_place = [&](std::size_t i) { return s.first + i; };
    const std::uint32_t* rows = view.rows + s.rows_begin;
    nodes.gather(s.columns, own_place, u);
    nodes.gather(
        s.row_count, [&](std::size_t i) { return rows[i]; }, u + panel.columns);
    for (int k = 0; k < kRhs; ++k)
        for (std::size_t i = panel.rows; i < panel.tiles * kLanes<S>; ++i)
            u[k * nodes.own_stride + i] = 0;
    panel.for_strips([&](const T* strip, std::size_t column, std::size_t width, std::size_t tile) {
        const S* from = u + tile * kLanes<S>;
        if constexpr (kBlock * kRhs < 9) {
            constexpr int kMax = kBlock == 3 ? kStripBlocks : kStripScalar;
            with_width<kMax, kBlock>(width, [&](auto w) {
                constexpr int kWidth = decltype(w)::value;
                strip_transposed_times<kWidth, kRhs>(strip, kStored<kWidth, T>, panel.tiles - tile, from,
                                                     nodes.own_stride, x + column, nodes.own_stride);
            });
        } else {  // as many columns at a time as there are registers for
            const std::size_t stride = sizeof(T) == 2 ? (width + 1) / 2 * 2 : width;
            std::size_t c = 0;
            for (; c + 6 <= width; c += 6)
                strip_transposed_times<6, kRhs>(strip + c * kLanes<S>, stride, panel.tiles - tile, from,
                                                nodes.own_stride, x + column + c, nodes.own_stride);
            if (c < width)
                strip_transposed_times<3, kRhs>(strip + c * kLanes<S>, stride, panel.tiles - tile, from,
                                                nodes.own_stride, x + column + c, nodes.own_stride);
        }
    });
    if constexpr (sizeof(T) == 2) scale(panel.columns, nodes, view.units + s.first * std::size_t{kBlock}, x);
    nodes.template scatter<false>(s.columns, own_place, x);
}

// ---- A whole solve ---------------------------------------------------------------------------------------

template <class T, int Block, int Rhs, class S>
void solve(const FactorView& view, const S* rhs, S* out, S* scratch) {
    using Q = Quad<S>;
    constexpr int kVectors = Block == 3 ? Rhs : 1;
    const std::size_t n = view.node_count;
    Nodes<Block, Rhs, S> nodes{scratch, 4 * n, view.own_stride};
    S* y = scratch + (kVectors * 4 * n + 15) / 16 * 16;
    S* v = y + Rhs * view.own_stride;

    for (int k = 0; k < kVectors; ++k)
        for (std::size_t i = 0; i < n; ++i) {
            const S* from = rhs + 3 * (k * n + i);
            Q value{from[0], from[1], from[2], S(0)};
            store(nodes.work + k * nodes.work_stride + 4 * std::size_t{view.place_of[i]}, value);
        }
    for (std::size_t i = 0; i < view.supernode_count; ++i)
        forward<T>(view, view.supernodes[i], nodes, y, v);
    for (std::size_t i = view.supernode_count; i-- > 0;)
        backward<T>(view, view.supernodes[i], nodes, y, v);
    for (int k = 0; k < kVectors; ++k)
        for (std::size_t i = 0; i < n; ++i) {
            Q value = load<Q>(nodes.work + k * nodes.work_stride + 4 * std::size_t{view.place_of[i]});
            S* to = out + 3 * (k * n + i);
            to[0] = value[0];
            to[1] = value[1];
            to[2] = value[2];
        }
}

template <int Rhs>
void solve_stored(const FactorView& view, FactorStorage storage, const float* rhs, float* out,
                  float* scratch) {
    if (storage == FactorStorage::fixed_point_16) {
        if (view.layout.block == 3)
            solve<Fixed, 3, Rhs>(view, rhs, out, scratch);
        else
            solve<Fixed, 1, 3>(view, rhs, out, scratch);
        return;
    }
    if (view.layout.block == 3)
        solve<float, 3, Rhs>(view, rhs, out, scratch);
    else
        solve<float, 1, 3>(view, rhs, out, scratch);
}

template <int Rhs>
void solve_stored(const FactorView& view, const double* rhs, double* out, double* scratch) {
    if (view.layout.block == 3)
        solve<double, 3, Rhs>(view, rhs, out, scratch);
    else
        solve<double, 1, 3>(view, rhs, out, scratch);
}

// ---- Columns of the inverse ------------------------------------------------------------------------------

/// `Count` columns side by side, so that x is read and written once for all of them.
template <int Count>
void subtract_some_columns(std::size_t size, const float* const* columns, const float* factors, float* x) {
    using V = Wide<float>;
    std::size_t i = 0;
    for (; i + kLanes<float> <= size; i += kLanes<float>) {
        V sum = load<V>(x + i);
#pragma GCC unroll 6
        for (int c = 0; c < Count; ++c)
            sum -= load<V>(columns[c] + i) * factors[c];
        store(x + i, sum);
    }
    for (; i < size; ++i)
        for (int c = 0; c < Count; ++c)
            x[i] -= columns[c][i] * factors[c];
}

void subtract_columns(std::size_t size, std::size_t count, const float* const* columns, const float* factors,
                      float* x) {
    std::size_t c = 0;
    for (; c + 6 <= count; c += 6)
        subtract_some_columns<6>(size, columns + c, factors + c, x);
    for (; c < count; ++c)
        subtract_some_columns<1>(size, columns + c, factors + c, x);
}

// ---- Making a factor -------------------------------------------------------------------------------------

constexpr int kGemmVectors = 3;
constexpr int kGemmColumns = KNEAD_SIMD_BYTES == 64 ? 8 : 4;

template <int Vectors, int Columns>
KNEAD_INLINE void gemm_tile(std::size_t depth, const double* a, std::size_t lda, const double* b,
                            std::size_t bk, std::size_t bj, double* c, std::size_t ldc) {
    using V = Wide<double>;
    V sums[Columns][Vectors] = {};
    for (std::size_t k = 0; k < depth; ++k, a += lda, b += bk) {
        V rows[Vectors];
#pragma GCC unroll 3
        for (int i = 0; i < Vectors; ++i)
            rows[i] = load<V>(a + i * kLanes<double>);
#pragma GCC unroll 8
        for (int j = 0; j < Columns; ++j)
#pragma GCC unroll 3
            for (int i = 0; i < Vectors; ++i)
                sums[j][i] += rows[i] * b[j * bj];
    }
    for (int j = 0; j < Columns; ++j)
        for (int i = 0; i < Vectors; ++i) {
            double* to = c + j * ldc + i * kLanes<double>;
            store(to, load<V>(to) - sums[j][i]);
        }
}

template <int Columns>
void gemm_strip(std::size_t rows, std::size_t depth, const double* a, std::size_t lda, const double* b,
                std::size_t bk, std::size_t bj, double* c, std::size_t ldc) {
    constexpr std::size_t kRows = kGemmVectors * kLanes<double>;
    std::size_t r = 0;
    for (; r + kRows <= rows; r += kRows)
        gemm_tile<kGemmVectors, Columns>(depth, a + r, lda, b, bk, bj, c + r, ldc);
    const std::size_t vectors = (rows - r + kLanes<double> - 1) / kLanes<double>;
    if (vectors == 3) gemm_tile<3, Columns>(depth, a + r, lda, b, bk, bj, c + r, ldc);
    if (vectors == 2) gemm_tile<2, Columns>(depth, a + r, lda, b, bk, bj, c + r, ldc);
    if (vectors == 1) gemm_tile<1, Columns>(depth, a + r, lda, b, bk, bj, c + r, ldc);
}

void subtract_product(std::size_t rows, std::size_t columns, std::size_t depth, const double* a,
                      std::size_t lda, const double* b, std::size_t bk, std::size_t bj, double* c,
                      std::size_t ldc) {
    std::size_t j = 0;
    for (; j + kGemmColumns <= columns; j += kGemmColumns)
        gemm_strip<kGemmColumns>(rows, depth, a, lda, b + j * bj, bk, bj, c + j * ldc, ldc);
    for (; j + 3 <= columns; j += 3)
        gemm_strip<3>(rows, depth, a, lda, b + j * bj, bk, bj, c + j * ldc, ldc);
    for (; j < columns; ++j)
        gemm_strip<1>(rows, depth, a, lda, b + j * bj, bk, bj, c + j * ldc, ldc);
}

bool factor_block(std::size_t n, double* a, std::size_t lda, double* inverse) {
    for (std::size_t j = 0; j < n; ++j) {
        double* column = a + j * lda;
        const double pivot = column[j];
        if (!(pivot > 0) || !(pivot < 1e300)) return false;
        const double scale = 1 / __builtin_sqrt(pivot);
        for (std::size_t i = j; i < n; ++i)
            column[i] *= scale;
        for (std::size_t k = j + 1; k < n; ++k) {
            const double factor = column[k];
            double* to = a + k * lda;
            for (std::size_t i = k; i < n; ++i)
                to[i] -= factor * column[i];
        }
    }
    for (std::size_t j = 0; j < n; ++j) {
        double* x = inverse + j * n;
        for (std::size_t i = 0; i < n; ++i)
            x[i] = i == j ? 1 : 0;
        for (std::size_t k = j; k < n; ++k) {
            const double* column = a + k * lda;
            x[k] /= column[k];
            const double value = x[k];
            for (std::size_t i = k + 1; i < n; ++i)
                x[i] -= value * column[i];
        }
    }
    return true;
}

/// Beyond: no solve could work with it.
constexpr double kLargestStored = 1e30;
/// Units of a column in its largest number, rounding left out.
constexpr double kFixedRange = 32766;

template <class S>
void store_rounded(std::size_t rows, std::size_t tiles, std::size_t width, const double* x, std::size_t ldx,
                   S* out) {
    for (std::size_t t = 0; t < tiles; ++t)
        for (std::size_t c = 0; c < width; ++c)
            for (std::size_t l = 0; l < kLanes<S>; ++l) {
                const std::size_t row = t * kLanes<S> + l;
                *out++ = row < rows ? static_cast<S>(x[c * ldx + row]) : S(0);
            }
}

/// Nearest whole number; |v| < 2^31.
KNEAD_INLINE std::int32_t nearest(double v) {
    return static_cast<std::int32_t>(v < 0 ? v - 0.5 : v + 0.5);
}

void store_fixed(std::size_t rows, std::size_t tiles, std::size_t width, const double* x, std::size_t ldx,
                 const double* largest, Fixed* out, float* units) {
    double per_unit[kStripBlocks + 1] = {};
    for (std::size_t c = 0; c < width; ++c) {
        // As it is decoded, the number is 2^16 times too large.
        units[c] = static_cast<float>(largest[c] / kFixedRange / 65536);
        per_unit[c] = units[c] > 0 ? 1 / (65536 * static_cast<double>(units[c])) : 0;
    }
    for (std::size_t t = 0; t < tiles; ++t)
        for (std::size_t c = 0; c < width; c += 2)
            for (std::size_t l = 0; l < kLanes<float>; ++l, out += 2) {
                const std::size_t row = t * kLanes<float> + l;
                const bool used = row < rows;
                const double second = used && c + 1 < width ? x[(c + 1) * ldx + row] * per_unit[c + 1] : 0;
                const auto low = static_cast<std::uint32_t>(nearest(second)) & 0xffffU;
                const double first = used ? x[c * ldx + row] * per_unit[c] - low / 65536.0 : 0;
                const std::uint32_t word = static_cast<std::uint32_t>(nearest(first)) << 16 | low;
                memcpy(static_cast<void*>(out), &word, sizeof word);
            }
}

bool store_strip(FactorStorage storage, std::size_t rows, std::size_t tiles, std::size_t width,
                 const double* x, std::size_t ldx, void* out, float* units) {
    double largest[kStripBlocks];
    bool fits = true;
    for (std::size_t c = 0; c < width; ++c) {
        largest[c] = 0;
        for (std::size_t r = 0; r < rows; ++r) {
            const double size = __builtin_fabs(x[c * ldx + r]);
            fits &= size <= kLargestStored;
            largest[c] = size > largest[c] ? size : largest[c];
        }
    }
    if (!fits) return false;
    if (storage == FactorStorage::single_precision)
        store_rounded(rows, tiles, width, x, ldx, static_cast<float*>(out));
    else if (storage == FactorStorage::double_precision)
        store_rounded(rows, tiles, width, x, ldx, static_cast<double*>(out));
    else
        store_fixed(rows, tiles, width, x, ldx, largest, static_cast<Fixed*>(out), units);
    return true;
}

#pragma GCC diagnostic pop

}  // namespace panels

constexpr FactorKernels factor_kernels() {
    using namespace panels;
    return {KNEAD_SIMD_BYTES, kStripBlocks,    kStripScalar,    solve_stored<1>,
            solve_stored<1>,  solve_stored<3>, solve_stored<3>, subtract_columns,
            subtract_product, factor_block,    store_strip};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
