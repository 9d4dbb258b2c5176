// SPDX-License-Identifier: Apache-2.0
#include "core/simd/element_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {

template <class S, int W>
struct Matrices3 {
    Vector<S, W> m[9];  // row-major
    Vector<S, W>& operator()(int row, int column) { return m[3 * row + column]; }
    const Vector<S, W>& operator()(int row, int column) const { return m[3 * row + column]; }
};

template <class S, int W>
struct Quaternions {
    Vector<S, W> w, x, y, z;
};

constexpr int kNewtonSteps = 10;

/// Newton converges quadratically: a turn this small leaves about its square (radians).
template <class S>
inline constexpr S kSmallTurn = sizeof(S) == 4 ? S(2e-3) : S(1e-6);
/// A turn beyond this comes from far outside Newton's region: not worth following (radians).
template <class S>
inline constexpr S kLargeTurn = 1;
/// Smallest determinant of the Hessian, relative to the cube of its trace, that is still solved with.
template <class S>
inline constexpr S kSingularHessian = sizeof(S) == 4 ? S(1e-5) : S(1e-12);

template <class S, int W>
inline Matrices3<S, W> rotation_matrices(const Quaternions<S, W>& q) {
    using V = Vector<S, W>;
    const V x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const V xx = x2 * q.x, yy = y2 * q.y, zz = z2 * q.z;
    const V xy = x2 * q.y, xz = x2 * q.z, yz = y2 * q.z;
    const V wx = x2 * q.w, wy = y2 * q.w, wz = z2 * q.w;
    const V one = broadcast<V>(S(1));
    return {
        {one - yy - zz, xy - wz, xz + wy, xy + wz, one - xx - zz, yz - wx, xz - wy, yz + wx, one - xx - yy}};
}

/// q * (1, turn / 2), normalised.
template <class S, int W>
inline Quaternions<S, W> turned(const Quaternions<S, W>& q, const Vectors3<S, W>& turn) {
    using V = Vector<S, W>;
    const V x = S(0.5) * turn.x, y = S(0.5) * turn.y, z = S(0.5) * turn.z;
    Quaternions<S, W> r{q.w - q.x * x - q.y * y - q.z * z, q.x + q.w * x + q.y * z - q.z * y,
                        q.y + q.w * y + q.z * x - q.x * z, q.z + q.w * z + q.x * y - q.y * x};
    // 1 / sqrt(1 + excess) by its series: what is left after a large turn goes with the next, small one.
    const V excess = r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z - S(1);
    const V scale = S(1) - excess * (S(0.5) - S(0.375) * excess);
    r.w *= scale;
    r.x *= scale;
    r.y *= scale;
    r.z *= scale;
    return r;
}

template <class S, int W>
void fall_back(const Matrices3<S, W>& f, Quaternions<S, W>& q, int lane, RotationFallback<S> fallback) {
    S matrix[9], quaternion[4] = {q.w[lane], q.x[lane], q.y[lane], q.z[lane]};
    for (int k = 0; k < 9; ++k)
        matrix[k] = f.m[k][lane];
    fallback(matrix, quaternion);
    q.w[lane] = quaternion[0];
    q.x[lane] = quaternion[1];
    q.y[lane] = quaternion[2];
    q.z[lane] = quaternion[3];
}

