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

// Deformation gradients F are kept as grad u = F - I and rotations R as D = R - I: beside a 1, floats would
// round strains and turns to 1e-7 of it. So both are precise relative to themselves, however small.

/// D = R - I.
template <class S, int W>
inline Matrices3<S, W> rotations_less_identity(const Quaternions<S, W>& q) {
    using V = Vector<S, W>;
    const V x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const V wx = x2 * q.w, wy = y2 * q.w, wz = z2 * q.w;
    const V xx = x2 * q.x, yy = y2 * q.y;
    return {{-(z2 * q.z) - yy, x2 * q.y - wz, x2 * q.z + wy,  //
             x2 * q.y + wz, -(z2 * q.z) - xx, y2 * q.z - wx,  //
             x2 * q.z - wy, y2 * q.z + wx, -(y2 * q.y) - xx}};
}

template <class S, int W>
inline Matrices3<S, W> plus_identity(Matrices3<S, W> d) {
    for (int i = 0; i < 3; ++i)
        d(i, i) += S(1);
    return d;
}

/// q * (1, half), normalised.
template <class S, int W>
inline Quaternions<S, W> turned(const Quaternions<S, W>& q, const Vectors3<S, W>& half) {
    using V = Vector<S, W>;
    const auto& [x, y, z] = half;
    Quaternions<S, W> r{q.w - q.x * x - q.y * y - q.z * z, q.x + q.w * x + q.y * z - q.z * y,
                        q.y + q.w * y + q.z * x - q.x * z, q.z + q.w * z + q.x * y - q.y * x};
    // 1 / sqrt(1 + excess) by its series: what is left after a large turn goes with the next, small one.
    const V excess = r.w * r.w + r.x * r.x + r.y * r.y + (r.z * r.z - S(1));
    const V scale = S(1) - excess * (S(0.5) - S(0.375) * excess);
    return {r.w * scale, r.x * scale, r.y * scale, r.z * scale};
}

/// What one Newton step says.
template <class S, int W>
struct Turns {
    Vectors3<S, W> half;       ///< half the turn, radians
    Vector<S, W> half2;        ///< its square
    Vector<S, W> determinant;  ///< of the Hessian, less the least that is accepted
    Vector<S, W> minor1, minor2;
    Vector<S, W> stretch;  ///< tr(R^T F) - 3 after the turn, but for a third power of it
};

/// One Newton step of the analytic polar decomposition (rotation.h) from rotation R = I + D: the maximum of
/// the second-order expansion tr(R exp([w])^T F) = tr(B) + w . g - w . H w / 2 with B = R^T F.
template <class S, int W>
inline Turns<S, W> newton_step(const Matrices3<S, W>& grad_u, const Matrices3<S, W>& d) {
    using V = Vector<S, W>;
    const Matrices3<S, W> r = plus_identity(d);
    Matrices3<S, W> e;  // B - I = D^T + R^T grad u
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            e(i, j) = d(j, i) + r(0, i) * grad_u(0, j) + r(1, i) * grad_u(1, j) + r(2, i) * grad_u(2, j);
    }
    const V gx = e(2, 1) - e(1, 2), gy = e(0, 2) - e(2, 0), gz = e(1, 0) - e(0, 1);
    const V stretch = e(0, 0) + e(1, 1) + e(2, 2), less_one = S(2) + stretch;  // tr(B) - 3, - 1
    const V hxx = less_one - e(0, 0), hyy = less_one - e(1, 1), hzz = less_one - e(2, 2);
    const V hxy = S(-0.5) * (e(0, 1) + e(1, 0)), hxz = S(-0.5) * (e(0, 2) + e(2, 0)),
            hyz = S(-0.5) * (e(1, 2) + e(2, 1));
    const V cxx = hyy * hzz - hyz * hyz, cxy = hxz * hyz - hxy * hzz, cxz = hxy * hyz - hxz * hyy;
    const V cyy = hxx * hzz - hxz * hxz, cyz = hxy * hxz - hxx * hyz, czz = hxx * hyy - hxy * hxy;
    const V trace = S(3) + stretch;
    const V determinant = hxx * cxx + hxy * cxy + hxz * cxz;
    const V half_inverse = S(0.5) / determinant;
    Turns<S, W> result;
    result.half = {(cxx * gx + cxy * gy + cxz * gz) * half_inverse,
                   (cxy * gx + cyy * gy + cyz * gz) * half_inverse,
                   (cxz * gx + cyz * gy + czz * gz) * half_inverse};
    const auto& [x, y, z] = result.half;
    result.half2 = x * x + y * y + z * z;
    result.determinant = determinant - (8 * kSingularHessian<S> * trace) * (trace * trace);
    result.minor1 = hxx;
    result.minor2 = czz;
    result.stretch = stretch + (x * gx + y * gy + z * gz);
    return result;
}

