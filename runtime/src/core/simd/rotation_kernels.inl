// SPDX-License-Identifier: Apache-2.0
#include "core/simd/rotation_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {

template <class S>
inline constexpr std::size_t kNodesOfGroup = kLanes<S> / 4;

template <int W, class V>
inline V yzx(V v) {
    return shuffle_groups<1, 2, 0, 3, W>(v, v);
}
template <int W, class V>
inline V zxy(V v) {
    return shuffle_groups<2, 0, 1, 3, W>(v, v);
}

template <class S, int W>
inline Vector<S, W> turned(const S* diagonals, Vector<S, W> v) {
    using V = Vector<S, W>;
    return load<V>(diagonals) * v + load<V>(diagonals + W) * yzx<W>(v) +
           load<V>(diagonals + 2 * W) * zxy<W>(v);
}

template <class S, int W>
inline Vector<S, W> turned_back(const S* diagonals, Vector<S, W> v) {
    using V = Vector<S, W>;
    return load<V>(diagonals) * v + zxy<W>(load<V>(diagonals + W) * v) +
           yzx<W>(load<V>(diagonals + 2 * W) * v);
}

/// Three numbers for each node of a group, and one more that does not matter. They need not be aligned.
template <class S, int W, class T>
inline Vector<S, W> load_packed(const T* from) {
    Vector<T, W> v;
    for (std::size_t i = 0; i < W / 4; ++i)
        __builtin_memcpy(reinterpret_cast<T*>(&v) + 4 * i, from + 3 * i, 4 * sizeof(T));
    return __builtin_convertvector(v, Vector<S, W>);
}

/// One number behind the last node is overwritten.
template <class S, int W, class T>
inline void store_packed(T* to, Vector<S, W> v) {
    const auto converted = __builtin_convertvector(v, Vector<T, W>);
    for (std::size_t i = 0; i < W / 4; ++i)
        __builtin_memcpy(to + 3 * i, reinterpret_cast<const T*>(&converted) + 4 * i, 4 * sizeof(T));
}

template <class S>
void turn_back_fields(const NodeTurns<S>& turns, const S* v, S* out) {
    constexpr int W = kLanes<S>;
    for (std::size_t group = 0; group < turns.groups; ++group) {
        const auto in = load<Vector<S, W>>(v + W * group);
        store(out + W * group, turned_back<S, W>(turns.diagonals + 3 * W * group, in));
    }
}

template <class S>
void turn_fields(const NodeTurns<S>& turns, const S* v, S* out) {
    constexpr int W = kLanes<S>;
    for (std::size_t group = 0; group < turns.groups; ++group) {
        const auto in = load<Vector<S, W>>(v + W * group);
        store(out + W * group, turned<S, W>(turns.diagonals + 3 * W * group, in));
    }
}

template <class S, class T>
void turn_back_packed(const NodeTurns<S>& turns, const S* v, T* out) {
    constexpr int W = kLanes<S>;
    for (std::size_t group = 0; group < turns.groups; ++group) {
        const auto in = load<Vector<S, W>>(v + W * group);
        store_packed<S, W>(out + 3 * kNodesOfGroup<S> * group,
                           turned_back<S, W>(turns.diagonals + 3 * W * group, in));
    }
}

template <class S, class T>
void turn_packed(const NodeTurns<S>& turns, const T* v, S* out) {
    constexpr int W = kLanes<S>;
    for (std::size_t group = 0; group < turns.groups; ++group) {
        const auto in = load_packed<S, W>(v + 3 * kNodesOfGroup<S> * group);
        store(out + W * group, turned<S, W>(turns.diagonals + 3 * W * group, in));
    }
}

/// One diagonal (a, b, c, 0) of every node of a block.
template <class S, int W>
inline void store_diagonal(S* to, Vector<S, W> a, Vector<S, W> b, Vector<S, W> c) {
    using V = Vector<S, W>;
    const V ab01 = shuffle_groups<0, 4, 1, 5, W>(a, b), ab23 = shuffle_groups<2, 6, 3, 7, W>(a, b);
    const V c01 = shuffle_groups<0, 4, 1, 5, W>(c, V{}), c23 = shuffle_groups<2, 6, 3, 7, W>(c, V{});
    store(to, shuffle_groups<0, 1, 4, 5, W>(ab01, c01));
    store(to + 3 * W, shuffle_groups<2, 3, 6, 7, W>(ab01, c01));
    store(to + 6 * W, shuffle_groups<0, 1, 4, 5, W>(ab23, c23));
    store(to + 9 * W, shuffle_groups<2, 3, 6, 7, W>(ab23, c23));
}

template <class S>
S average(const NodeTurns<S>& turns, std::size_t block, const S* rotations, std::size_t stride) {
    constexpr int W = kLanes<S>;
    using V = Vector<S, W>;
    const std::int32_t* tets = turns.tets + block * kTetsOfNode * W;
    const S* weights = turns.weights + block * kTetsOfNode * W;
    const V there = load<V>(weights);
    V w{}, x{}, y{}, z{};
    for (std::size_t k = 0; k < kTetsOfNode; ++k, tets += W, weights += W) {
        V qw, qx, qy, qz;
        for (int lane = 0; lane < W; ++lane) {
            const S* const q = rotations + tets[lane];
            qw[lane] = q[0];
            qx[lane] = q[stride];
            qy[lane] = q[2 * stride];
            qz[lane] = q[3 * stride];
        }
        // q and -q are the same rotation; all are added on the same side.
        const V weight = load<V>(weights);
        const V signed_weight = w * qw + x * qx + y * qy + z * qz < S(0) ? -weight : weight;
        w += signed_weight * qw;
        x += signed_weight * qx;
        y += signed_weight * qy;
        z += signed_weight * qz;
    }
    // Of unit quaternions on the same side: never shorter than the first, which weighs 1.
    const V squared = w * w + x * x + y * y + z * z + (S(1) - there);
    const V x2 = S(2) * x / squared, y2 = S(2) * y / squared, z2 = S(2) * z / squared;
    S* const to = turns.diagonals + block * 12 * W;
    store_diagonal<S, W>(to, there - y2 * y - z2 * z, there - x2 * x - z2 * z, there - x2 * x - y2 * y);
    store_diagonal<S, W>(to + W, x2 * y - z2 * w, y2 * z - x2 * w, x2 * z - y2 * w);
    store_diagonal<S, W>(to + 2 * W, x2 * z + y2 * w, x2 * y + z2 * w, y2 * z + x2 * w);
    return S(2) * sum<W, S>(x2 * x + y2 * y + z2 * z);
}

template <class S>
constexpr RotationKernels<S> rotation_kernels() {
    return {kLanes<S>,
            average<S>,
            turn_back_fields<S>,
            turn_fields<S>,
            turn_back_packed<S, float>,
            turn_back_packed<S, double>,
            turn_packed<S, float>,
            turn_packed<S, double>};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