/// Analytic polar decomposition (rotation.h): Newton steps from the last rotation, accepted only where the
/// Hessian is positive definite, because there the maximum is the global one.
template <class S, int W>
inline void find_rotations(const Matrices3<S, W>& f, Quaternions<S, W>& q, RotationFallback<S> fallback) {
    using V = Vector<S, W>;
    for (int step = 0; step < kNewtonSteps; ++step) {
        const Matrices3<S, W> r = rotation_matrices(q);
        Matrices3<S, W> b;  // R^T F
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j)
                b(i, j) = r(0, i) * f(0, j) + r(1, i) * f(1, j) + r(2, i) * f(2, j);
        }
        // tr(R exp([w])^T F) = tr(B) + w . g - w . H w / 2 + ...
        const V gx = b(2, 1) - b(1, 2), gy = b(0, 2) - b(2, 0), gz = b(1, 0) - b(0, 1);
        const V hxx = b(1, 1) + b(2, 2), hyy = b(0, 0) + b(2, 2), hzz = b(0, 0) + b(1, 1);
        const V hxy = S(-0.5) * (b(0, 1) + b(1, 0)), hxz = S(-0.5) * (b(0, 2) + b(2, 0)),
                hyz = S(-0.5) * (b(1, 2) + b(2, 1));
        const V cxx = hyy * hzz - hyz * hyz, cxy = hxz * hyz - hxy * hzz, cxz = hxy * hyz - hxz * hyy;
        const V cyy = hxx * hzz - hxz * hxz, cyz = hxy * hxz - hxx * hyz, czz = hxx * hyy - hxy * hxy;
        const V determinant = hxx * cxx + hxy * cxy + hxz * cxz;
        const V size = hxx + hyy + hzz;
        // Sylvester's criterion.
        const auto definite =
            (hxx > S(0)) & (czz > S(0)) & (determinant > kSingularHessian<S> * size * size * size);
        const V inverse = S(1) / determinant;
        Vectors3<S, W> turn{(cxx * gx + cxy * gy + cxz * gz) * inverse,
                            (cxy * gx + cyy * gy + cyz * gz) * inverse,
                            (cxz * gx + cyz * gy + czz * gz) * inverse};
        const V turned2 = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
        const auto valid = definite & (turned2 < kLargeTurn<S> * kLargeTurn<S>);
        const V zero{};
        turn = {valid ? turn.x : zero, valid ? turn.y : zero, valid ? turn.z : zero};
        q = turned(q, turn);
        const auto done = valid & (turned2 < kSmallTurn<S> * kSmallTurn<S>);
        if (all(done)) return;
        const bool last = step == kNewtonSteps - 1;
        for (int lane = 0; lane < W; ++lane) {
            if (!valid[lane] || (last && !done[lane])) fall_back(f, q, lane, fallback);
        }
        if (all(done | ~valid)) return;
    }
}

template <class S, int W>
struct Corners {
    Vectors3<S, W> edge[3];  // node k + 1 minus node 0
};

template <class S, int W>
inline Corners<S, W> gather_edges(const S* field, const std::int32_t* nodes) {
    const Vectors3<S, W> origin = gather<S, W>(field, nodes);
    Corners<S, W> result;
    for (int k = 0; k < 3; ++k) {
        const Vectors3<S, W> corner = gather<S, W>(field, nodes + (k + 1) * W);
        result.edge[k] = {corner.x - origin.x, corner.y - origin.y, corner.z - origin.z};
    }
    return result;
}

/// Adds f[k] to node k + 1 and takes their sum from node 0.
template <class S, int W>
inline void scatter_forces(const Vectors3<S, W> (&f)[3], const std::int32_t* nodes, S* field) {
    for (int k = 0; k < 3; ++k)
        scatter_add<S, W>(f[k], nodes + (k + 1) * W, field);
    const Vectors3<S, W> rest{-(f[0].x + f[1].x + f[2].x), -(f[0].y + f[1].y + f[2].y),
                              -(f[0].z + f[1].z + f[2].z)};
    scatter_add<S, W>(rest, nodes, field);
}

template <class S, int W>
inline Matrices3<S, W> load_matrices(const S* from) {
    Matrices3<S, W> result;
    for (int k = 0; k < 9; ++k)
        result.m[k] = load<Vector<S, W>>(from + k * W);
    return result;
}

/// Sum over k of edge[k] (outer) row k of `gradients`.
template <class S, int W>
inline Matrices3<S, W> gradient_of(const Corners<S, W>& u, const Matrices3<S, W>& gradients) {
    Matrices3<S, W> result;
    for (int j = 0; j < 3; ++j) {
        result(0, j) =
            u.edge[0].x * gradients(0, j) + u.edge[1].x * gradients(1, j) + u.edge[2].x * gradients(2, j);
        result(1, j) =
            u.edge[0].y * gradients(0, j) + u.edge[1].y * gradients(1, j) + u.edge[2].y * gradients(2, j);
        result(2, j) =
            u.edge[0].z * gradients(0, j) + u.edge[1].z * gradients(1, j) + u.edge[2].z * gradients(2, j);
    }
    return result;
}

/// Blocks that go through one stage before the next begins: enough that loads do not wait for the stores
/// just made, few enough for the level-1 cache.
constexpr std::size_t kStage = 8;

