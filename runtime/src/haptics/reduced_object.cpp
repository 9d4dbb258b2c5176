// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/reduced_object.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "haptics/twist.h"

namespace knead {
namespace {

using Mat66 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Eigen::Vector3d;
using Map66 = Eigen::Map<const Mat66>;

Vector3d vector(const Vec3& v) noexcept {
    return {v[0], v[1], v[2]};
}
Vec3 array(const Vector3d& v) noexcept {
    return {v[0], v[1], v[2]};
}
Vec6 load(const LocalModel& model) noexcept {
    Vec6 w;
    w << vector(model.force_n), vector(model.torque_nm);
    return w;
}

/// Of the object at rest, with the tool at `tool`.
Vec6 static_wrench(const LocalModel& model, const Pose& tool) noexcept {
    return load(model) - Map66(model.stiffness.data()) * twist(model.origin, tool);
}

/// What a matrix of the model is along its normal.
double along_normal(const LocalModel& model, const Mat6& matrix) noexcept {
    const Vector3d n = vector(model.normal);
    return n.dot(Map66(matrix.data()).topLeftCorner<3, 3>() * n);
}

bool finite(const LocalModel& model) noexcept {
    double sum = model.radius_m;
    for (const Mat6* matrix : {&model.stiffness, &model.damping, &model.mass})
        sum += Map66(matrix->data()).sum();
    sum += load(model).sum() + vector(model.normal).sum() + vector(model.origin.position_m).sum();
    for (const double component : model.origin.orientation_wxyz)
        sum += component;
    return std::isfinite(sum);
}

/// Where along the normal the unloaded surface is, from the origin. Matter without stiffness: at the origin.
double rest_of_patch(const LocalModel& model) noexcept {
    const double softest = 1e-9;
    const double stiffness = along_normal(model, model.stiffness);
    return stiffness > softest ? vector(model.normal).dot(vector(model.force_n)) / stiffness : 0;
}

/// The proxy's side of one period's equations: mass, and the coupling to a hand that moves.
struct CoupledProxy {
    Vec6 mass, spring, damper, stretch, hand_velocity;

    CoupledProxy(const CouplingConfig& c, const Vec6& stretch_, const Vec6& hand_velocity_) noexcept
        : stretch(stretch_), hand_velocity(hand_velocity_) {
        mass << Vector3d::Constant(c.tool_mass_kg), Vector3d::Constant(c.tool_inertia_kg_m2);
        spring << Vector3d::Constant(c.stiffness_n_per_m),
            Vector3d::Constant(c.rotation_stiffness_nm_per_rad);
        damper << Vector3d::Constant(c.damping_n_s_per_m),
            Vector3d::Constant(c.rotation_damping_nm_s_per_rad);
    }
    /// The left-hand side's diagonal, kg.
    [[nodiscard]] Vec6 inertia(double dt) const noexcept { return mass + dt * damper + dt * dt * spring; }
    /// Impulse of the coupling on the proxy, were it to stay.
    [[nodiscard]] Vec6 pull(double dt) const noexcept {
        return dt * (spring.cwiseProduct(stretch) + damper.cwiseProduct(hand_velocity));
    }
    /// On the hand, after the proxy went `way` in the period at `velocity`.
    [[nodiscard]] Vec6 felt(const Vec6& way, const Vec6& velocity) const noexcept {
        return spring.cwiseProduct(way - stretch) + damper.cwiseProduct(velocity - hand_velocity);
    }
};

/// The patch along the normal while nothing touches it: place and speed.
struct Patch {
    double m = 0, m_per_s = 0;

