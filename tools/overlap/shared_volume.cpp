// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlap/shared_volume.h"

#include <algorithm>
#include <optional>

#include "overlap/clip.h"
#include "overlap/exact.h"
#include "overlap/plane_values.h"
#include "overlap/rounding.h"

namespace knead::tools {
namespace {

/// Share of the smaller tetrahedron that may be in doubt before better arithmetic is used. The rest of
/// kSharedVolumeAccuracy is for the volume itself (4e-13) and the rounding of the cuts (below 1e-13).
constexpr double kDoubtAllowed = 5e-13;

/// Largest distance along each axis between a point of one box and a point of the other.
Point reach_of(const PreparedTet& a, const PreparedTet& b) {
    Point reach;
    for (int axis = 0; axis < 3; ++axis)
        reach[axis] = std::max(a.high[axis] - b.low[axis], b.high[axis] - a.low[axis]);
    return reach;
}

/// The planes that cut the piece, packed to the front; those that cannot be told from touching are moved
/// onto the corners they touch.
template <class Real>
struct Cut {
    Piece<Real> piece{};
    int count = 0;
    double doubt = 0;  ///< share of the tetrahedron that the rounding errors may have moved
    bool outside = false;
};

template <class Real>
Cut<Real> find_cuts(const Piece<Real>& values, const std::array<double, 4>& errors) {
    Cut<Real> cut;
    for (int face = 0; face < 4; ++face) {
        const Real error = errors[face];
        const auto [low, high] =
            std::minmax({values[0][face], values[1][face], values[2][face], values[3][face]});
        if (high <= -error) return {.outside = true};
        if (low >= error) continue;
        // Moved by up to 2 errors: 3 * 2 * error / width of the tetrahedron lies between the two planes.
        const Real width = high - low - 2 * error;
        cut.doubt += width > 0 ? static_cast<double>(6 * error / width) : 1.0;
        bool takes_something = false;
        for (int corner = 0; corner < 4; ++corner) {
            const Real value = values[corner][face];
            const bool on_plane = value <= error && value >= -error;
            cut.piece[corner][cut.count] = on_plane ? Real(0) : value;
            takes_something = takes_something || value < -error;
        }
        if (takes_something) ++cut.count;
        cut.outside = cut.outside || high <= error;
    }
    return cut;
}

/// Share of a inside b with certainty, or nothing. A share that could be no more than the doubt about it is
/// not certain: the two may only touch.
template <class Real>
std::optional<double> certain_share(const Corners& a, const Faces<Real>& b,
                                    const std::array<double, 4>& errors) {
    const Cut<Real> cut = find_cuts(plane_values(a, b), errors);
    if (cut.doubt > kDoubtAllowed) return std::nullopt;
    if (cut.outside) return 0.0;
    const double share = static_cast<double>(share_inside(cut.piece, 0, cut.count));
    if (share > 0 && share <= cut.doubt) return std::nullopt;
    return share;
}

/// True if a face plane of a has all of b outside, with certainty.
bool face_separates(const PreparedTet& a, const PreparedTet& b, const Point& reach) {
    const Piece<double> values = plane_values(b.corners, a.faces);
    const std::array<double, 4> errors = plane_value_errors<double>(a.normal_scale, reach);
    // b may reach errors deep into a, whose width across the face is six volumes: at most this share of a.
    for (int face = 0; face < 4; ++face) {
        const double high = std::max({values[0][face], values[1][face], values[2][face], values[3][face]});
        if (high <= -errors[face]) return true;
        if (high <= errors[face] && 6 * errors[face] <= kDoubtAllowed * 6 * a.volume) return true;
    }
    return false;
}

}  // namespace

double shared_volume(const PreparedTet& first, const PreparedTet& second, ArithmeticCounts& counts) {
    const bool in_order = first.volume <= second.volume;
    const PreparedTet& a = in_order ? first : second;
    const PreparedTet& b = in_order ? second : first;
    const Point reach = reach_of(a, b);

    ++counts.in_double;
    if (face_separates(a, b, reach)) return 0;
    const auto errors = plane_value_errors<double>(b.normal_scale, reach);
    if (const auto share = certain_share(a.corners, b.faces, errors)) return *share * a.volume;

    --counts.in_double;
    ++counts.in_long_double;
    const auto fine_errors = plane_value_errors<long double>(b.normal_scale, reach);
    if (const auto share = certain_share(a.corners, faces_of<long double>(b.corners), fine_errors))
        return *share * a.volume;

    --counts.in_long_double;
    ++counts.exact;
    return exact_share(a.corners, b.corners) * a.volume;
}

}  // namespace knead::tools