template <class S, int W>
inline void stress_and_scatter(const ElementArrays<S>& elements, std::size_t block, S scale,
                               const Matrices3<S, W>& f, S* forces) {
    using V = Vector<S, W>;
    const S* const quaternion = elements.rotations + block * 4 * W;
    const Quaternions<S, W> q{load<V>(quaternion), load<V>(quaternion + W), load<V>(quaternion + 2 * W),
                              load<V>(quaternion + 3 * W)};
    const Matrices3<S, W> r = rotation_matrices(q);
    const V mu = scale * load<V>(elements.lame_volume + block * 2 * W);
    const V lambda = scale * load<V>(elements.lame_volume + (block * 2 + 1) * W);
    V stretch = broadcast<V>(S(-3));
    for (int k = 0; k < 9; ++k)
        stretch += r.m[k] * f.m[k];
    // Minus the stress times the volume: the force of a node is this times its gradient.
    const V turned_part = S(2) * mu - lambda * stretch;
    const V strained_part = S(-2) * mu;
    Matrices3<S, W> p;
    for (int k = 0; k < 9; ++k)
        p.m[k] = strained_part * f.m[k] + turned_part * r.m[k];
    const Matrices3<S, W> b = load_matrices<S, W>(elements.rest_inverse + block * 9 * W);
    S* const gradients = elements.gradients + block * 9 * W;
    Vectors3<S, W> force[3];
    for (int k = 0; k < 3; ++k) {
        const auto times = [&](const Matrices3<S, W>& m, int row) {
            return m(row, 0) * b(k, 0) + m(row, 1) * b(k, 1) + m(row, 2) * b(k, 2);
        };
        force[k] = {times(p, 0), times(p, 1), times(p, 2)};
        for (int j = 0; j < 3; ++j)
            store(gradients + (3 * k + j) * W, times(r, j));
    }
    scatter_forces<S, W>(force, elements.nodes + block * 4 * W, forces);
}

template <class S>
void linearise(const ElementArrays<S>& elements, S scale, const S* u, S* forces,
               RotationFallback<S> fallback) {
    constexpr int W = kLanes<S>;
    using V = Vector<S, W>;
    Matrices3<S, W> f[kStage];
    for (std::size_t first = 0; first < elements.blocks; first += kStage) {
        const std::size_t count = first + kStage < elements.blocks ? kStage : elements.blocks - first;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t block = first + k;
            const Corners<S, W> corners = gather_edges<S, W>(u, elements.nodes + block * 4 * W);
            f[k] = gradient_of(corners, load_matrices<S, W>(elements.rest_inverse + block * 9 * W));
            for (int i = 0; i < 3; ++i)
                f[k](i, i) += S(1);
        }
        for (std::size_t k = 0; k < count; ++k) {
            S* const state = elements.rotations + (first + k) * 4 * W;
            Quaternions<S, W> q{load<V>(state), load<V>(state + W), load<V>(state + 2 * W),
                                load<V>(state + 3 * W)};
            find_rotations(f[k], q, fallback);
            store(state, q.w);
            store(state + W, q.x);
            store(state + 2 * W, q.y);
            store(state + 3 * W, q.z);
        }
        for (std::size_t k = 0; k < count; ++k)
            stress_and_scatter<S, W>(elements, first + k, scale, f[k], forces);
    }
}

template <class S>
void apply_stiffness(const ElementArrays<S>& elements, S scale, const S* u, S* out) {
    constexpr int W = kLanes<S>;
    using V = Vector<S, W>;
    for (std::size_t block = 0; block < elements.blocks; ++block) {
        const std::int32_t* const nodes = elements.nodes + block * 4 * W;
        const Matrices3<S, W> g = load_matrices<S, W>(elements.gradients + block * 9 * W);
        const Matrices3<S, W> h = gradient_of(gather_edges<S, W>(u, nodes), g);
        const V mu = scale * load<V>(elements.lame_volume + block * 2 * W);
        const V pressure =
            scale * load<V>(elements.lame_volume + (block * 2 + 1) * W) * (h(0, 0) + h(1, 1) + h(2, 2));
        const V xx = S(2) * mu * h(0, 0) + pressure, yy = S(2) * mu * h(1, 1) + pressure,
                zz = S(2) * mu * h(2, 2) + pressure;
        const V xy = mu * (h(0, 1) + h(1, 0)), xz = mu * (h(0, 2) + h(2, 0)), yz = mu * (h(1, 2) + h(2, 1));
        Vectors3<S, W> force[3];
        for (int k = 0; k < 3; ++k) {
            force[k] = {xx * g(k, 0) + xy * g(k, 1) + xz * g(k, 2),
                        xy * g(k, 0) + yy * g(k, 1) + yz * g(k, 2),
                        xz * g(k, 0) + yz * g(k, 1) + zz * g(k, 2)};
        }
        scatter_forces<S, W>(force, nodes, out);
    }
}

template <class S>
constexpr ElementKernels<S> element_kernels() {
    return {kLanes<S>, linearise<S>, apply_stiffness<S>};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
