// SPDX-License-Identifier: Apache-2.0
#include "core/linearisations.h"

#include <algorithm>

namespace knead::core {
namespace {

/// A step below it turns matter too little to matter: the case that needs it at 4 ms (islands of 1e9, nu
/// 0.49) does not at 3.
constexpr Real kLongStep_s = 2.5e-3;
/// Where it is needed; the cases of the stability matrix take 3 to 8.
constexpr int kMostOfHardMatter = 8;
/// Islands: stiffer than the path of the force by this, in matter with at least this Poisson's ratio. No case
/// below 0.45 is known to need it; at 0.44 and 20 ms it was close.
constexpr double kIslandsPressContrast = 1e5;
constexpr double kBucklingPoissonsRatio = 0.4;
/// Smallest altitude over the longest edge: a dihedral angle of about 2 degrees.
constexpr Real kFlat = 0.03;

bool is_flat(const Element& element, const Field& rest_m) {
    Real longest = 0;
    for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b)
            longest = std::max(longest, (rest_m[element.nodes[a]] - rest_m[element.nodes[b]]).norm());
    }
    // An altitude is the inverse of the gradient of its node's shape function.
    const Real steepest = std::max(element.rest_inverse.rowwise().norm().maxCoeff(),
                                   element.rest_inverse.colwise().sum().norm());
    return 1 < kFlat * longest * steepest;
}

}  // namespace

Linearisations::Linearisations(const Model& model, const Numerics& numerics, int most)
    : wanted_(most),
      islands_(numerics.press_contrast >= kIslandsPressContrast &&
               numerics.max_poissons_ratio >= kBucklingPoissonsRatio),
      hard_(most == 0 && (islands_ || std::any_of(model.elements.begin(), model.elements.end(),
                                                  [&](const Element& element) {
                                                      return is_flat(element, model.rest_m);
                                                  }))) {}

int Linearisations::most(Real dt_s) const noexcept {
    if (wanted_ > 0) return wanted_;
    return hard_ && dt_s > kLongStep_s ? kMostOfHardMatter : 1;
}

}  // namespace knead::core