    /// One period. @param push_n of load and bias along the normal
    [[nodiscard]] Patch after(double dt, const LocalModel& model, double push_n) const noexcept {
        const double mass = along_normal(model, model.mass), stiffness = along_normal(model, model.stiffness);
        const double inertia = mass + dt * along_normal(model, model.damping) + dt * dt * stiffness;
        const double speed = inertia > 0 ? (mass * m_per_s + dt * (push_n - stiffness * m)) / inertia : 0;
        return {m + dt * speed, speed};
    }
};

/// The velocity after a period in which proxy and patch are one body.
/// @param push load and bias  @param d twist of the tool from the origin  @param velocity before, of both
/// @param given what of the velocity is not unknown: the turn, with N = 3
template <int N>
Vec6 held_velocity(const LocalModel& model, const CoupledProxy& proxy, const Vec6& push, const Vec6& d,
                   const Vec6& velocity, double dt, const Vec6& given) noexcept {
    using MatN = Eigen::Matrix<double, N, N>;
    const Map66 k(model.stiffness.data()), b(model.damping.data()), m(model.mass.data());
    const Mat66 object = m + dt * b + dt * dt * k;
    MatN a = object.topLeftCorner<N, N>();
    a.diagonal() += proxy.inertia(dt).head<N>();
    Vec6 rhs = proxy.pull(dt) + proxy.mass.cwiseProduct(velocity) + dt * (push - k * d);
    rhs.head<N>() += m.topLeftCorner<N, N>() * velocity.head<N>();
    if (N < 6) rhs.head<N>() -= dt * ((b + dt * k).template topRightCorner<N, 6 - N>() * given.tail<6 - N>());
    Vec6 next = given;
    next.head<N>() = a.llt().solve(rhs.head<N>());
    return next;
}

}  // namespace

ReducedObject::ReducedObject(const Config& config) noexcept : config_(config) {}

void ReducedObject::reset(const Pose& hand) noexcept {
    model_ = {};
    hand_ = tool_ = hand;
    velocity_ = bias_ = {};
    in_contact_ = false;
    patch_m_ = patch_m_per_s_ = 0;
}

bool ReducedObject::correct(const LocalModel& model, double period_s) noexcept {
    if (model.step == 0 || !finite(model)) return false;
    period_s_ = period_s;
    if (model.unilateral && model.touched_nodes == 0)
        lower_to(model);
    else
        meet(model);
    return true;
}

/// Nothing touched the tool there. What is remembered stays as far as it agrees, and while the proxy is near
/// it: where the result looked says nothing of it, the hand may have been forecast there and never have come.
void ReducedObject::lower_to(const LocalModel& model) noexcept {
    if (model_.step == 0) return;
    Eigen::Map<Vec6> bias(bias_.data());
    if (!in_contact_ && twist(model_.origin, tool_).head<3>().norm() > model_.radius_m + model.radius_m) {
        model_ = {};
        bias.setZero();
        return;
    }
    const Vector3d n = vector(model_.normal);
    const double push = n.dot((static_wrench(model_, model.origin) + bias).head<3>());
    if (!(push > 0)) return;
    model_.force_n = array(vector(model_.force_n) - push * n);
    if (in_contact_) bias.head<3>() += push * n;
}

/// Something did, or is bonded to it.
void ReducedObject::meet(const LocalModel& model) noexcept {
    Eigen::Map<Vec6> bias(bias_.data());
    const bool had_object = model_.step != 0;
    if (had_object && (in_contact_ || !model.unilateral)) {
        bias += static_wrench(model_, tool_) - static_wrench(model, tool_);
    } else {
        bias.setZero();
        // The patch is as far from its rest as it was.
        patch_m_ =
            had_object ? patch_m_ + rest_of_patch(model) - rest_of_patch(model_) : rest_of_patch(model);
        if (!had_object) patch_m_per_s_ = 0;
        // If the proxy is in it already, advance() lets them meet: with a common momentum. Taken for one body
        // here, the patch would have the proxy's speed for nothing.
    }
    if (!model.unilateral) in_contact_ = true;
    model_ = model;
}

Wrench ReducedObject::advance(const Pose& hand, double dt_s) noexcept {
    return config_.coupling.rotation_stiffness_nm_per_rad > 0 ? advance_by<6>(hand, dt_s)
                                                              : advance_by<3>(hand, dt_s);
}

/// N unknowns: with 3 the tool has the hand's orientation.
template <int N>
Wrench ReducedObject::advance_by(const Pose& hand, double dt) noexcept {
    Eigen::Map<Vec6> velocity(velocity_.data()), bias(bias_.data());
    if (period_s_ > 0) bias *= std::pow(1 - config_.correction_gain, dt / period_s_);
    const Vec6 hand_velocity = twist(hand_, hand) / dt;
    if (N == 3) {
        tool_.orientation_wxyz = hand.orientation_wxyz;
        velocity.tail<3>() = hand_velocity.tail<3>();
    }
    const CoupledProxy proxy(config_.coupling, twist(tool_, hand), hand_velocity);

    Vec6 next = (proxy.mass.cwiseProduct(velocity) + proxy.pull(dt)).cwiseQuotient(proxy.inertia(dt));
    if (N == 3) next.tail<3>() = velocity.tail<3>();
    if (model_.step != 0) {
        const Vector3d n = vector(model_.normal);
        const Vec6 d = twist(model_.origin, tool_);
        const double tool_m = n.dot(d.head<3>()), tool_m_per_s = n.dot(velocity.head<3>());
        Vec6 push = load(model_) + bias;
        const Patch before = in_contact_ ? Patch{tool_m, tool_m_per_s} : Patch{patch_m_, patch_m_per_s_};
        const Patch alone = before.after(dt, model_, n.dot(push.head<3>()));
        Vec6 both = velocity;
        bool together = in_contact_;
        if (!together && tool_m + dt * n.dot(next.head<3>()) <= alone.m) {
            // They meet: one momentum, and no memory of where the surface was held sideways.
            together = true;
            const double patch_kg = along_normal(model_, model_.mass), tool_kg = proxy.mass[0];
            both.head<3>() += patch_kg / (tool_kg + patch_kg) * (before.m_per_s - tool_m_per_s) * n;
            const Vector3d force = (push - Map66(model_.stiffness.data()) * d).head<3>();
            const Vector3d sideways = force - n.dot(force) * n;
            bias.head<3>() -= sideways;
            push.head<3>() -= sideways;
        }
        in_contact_ = false;
        if (together) {
            const Vec6 held = held_velocity<N>(model_, proxy, push, d, both, dt, next);
            const Vec6 impulse =
                proxy.inertia(dt).cwiseProduct(held) - proxy.pull(dt) - proxy.mass.cwiseProduct(velocity);
            in_contact_ = !model_.unilateral || !(n.dot(impulse.head<3>()) < 0);
            if (in_contact_) next = held;
        }
        patch_m_ = alone.m;
        patch_m_per_s_ = alone.m_per_s;
    }

    velocity = next;
    Vec6 way = dt * next;
    if (N == 3) way.tail<3>().setZero();
    tool_ = moved(tool_, way);
    hand_ = hand;
    const Vec6 felt = proxy.felt(way, velocity);
    if (!felt.allFinite() || !way.allFinite()) {
        reset(hand);
        return {};
    }
    Wrench wrench;
    wrench.force_n = array(felt.head<3>());
    if (N == 6) wrench.torque_nm = array(felt.tail<3>());
    return wrench;
}

}  // namespace knead