/// tr(R^T F) - 3 = tr(D) + tr(R^T grad u).
template <class S, int W>
inline Vector<S, W> stretch_of(const Matrices3<S, W>& grad_u, const Matrices3<S, W>& d) {
    const Matrices3<S, W> r = plus_identity(d);
    Vector<S, W> result = d(0, 0) + d(1, 1) + d(2, 2);
    for (int k = 0; k < 9; ++k)
        result += r.m[k] * grad_u.m[k];
    return result;
}

/// Whether the Hessian is positive definite (Sylvester's criterion): only there is the maximum the global
/// one.
template <class S, int W>
inline auto is_definite(const Turns<S, W>& turn) {
    return (turn.determinant > S(0)) & (turn.minor1 > S(0)) & (turn.minor2 > S(0));
}

template <class S, int W>
void fall_back(const Matrices3<S, W>& grad_u, Quaternions<S, W>& q, int lane, RotationFallback<S> fallback) {
    S matrix[9], quaternion[4] = {q.w[lane], q.x[lane], q.y[lane], q.z[lane]};
    for (int k = 0; k < 9; ++k)
        matrix[k] = grad_u.m[k][lane];
    fallback(matrix, quaternion);
    q.w[lane] = quaternion[0];
    q.x[lane] = quaternion[1];
    q.y[lane] = quaternion[2];
    q.z[lane] = quaternion[3];
}

/// Newton steps until all lanes are done; lanes where they lead nowhere fall back. @param turn the first one
template <class S, int W>
[[gnu::noinline]] void find_rotations(const Matrices3<S, W>& grad_u, Turns<S, W> turn, Quaternions<S, W>& q,
                                      RotationFallback<S> fallback) {
    using V = Vector<S, W>;
    for (int step = 0; step < kNewtonSteps; ++step) {
        if (step > 0) turn = newton_step(grad_u, rotations_less_identity(q));
        const auto valid = is_definite(turn) & (turn.half2 < kLargeTurn<S> * kLargeTurn<S> / 4);
        const auto done = valid & (turn.half2 < kSmallTurn<S> * kSmallTurn<S> / 4);
        const V zero{};
        q = turned<S, W>(
            q, {valid ? turn.half.x : zero, valid ? turn.half.y : zero, valid ? turn.half.z : zero});
        if (all(done)) return;
        const bool last = step == kNewtonSteps - 1;
        if (!last && all(valid)) continue;
        for (int lane = 0; lane < W; ++lane) {
            if (!valid[lane] || (last && !done[lane])) fall_back(grad_u, q, lane, fallback);
        }
        if (all(done | ~valid)) return;
    }
}

/// A number stands at distances of `Stride` from the next, in this and all that follows.
template <class S, int W, int Stride>
inline Quaternions<S, W> load_quaternions(const S* from) {
    using V = Vector<S, W>;
    return {load<V>(from), load<V>(from + Stride), load<V>(from + 2 * Stride), load<V>(from + 3 * Stride)};
}
template <int Stride, class S, int W>
inline void store_quaternions(S* to, const Quaternions<S, W>& q) {
    store(to, q.w);
    store(to + Stride, q.x);
    store(to + 2 * Stride, q.y);
    store(to + 3 * Stride, q.z);
}

