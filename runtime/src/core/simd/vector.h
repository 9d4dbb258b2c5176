// SPDX-License-Identifier: Apache-2.0
// Included by the *_kernels.inl files only, which are compiled once per instruction set. To keep the copies
// apart, everything stands in a namespace of that set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace knead::core::KNEAD_SIMD {

/// W numbers that are computed with at once (vector extension of GCC and Clang: operators, comparisons and
/// `mask ? a : b` work lane by lane). Wider than the machine's registers is allowed, only slower.
template <class S, int W>
struct VectorOf {
    using type [[gnu::vector_size(W * sizeof(S))]] = S;
};
template <class S, int W>
using Vector = typename VectorOf<S, W>::type;

/// Lanes of a whole register, but never fewer than a node's four numbers.
template <class S>
inline constexpr int kLanes = KNEAD_SIMD_BYTES / sizeof(S) < 4 ? 4 : KNEAD_SIMD_BYTES / sizeof(S);

template <class V, class S>
inline V load(const S* from) {
    return *reinterpret_cast<const V*>(from);
}

template <class V, class S>
inline void store(S* to, V value) {
    *reinterpret_cast<V*>(to) = value;
}

template <class V, class S>
inline V broadcast(S value) {
    return value - V{};
}

template <int W, class S>
inline S sum(Vector<S, W> v) {
    alignas(Vector<S, W>) S lanes[W];
    store(lanes, v);
    for (int half = W / 2; half > 0; half /= 2) {
        for (int k = 0; k < half; ++k)
            lanes[k] += lanes[k + half];
    }
    return lanes[0];
}

/// In every group of four lanes: the numbers A, B, C, D of the same group, 0..3 from `a` and 4..7 from `b`.
template <int A, int B, int C, int D, int W, class V, int... Lane>
inline V shuffle_groups(V a, V b, std::integer_sequence<int, Lane...>) {
    constexpr int from[4] = {A, B, C, D};
    return __builtin_shufflevector(a, b,
                                   (Lane / 4 * 4 + from[Lane % 4] % 4 + (from[Lane % 4] >= 4 ? W : 0))...);
}
template <int A, int B, int C, int D, int W, class V>
inline V shuffle_groups(V a, V b) {
    return shuffle_groups<A, B, C, D, W>(a, b, std::make_integer_sequence<int, W>{});
}

template <int First, class V, int... Lane>
inline auto group(V v, std::integer_sequence<int, Lane...>) {
    return __builtin_shufflevector(v, v, (First + Lane)...);
}

template <class S>
inline const Vector<S, 4>& node(const S* from, std::int32_t index) {
    return *reinterpret_cast<const Vector<S, 4>*>(from + index);
}

/// The four numbers at from[nodes[0]], from[nodes[Stride]], ... side by side. Said with intrinsics where
/// there are some, because they load and insert in one operation.
template <class S, int W, int Stride = 4>
inline Vector<S, W> load_groups(const S* from, const std::int32_t* nodes) {
    static_assert(W == 4 || W == 8 || W == 16);
    if constexpr (W == 4) {
        return node(from, nodes[0]);
#ifdef __AVX512F__
    } else if constexpr (W == 16 && sizeof(S) == 4) {
        // Loads that broadcast and blend leave the shuffle units alone.
        __m512 v = _mm512_castps128_ps512(node(from, nodes[0]));
        v = _mm512_mask_broadcast_f32x4(v, 0x00f0, node(from, nodes[Stride]));
        v = _mm512_mask_broadcast_f32x4(v, 0x0f00, node(from, nodes[2 * Stride]));
        return _mm512_mask_broadcast_f32x4(v, 0xf000, node(from, nodes[3 * Stride]));
    } else if constexpr (W == 8 && sizeof(S) == 8) {
        return _mm512_insertf64x4(_mm512_castpd256_pd512(node(from, nodes[0])), node(from, nodes[Stride]), 1);
#endif
#ifdef __AVX2__
    } else if constexpr (W == 8 && sizeof(S) == 4) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(node(from, nodes[0])), node(from, nodes[Stride]),
                                    1);
#endif
    } else {
        static_assert(W == 4, "wider registers need a way to fill them");
    }
}

/// Puts every group of four lanes at to[nodes[0]], to[nodes[1]], ...
template <class S, int W>
inline void store_groups(Vector<S, W> v, const std::int32_t* nodes, S* to) {
    [&]<int... Group>(std::integer_sequence<int, Group...>) {
        ((*reinterpret_cast<Vector<S, 4>*>(to + nodes[Group]) =
              group<4 * Group>(v, std::make_integer_sequence<int, 4>{})),
         ...);
    }
    (std::make_integer_sequence<int, W / 4>{});
}

/// Whether a comparison holds in all lanes.
template <class M>
inline bool all(M mask) {
#ifdef __AVX512DQ__
    if constexpr (sizeof(M) == 64 && sizeof(mask[0]) == 4)
        return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask)) == 0xffff;
    else if constexpr (sizeof(M) == 64)
        return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) == 0xff;
    else
