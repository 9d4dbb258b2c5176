// SPDX-License-Identifier: Apache-2.0
#include "core/friction.h"

#include <algorithm>

namespace knead::core {
namespace {

/// Stiffer than any node pressed by a soft object at 50 Hz; a quotient beyond it is rounding.
constexpr Real kLargestFactor = 1e6;
/// A thousand nodes under a tool as light as one of them.
constexpr Real kSmallestFactor = 1e-3;

/// Passes of a step before updates become cautious: the quotient then may only fall, towards the stiffness of
/// the softest motion seen, with which updates cannot go back and forth.
constexpr int kBoldPasses = 4;

}  // namespace

void Slip::take_wanted() noexcept {
    if (!judged) return;
    friction_before_n = friction_n;
    slip_before_m = slip_m;
    compared = true;
    friction_n = wanted_n;
    judged = false;
}

void SlipStiffness::add(const Slip& slip, Real mobility_m_per_n) noexcept {
    if (!slip.compared) return;
    const Vec force = slip.friction_n - slip.friction_before_n;
    moved_ += force.dot(slip.slip_m - slip.slip_before_m);
    forced_ += mobility_m_per_n * force.squaredNorm();
}

void SlipStiffness::finish_pass() noexcept {
    if (!(moved_ > 0 && forced_ > 0)) return;
    const Real seen = std::clamp<Real>(forced_ / moved_, kSmallestFactor, kLargestFactor);
    factor_ = ++passes_ > kBoldPasses ? std::min(factor_, seen) : seen;
}

Vec friction_of(const Slip& slip, Real stiffness_n_per_m, Real most_n, bool& holds) noexcept {
    const Vec holding = slip.friction_n - stiffness_n_per_m * slip.slip_m;
    holds = holding.squaredNorm() < most_n * most_n;
    return holds ? holding : with_length(holding, most_n);
}

}  // namespace knead::core