/// Updates the rotations R nearest to F = I + grad u. @return tr(R^T F) - 3
template <class S, int W, int Stride>
inline Vector<S, W> update_rotations(const Matrices3<S, W>& grad_u, S* state, RotationFallback<S> fallback) {
    Quaternions<S, W> q = load_quaternions<S, W, Stride>(state);
    const Turns<S, W> turn = newton_step(grad_u, rotations_less_identity(q));
    Vector<S, W> stretch = turn.stretch;
    const auto done = is_definite(turn) & (turn.half2 < kSmallTurn<S> * kSmallTurn<S> / 4);
    if (all(done)) [[likely]] {
        q = turned(q, turn.half);
    } else {
        find_rotations(grad_u, turn, q, fallback);
        stretch = stretch_of(grad_u, rotations_less_identity(q));
    }
    store_quaternions<Stride>(state, q);
    return stretch;
}

/// det F of F = I + grad u: the volume as a share of that at rest.
template <class S, int W>
inline Vector<S, W> volume_of(const Matrices3<S, W>& grad_u) {
    const Matrices3<S, W> f = plus_identity(grad_u);
    return f(0, 0) * (f(1, 1) * f(2, 2) - f(1, 2) * f(2, 1)) -
           f(0, 1) * (f(1, 0) * f(2, 2) - f(1, 2) * f(2, 0)) +
           f(0, 2) * (f(1, 0) * f(2, 1) - f(1, 1) * f(2, 0));
}

/// From node 0 of a strip to three following ones: those of one tetrahedron.
template <class S, int W>
using Edges = Vectors3<S, W>[3];

template <class S, int W>
inline Vectors3<S, W> gather_edge(const S* field, const Vectors3<S, W>& origin, const std::int32_t* nodes) {
    const Vectors3<S, W> corner = gather<S, W>(field, nodes);
    return {corner.x - origin.x, corner.y - origin.y, corner.z - origin.z};
}

/// use(k, edges) for every tetrahedron k of a strip. Every node is read once, and not before it is needed.
template <class S, int W, int Stride, class Use>
inline void for_edges_of_strip(const S* field, const std::int32_t* nodes, Use&& use) {
    const Vectors3<S, W> origin = gather<S, W>(field, nodes);
    Edges<S, W> edges;
    edges[1] = gather_edge<S, W>(field, origin, nodes + Stride);
    edges[2] = gather_edge<S, W>(field, origin, nodes + 2 * Stride);
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kTetsInStrip; ++k) {
        edges[0] = edges[1];
        edges[1] = edges[2];
        edges[2] = gather_edge<S, W>(field, origin, nodes + (k + 3) * Stride);
        use(k, edges);
    }
}

/// Sums the forces on the nodes of a strip and adds each sum to its node as soon as it is complete.
template <class S, int W, int Stride>
class StripForces {
  public:
    StripForces(const std::int32_t* nodes, S* field) : nodes_(nodes), field_(field) {}

    /// Forces on nodes k + 1, k + 2, k + 3, for k = 0, 1, ...; minus their sum is the one on node 0.
    void add(std::size_t k, const Vectors3<S, W> (&force)[3]) {
        complete(k, plus(force[0], next_[0]));
        next_[0] = plus(force[1], next_[1]);
        next_[1] = force[2];
    }
    void finish() {
        complete(kTetsInStrip, next_[0]);
        complete(kTetsInStrip + 1, next_[1]);
        scatter_add<S, W>({-sum_.x, -sum_.y, -sum_.z}, nodes_, field_);
    }