#endif
#ifdef __AVX2__
        if constexpr (sizeof(M) == 32)
        return _mm256_movemask_epi8(reinterpret_cast<__m256i>(mask)) == -1;
    else
#endif
    {
        auto result = mask[0];
        for (std::size_t k = 1; k < sizeof(M) / sizeof(mask[0]); ++k)
            result &= mask[k];
        return result != 0;
    }
}

/// Lanes 4 * Group to 4 * Group + 3. With intrinsics because GCC would take a whole-register shuffle.
template <int Group, class S, int W>
inline Vector<S, 4> group_of(Vector<S, W> v) {
#ifdef __AVX512F__
    if constexpr (sizeof(v) == 64 && sizeof(S) == 4 && Group > 0)
        return _mm512_extractf32x4_ps(v, Group);
    else if constexpr (sizeof(v) == 64 && sizeof(S) == 8 && Group > 0)
        return _mm512_extractf64x4_pd(v, Group);
    else
#endif
        return group<4 * Group>(v, std::make_integer_sequence<int, 4>{});
}

/// Adds every group of four lanes to the numbers at to[nodes[0]], to[nodes[4]], ...
template <class S, int W>
inline void add_groups(Vector<S, W> v, const std::int32_t* nodes, S* to) {
    [&]<int... Group>(std::integer_sequence<int, Group...>) {
        ((*reinterpret_cast<Vector<S, 4>*>(to + nodes[4 * Group]) += group_of<Group, S, W>(v)), ...);
    }
    (std::make_integer_sequence<int, W / 4>{});
}

template <class S, int W>
struct Vectors3 {
    Vector<S, W> x, y, z;
};

/// Three numbers of each of W nodes. @param nodes [W] four times the index of each lane's node
template <class S, int W>
inline Vectors3<S, W> gather(const S* field, const std::int32_t* nodes) {
    using V = Vector<S, W>;
    const V n0 = load_groups<S, W>(field, nodes);
    const V n1 = load_groups<S, W>(field, nodes + 1);
    const V n2 = load_groups<S, W>(field, nodes + 2);
    const V n3 = load_groups<S, W>(field, nodes + 3);
    const V xy01 = shuffle_groups<0, 4, 1, 5, W>(n0, n1);
    const V xy23 = shuffle_groups<0, 4, 1, 5, W>(n2, n3);
    const V z01 = shuffle_groups<2, 6, 3, 7, W>(n0, n1);
    const V z23 = shuffle_groups<2, 6, 3, 7, W>(n2, n3);
    return {shuffle_groups<0, 1, 4, 5, W>(xy01, xy23), shuffle_groups<2, 3, 6, 7, W>(xy01, xy23),
            shuffle_groups<0, 1, 4, 5, W>(z01, z23)};
}

template <class S, int W, int... Lane>
inline Vector<S, W> shuffle_fourth(Vector<S, W> v, std::integer_sequence<int, Lane...>) {
    return __builtin_shufflevector(v, Vector<S, W>{}, (Lane % 4 == 3 ? Lane + W : Lane)...);
}
/// Zero in the last lane of every group of four.
template <class S, int W>
inline Vector<S, W> without_fourth(Vector<S, W> v) {
#ifdef __AVX512F__
    if constexpr (sizeof(v) == 64 && sizeof(S) == 4)
        return _mm512_maskz_mov_ps(0x7777, v);
    else if constexpr (sizeof(v) == 64)
        return _mm512_maskz_mov_pd(0x77, v);
    else
#endif
        return shuffle_fourth<S, W>(v, std::make_integer_sequence<int, W>{});
}

/// Adds three numbers to each of W nodes, one lane after the other: a node may stand in several lanes.
template <class S, int W>
inline void scatter_add(const Vectors3<S, W>& v, const std::int32_t* nodes, S* field) {
    using V = Vector<S, W>;
    const V xy01 = shuffle_groups<0, 4, 1, 5, W>(v.x, v.y);
    const V xy23 = shuffle_groups<2, 6, 3, 7, W>(v.x, v.y);
    add_groups<S, W>(without_fourth<S, W>(shuffle_groups<0, 1, 4, 4, W>(xy01, v.z)), nodes, field);
    add_groups<S, W>(without_fourth<S, W>(shuffle_groups<2, 3, 5, 5, W>(xy01, v.z)), nodes + 1, field);
    add_groups<S, W>(without_fourth<S, W>(shuffle_groups<0, 1, 6, 6, W>(xy23, v.z)), nodes + 2, field);
    add_groups<S, W>(without_fourth<S, W>(shuffle_groups<2, 3, 7, 7, W>(xy23, v.z)), nodes + 3, field);
}

}  // namespace knead::core::KNEAD_SIMD
