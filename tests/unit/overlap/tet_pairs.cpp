// SPDX-License-Identifier: Apache-2.0
#include "unit/overlap/tet_pairs.h"

#include <cmath>
#include <optional>
#include <ostream>

namespace knead::test {
namespace {

class Dice {
  public:
    explicit Dice(std::uint64_t seed) : bits_(seed) {}
    double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
    int below(int n) { return static_cast<int>(uniform() * n); }
    Point point() { return {uniform(), uniform(), uniform()}; }

  private:
    std::mt19937_64 bits_;
};

/// Corners in an order of positive volume, or nothing if they are too flat to tell in double.
std::optional<Corners> positive(Corners c) {
    constexpr double kFlattest = 1e-14;  // of the cube of the size; the flattest sliver asked for is above
    double size = 0;
    for (const Point& p : c)
        for (int axis = 0; axis < 3; ++axis)
            size = std::max(size, std::abs(p[axis] - c[0][axis]));
    const double volume = signed_volume_m3(c[0], c[1], c[2], c[3]);
    if (std::abs(volume) < kFlattest * size * size * size) return std::nullopt;
    if (volume < 0) std::swap(c[2], c[3]);
    return c;
}

Corners random_tet(Dice& dice) {
    for (;;) {
        const auto tet = positive({dice.point(), dice.point(), dice.point(), dice.point()});
        if (tet) return *tet;
    }
}

Corners moved(Corners c, const Point& by, double scale) {
    for (Point& p : c)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = by[axis] + scale * p[axis];
    if (scale < 0) std::swap(c[2], c[3]);
    return c;
}

/// The other tetrahedron keeps the first `shared` corners of a, starting at a random one.
Corners sharing(const Corners& a, int shared, Dice& dice) {
    for (;;) {
        Corners b{dice.point(), dice.point(), dice.point(), dice.point()};
        const int first = dice.below(4);
        for (int k = 0; k < shared; ++k)
            b[k] = a[(first + k) % 4];
        if (const auto tet = positive(b)) return *tet;
    }
}

Corners lattice_tet(Dice& dice, int wobble) {
    constexpr double kStep = 0.1;  // not a binary fraction: coplanar in the decimals, nearly so in the bits
    for (;;) {
        Corners c;
        for (Point& p : c)
            for (double& x : p) {
                x = kStep * (1 + dice.below(4));
                for (int k = dice.below(2 * wobble + 1) - wobble; k != 0; k += k > 0 ? -1 : 1)
                    x = std::nextafter(x, k > 0 ? 1.0 : -1.0);
            }
        if (const auto tet = positive(c)) return *tet;
    }
}

/// A random tetrahedron flattened along n, which no axis is parallel to.
Corners flattened(const Point& n, double flatness, Dice& dice) {
    const double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    for (;;) {
        Corners c = random_tet(dice);
        for (Point& p : c) {
            const double along = (p[0] - 0.5) * n[0] + (p[1] - 0.5) * n[1] + (p[2] - 0.5) * n[2];
            for (int axis = 0; axis < 3; ++axis)
                p[axis] -= (1 - flatness) * along / nn * n[axis];
        }
        if (const auto tet = positive(c)) return *tet;
    }
}

/// A sliver and an ordinary tetrahedron, a sliver across, or one that lies flat on it.
TetPair sliver_pair(Dice& dice) {
    const auto any_flatness = [&dice] { return std::pow(10.0, -1 - 11 * dice.uniform()); };
    const Point n = dice.point();
    const double flatness = any_flatness();
    const Corners a = flattened(n, flatness, dice);
    switch (dice.below(3)) {
        case 0:
            return {a, random_tet(dice)};
        case 1:
            return {a, flattened(dice.point(), any_flatness(), dice)};
        default:
            return {a, flattened(n, flatness, dice)};
    }
}

Corners inside_of(const Corners& a, Dice& dice) {
    for (;;) {
        Corners b;
        for (Point& p : b) {
            std::array<double, 4> w{dice.uniform(), dice.uniform(), dice.uniform(), dice.uniform()};
            if (dice.below(3) == 0) w[dice.below(4)] = 0;  // on a face
            const double sum = w[0] + w[1] + w[2] + w[3];
            p = {};
            for (int k = 0; k < 4; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    p[axis] += w[k] / sum * a[k][axis];
        }
        if (const auto tet = positive(b)) return *tet;
    }
}

/// b is a mirrored copy behind a's face, pushed in by a small depth.
Corners pushed_in(const Corners& a, Dice& dice) {
    const double depth = std::pow(10.0, -1 - 14 * dice.uniform());
    for (;;) {
        Corners b = a;
        for (int axis = 0; axis < 3; ++axis) {
            b[3][axis] = a[0][axis] + a[1][axis] + a[2][axis] - 2 * a[3][axis];
            for (int k = 0; k < 4; ++k)
                b[k][axis] += depth * (a[3][axis] - a[0][axis]);
        }
        if (const auto tet = positive(b)) return *tet;
        b[0] = dice.point();
    }
}

TetPair make_pair(PairKind kind, Dice& dice) {
    const Corners a = random_tet(dice);
    switch (kind) {
        case PairKind::random:
            return {a, random_tet(dice)};
        case PairKind::different_size:
            return {a, moved(random_tet(dice), a[dice.below(4)], -std::pow(10.0, -3 * dice.uniform()))};
        case PairKind::inside:
            return {a, inside_of(a, dice)};
        case PairKind::identical: {
            const Corners rotated{a[1], a[2], a[0], a[3]};
            return {a, dice.below(2) == 0 ? a : rotated};
        }
        case PairKind::shared_face:
            return {a, sharing(a, 3, dice)};
        case PairKind::shared_edge:
            return {a, sharing(a, 2, dice)};
        case PairKind::shared_vertex:
            return {a, sharing(a, 1, dice)};
        case PairKind::coplanar_lattice:
            return {lattice_tet(dice, 0), lattice_tet(dice, 0)};
        case PairKind::nearly_coplanar:
            return {lattice_tet(dice, 2), lattice_tet(dice, 2)};
        case PairKind::sliver:
            return sliver_pair(dice);
        case PairKind::thin_overlap:
            return {a, pushed_in(a, dice)};
        case PairKind::tiny:
            return {moved(a, {}, 1e-9), moved(random_tet(dice), {}, 1e-9)};
        case PairKind::far_from_origin: {
            const Point far{1e3, -2e5, 7e6};
            return {moved(a, far, 1.0), moved(random_tet(dice), far, 1.0)};
        }
    }
    return {a, a};
}

}  // namespace

std::vector<PairKind> all_pair_kinds() {
    return {PairKind::random,         PairKind::different_size,   PairKind::inside,
            PairKind::identical,      PairKind::shared_face,      PairKind::shared_edge,
            PairKind::shared_vertex,  PairKind::coplanar_lattice, PairKind::nearly_coplanar,
            PairKind::sliver,         PairKind::thin_overlap,     PairKind::tiny,
            PairKind::far_from_origin};
}

std::string name_of(PairKind kind) {
    switch (kind) {
        case PairKind::random:
            return "random";
        case PairKind::different_size:
            return "different_size";
        case PairKind::inside:
            return "inside";
        case PairKind::identical:
            return "identical";
        case PairKind::shared_face:
            return "shared_face";
        case PairKind::shared_edge:
            return "shared_edge";
        case PairKind::shared_vertex:
            return "shared_vertex";
        case PairKind::coplanar_lattice:
            return "coplanar_lattice";
        case PairKind::nearly_coplanar:
            return "nearly_coplanar";
        case PairKind::sliver:
            return "sliver";
        case PairKind::thin_overlap:
            return "thin_overlap";
        case PairKind::tiny:
            return "tiny";
        case PairKind::far_from_origin:
            return "far_from_origin";
    }
    return "unknown";
}

void PrintTo(PairKind kind, std::ostream* stream) {
    *stream << name_of(kind);
}

std::vector<TetPair> make_pairs(PairKind kind, int count) {
    Dice dice(1000 + static_cast<std::uint64_t>(kind));
    std::vector<TetPair> pairs;
    while (static_cast<int>(pairs.size()) < count)
        pairs.push_back(make_pair(kind, dice));
    return pairs;
}

}  // namespace knead::test