  private:
    static Vectors3<S, W> plus(const Vectors3<S, W>& a, const Vectors3<S, W>& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    void complete(std::size_t k, const Vectors3<S, W>& force) {
        sum_ = plus(sum_, force);
        scatter_add<S, W>(force, nodes_ + (k + 1) * Stride, field_);
    }

    const std::int32_t* nodes_;
    S* field_;
    Vectors3<S, W> next_[2] = {};
    Vectors3<S, W> sum_ = {};
};

template <class S, int W, int Stride>
inline Matrices3<S, W> load_matrices(const S* from) {
    Matrices3<S, W> result;
    for (int k = 0; k < 9; ++k)
        result.m[k] = load<Vector<S, W>>(from + k * Stride);
    return result;
}

/// Sum over k of edge k (outer) row k of `gradients`.
template <class S, int W>
inline Matrices3<S, W> gradient_of(const Edges<S, W>& u, const Matrices3<S, W>& gradients) {
    Matrices3<S, W> result;
    for (int j = 0; j < 3; ++j) {
        result(0, j) = u[0].x * gradients(0, j) + u[1].x * gradients(1, j) + u[2].x * gradients(2, j);
        result(1, j) = u[0].y * gradients(0, j) + u[1].y * gradients(1, j) + u[2].y * gradients(2, j);
        result(2, j) = u[0].z * gradients(0, j) + u[1].z * gradients(1, j) + u[2].z * gradients(2, j);
    }
    return result;
}

/// Blocks that go through one stage before the next begins: enough that loads do not wait for the stores
/// just made, few enough for the level-1 cache.
constexpr std::size_t kStage = 4;

/// Where a register of numbers of the state stands in the arrays: lanes from `lane` on of a slot, a
/// tetrahedron of a block. Blocks are as wide as registers of V, of which S may fill a part only.
template <class S, class V>
struct Place {
    static constexpr int kWidth = kLanes<V>;
    std::size_t slot, lane;
    [[nodiscard]] std::size_t of(std::size_t numbers) const { return slot * numbers * kWidth + lane; }
};

/// From the numbers of V and back.
template <class S, int W, class V>
inline Vector<S, W> widened(const V* from) {
    return __builtin_convertvector(load<Vector<V, W>>(from), Vector<S, W>);
}
template <class S, int W, class V>
inline void store_narrowed(V* to, Vector<S, W> v) {
    store(to, __builtin_convertvector(v, Vector<V, W>));
}

/// Row k: the force on node k + 1; stores what is linearised.
template <class S, class V, int W>
inline void forces_of(const ElementArrays<S, V>& elements, Place<S, V> place, S scale,
                      const Matrices3<S, W>& grad_u, Vector<S, W> stretch, Vectors3<S, W> (&force)[3]) {
    constexpr int kWidth = kLanes<V>;
    const StiffnessArrays<V>& to = elements.linearised;
    // Made again from the quaternions: as fast as nine more stores and loads.
    const auto q = load_quaternions<S, W, kWidth>(elements.rotations + place.of(4));
    if constexpr (sizeof(S) != sizeof(V)) {
        V* const rotations = to.rotations + place.of(4);
        store_narrowed<S, W>(rotations, q.w);
        store_narrowed<S, W>(rotations + kWidth, q.x);
        store_narrowed<S, W>(rotations + 2 * kWidth, q.y);
        store_narrowed<S, W>(rotations + 3 * kWidth, q.z);
    }
    const Matrices3<S, W> d = rotations_less_identity(q), r = plus_identity(d);
    const auto two_mu = (2 * scale) * widened<S, W>(to.lame_volume + place.of(2));
    const auto pressure = stretch * (scale * widened<S, W>(to.lame_volume + place.of(2) + kWidth));
    const auto turned_part = two_mu - pressure;
    // Minus the stress times the volume: the force of a node is this times its gradient.
    Matrices3<S, W> p;
    for (int k = 0; k < 9; ++k)
        p.m[k] = turned_part * d.m[k] - two_mu * grad_u.m[k];
    for (int i = 0; i < 3; ++i)
        p(i, i) -= pressure;
    const auto b = load_matrices<S, W, kWidth>(elements.rest_inverse + place.of(9));
    V* const gradients = to.gradients + place.of(9);
    for (int k = 0; k < 3; ++k) {
        const auto times = [&](const Matrices3<S, W>& m, int row) {
            return m(row, 0) * b(k, 0) + m(row, 1) * b(k, 1) + m(row, 2) * b(k, 2);
        };
        force[k] = {times(p, 0), times(p, 1), times(p, 2)};
        for (int j = 0; j < 3; ++j)
            store_narrowed<S, W>(gradients + (3 * k + j) * kWidth, times(r, j));
    }
}

template <class S, class V>
bool linearise(const ElementArrays<S, V>& elements, S scale, const S* u, S* forces,
               RotationFallback<S> fallback) {
    constexpr int W = kLanes<S>, kWidth = kLanes<V>;
    constexpr std::size_t N = kTetsInStrip, kParts = kWidth / W;
    Matrices3<S, W> grad_u[kStage * N];
    Vector<S, W> stretch[kStage * N];
    decltype(stretch[0] < S(0)) inside_out{};
    const auto nodes_of = [&](std::size_t part) {
        return elements.linearised.nodes + part / kParts * (N + 3) * kWidth + part % kParts * W;
    };
    const auto place_of = [](std::size_t part, std::size_t t) {
        return Place<S, V>{part / kParts * N + t, part % kParts * W};
    };
    const std::size_t parts = elements.linearised.blocks * kParts;
    for (std::size_t first = 0; first < parts; first += kStage) {
        const std::size_t count = first + kStage < parts ? kStage : parts - first;
        for (std::size_t k = 0; k < count; ++k) {
            for_edges_of_strip<S, W, kWidth>(
                u, nodes_of(first + k), [&](std::size_t t, const Edges<S, W>& edges) {
                    grad_u[k * N + t] = gradient_of<S, W>(
                        edges,
                        load_matrices<S, W, kWidth>(elements.rest_inverse + place_of(first + k, t).of(9)));
                });
        }
        for (std::size_t k = 0; k < count * N; ++k) {
            inside_out |= volume_of(grad_u[k]) < S(0);
            stretch[k] = update_rotations<S, W, kWidth>(
                grad_u[k], elements.rotations + place_of(first + k / N, k % N).of(4), fallback);
        }
        for (std::size_t k = 0; k < count; ++k) {
            StripForces<S, W, kWidth> sums(nodes_of(first + k), forces);
#pragma GCC unroll 8
            for (std::size_t t = 0; t < N; ++t) {
                Vectors3<S, W> force[3];
                forces_of<S, V, W>(elements, place_of(first + k, t), scale, grad_u[k * N + t],
                                   stretch[k * N + t], force);
                sums.add(t, force);
            }
            sums.finish();
        }
    }
    return !all(~inside_out);
}

template <class S>
void apply_stiffness(const StiffnessArrays<S>& elements, S scale, const S* u, S* out) {
    constexpr int W = kLanes<S>;
    using V = Vector<S, W>;
    constexpr std::size_t N = kTetsInStrip;
    for (std::size_t block = 0; block < elements.blocks; ++block) {
        const std::int32_t* const nodes = elements.nodes + block * (N + 3) * W;
        StripForces<S, W, W> sums(nodes, out);
        for_edges_of_strip<S, W, W>(u, nodes, [&](std::size_t t, const Edges<S, W>& edges) {
            const std::size_t slot = block * N + t;
            const Matrices3<S, W> g = load_matrices<S, W, W>(elements.gradients + slot * 9 * W);
            const Matrices3<S, W> h = gradient_of<S, W>(edges, g);
            const V mu = scale * load<V>(elements.lame_volume + slot * 2 * W);
            const V pressure =
                scale * load<V>(elements.lame_volume + (slot * 2 + 1) * W) * (h(0, 0) + h(1, 1) + h(2, 2));
            const V xx = S(2) * mu * h(0, 0) + pressure, yy = S(2) * mu * h(1, 1) + pressure,
                    zz = S(2) * mu * h(2, 2) + pressure;
            const V xy = mu * (h(0, 1) + h(1, 0)), xz = mu * (h(0, 2) + h(2, 0)),
                    yz = mu * (h(1, 2) + h(2, 1));
            Vectors3<S, W> force[3];
            for (int k = 0; k < 3; ++k) {
                force[k] = {xx * g(k, 0) + xy * g(k, 1) + xz * g(k, 2),
                            xy * g(k, 0) + yy * g(k, 1) + yz * g(k, 2),
                            xz * g(k, 0) + yz * g(k, 1) + zz * g(k, 2)};
            }
            sums.add(t, force);
        });
        sums.finish();
    }
}

template <class S, class V>
constexpr ElementKernels<S, V> element_kernels() {
    return {kLanes<V>, linearise<S, V>, apply_stiffness<V>};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
