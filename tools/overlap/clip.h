// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <utility>

namespace knead::tools {

/// Values of up to four linear functions at one point.
template <class Number>
using PlaneValues = std::array<Number, 4>;

/// A piece of a tetrahedron: its four corners, each known only by its plane values. Corner positions are not
/// needed: a cut divides edges in ratios of plane values, and volumes follow from these ratios.
template <class Number>
using Piece = std::array<PlaneValues<Number>, 4>;

namespace clip {

/// Where the edge from an inside to an outside corner leaves the plane, as a share of the edge: in [0, 1).
template <class Number>
Number leaving(const Number& inside, const Number& outside) {
    return Number(inside / (inside - outside));
}

/// The point at `share` of the way from a to b; only the planes still to be applied are needed.
template <class Number>
PlaneValues<Number> between(const PlaneValues<Number>& a, const PlaneValues<Number>& b, const Number& share,
                            int first, int count) {
    PlaneValues<Number> point{};
    for (int plane = first; plane < count; ++plane)
        point[plane] = a[plane] + share * (b[plane] - a[plane]);
    return point;
}

/// Corner numbers, those on the kept side (value >= 0) first.
struct Sides {
    std::array<int, 4> corner{};
    int inside = 0;
};

template <class Number>
Sides sides_of(const Piece<Number>& piece, int plane) {
    Sides sides;
    int last = 3;
    for (int corner = 0; corner < 4; ++corner) {
        if (piece[corner][plane] < 0)
            sides.corner[last--] = corner;
        else
            sides.corner[sides.inside++] = corner;
    }
    return sides;
}

}  // namespace clip

/// Share of a tetrahedron's volume that lies where all planes first..count-1 are >= 0.
///
/// A plane cuts a tetrahedron into a tetrahedron (one corner kept), a wedge (two) or a truncated tetrahedron
/// (three); the latter two are three tetrahedra, whose volumes are products of the ratios in which the edges
/// are cut. Every term is positive: nothing cancels, so the share is as accurate as the plane values.
/// No branch depends on more than the sign of one value, so any input gives a valid share in [0, 1].
/// @tparam Number double, long double, or an exact number type (then the share is exact)
template <class Number>
Number share_inside(const Piece<Number>& piece, int first, int count);

namespace clip {

/// share * (what the remaining planes leave of the piece), without work for empty pieces.
template <class Number>
Number rest_of(const Number& share, const Piece<Number>& piece, int first, int count) {
    if (share == 0) return Number(0);
    return Number(share * share_inside(piece, first, count));
}

template <class Number>
Number keep_one(const Piece<Number>& piece, const Sides& sides, int plane, int count) {
    const auto& kept = piece[sides.corner[0]];
    std::array<Number, 3> t;
    for (int k = 0; k < 3; ++k)
        t[k] = leaving(kept[plane], piece[sides.corner[k + 1]][plane]);
    const Number share = t[0] * t[1] * t[2];
    if (plane + 1 == count) return share;
    Piece<Number> tip{kept};
    for (int k = 0; k < 3; ++k)
        tip[k + 1] = between(kept, piece[sides.corner[k + 1]], t[k], plane + 1, count);
    return rest_of(share, tip, plane + 1, count);
}

template <class Number>
Number keep_two(const Piece<Number>& piece, const Sides& sides, int plane, int count) {
    const auto& a = piece[sides.corner[0]];
    const auto& b = piece[sides.corner[1]];
    const auto& o = piece[sides.corner[2]];
    const auto& p = piece[sides.corner[3]];
    const Number ao = leaving(a[plane], o[plane]);
    const Number ap = leaving(a[plane], p[plane]);
    const Number bo = leaving(b[plane], o[plane]);
    const Number bp = leaving(b[plane], p[plane]);
    // The wedge between the triangles (a, on_ao, on_ap) and (b, on_bo, on_bp), as three tetrahedra.
    const Number first = ao * ap;
    const Number second = (1 - ao) * ap * bo;
    const Number third = (1 - ap) * bo * bp;
    const int next = plane + 1;
    if (next == count) return Number(first + second + third);
    const auto on_ao = between(a, o, ao, next, count);
    const auto on_ap = between(a, p, ap, next, count);
    const auto on_bo = between(b, o, bo, next, count);
    const auto on_bp = between(b, p, bp, next, count);
    return Number(rest_of(first, Piece<Number>{a, on_ao, on_ap, b}, next, count) +
                  rest_of(second, Piece<Number>{on_ao, on_ap, b, on_bo}, next, count) +
                  rest_of(third, Piece<Number>{on_ap, b, on_bo, on_bp}, next, count));
}

template <class Number>
Number keep_three(const Piece<Number>& piece, const Sides& sides, int plane, int count) {
    const auto& a = piece[sides.corner[0]];
    const auto& b = piece[sides.corner[1]];
    const auto& c = piece[sides.corner[2]];
    const auto& o = piece[sides.corner[3]];
    const Number ta = leaving(a[plane], o[plane]);
    const Number tb = leaving(b[plane], o[plane]);
    const Number tc = leaving(c[plane], o[plane]);
    // Between the triangle (a, b, c) and the cut (on_a, on_b, on_c), as three tetrahedra.
    const Number second = (1 - ta) * tb;
    const Number third = (1 - ta) * (1 - tb) * tc;
    const int next = plane + 1;
    if (next == count) return Number(ta + second + third);
    const auto on_a = between(a, o, ta, next, count);
    const auto on_b = between(b, o, tb, next, count);
    const auto on_c = between(c, o, tc, next, count);
    return Number(rest_of(ta, Piece<Number>{a, b, c, on_a}, next, count) +
                  rest_of(second, Piece<Number>{b, c, on_a, on_b}, next, count) +
                  rest_of(third, Piece<Number>{c, on_a, on_b, on_c}, next, count));
}

}  // namespace clip

template <class Number>
Number share_inside(const Piece<Number>& piece, int first, int count) {
    for (int plane = first; plane < count; ++plane) {
        const clip::Sides sides = clip::sides_of(piece, plane);
        switch (sides.inside) {
            case 0:
                return Number(0);
            case 1:
                return clip::keep_one(piece, sides, plane, count);
            case 2:
                return clip::keep_two(piece, sides, plane, count);
            case 3:
                return clip::keep_three(piece, sides, plane, count);
            default:
                break;  // this plane takes nothing away
        }
    }
    return Number(1);
}

}  // namespace knead::tools
