// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/loads.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.h"

namespace knead::tools {
namespace {

constexpr double kSlab = 0.1;  ///< how deep below its highest point a surface still counts as the top
constexpr double kPress = 0.1;
constexpr double kDeepPress = 0.2;
constexpr double kShear = 0.1;
constexpr double kTwistRad = 20 * std::numbers::pi / 180;
constexpr double kCombinedShear = 0.05;
constexpr double kCombinedTwistRad = kTwistRad / 2;
/// A node whose surroundings answer for it with more than this is a poor lever: a neighbour joins it.
constexpr double kLargestLever = 3;
constexpr double kSmallestWeight = 1e-9;

using Eigen::Vector3d;

Vector3d vector_of(const Point& point) {
    return {point[0], point[1], point[2]};
}
Point point_of(const Vector3d& vector) {
    return {vector[0], vector[1], vector[2]};
}

/// Shares of the box, per axis.
Box share_of(const Box& box, const Point& low, const Point& high) {
    Box part;
    const Point size = box.size_m();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        part.low_m[axis] = box.low_m[axis] + low[axis] * size[axis];
        part.high_m[axis] = box.low_m[axis] + high[axis] * size[axis];
    }
    return part;
}

/// Opens a box towards one end of an axis, so that rounding of the outermost nodes does not matter.
SurfaceRegion facing_up(Box box, const Box& object) {
    box.high_m[2] = object.high_m[2] + object.size_m()[2];
    return {{0, 0, 1}, box};
}

/// The whole upper surface; opened sideways too.
SurfaceRegion top_of(const Box& object) {
    return facing_up(share_of(object, {-1, -1, 1 - kSlab}, {2, 2, 1}), object);
}

SurfaceRegion pad_on_top(const Box& object, double x0, double x1, double y0, double y1) {
    return facing_up(share_of(object, {x0, y0, 1 - kSlab}, {x1, y1, 1}), object);
}

Load pushing(const std::string& name, const SurfaceRegion& region, const Point& way_m) {
    Load load;
    load.name = name;
    load.region = region;
    load.motion.translation_m = way_m;
    load.felt_translation = point_of(vector_of(way_m).normalized());
    return load;
}

void add_turn(Load& load, const Box& object, double angle_rad) {
    const Point size = object.size_m();
    load.motion.angle_rad = angle_rad;
    load.motion.pivot_m = {object.low_m[0] + size[0] / 2, object.low_m[1] + size[1] / 2, object.high_m[2]};
}

Load twisting(const std::string& name, const Box& object) {
    Load load;
    load.name = name;
    load.region = top_of(object);
    add_turn(load, object, kTwistRad);
    const Point size = object.size_m();
    load.felt_turn_per_m = {0, 0, 2 / std::min(size[0], size[1])};
    return load;
}

Load combined(const std::string& name, const Box& object) {
    const double height = object.size_m()[2];
    Load load = pushing(name, top_of(object), {kCombinedShear * height, 0, -kPress * height});
    add_turn(load, object, kCombinedTwistRad);
    return load;
}

Load side_pad(const std::string& name, const Box& object) {
    SurfaceRegion region{{1, 0, 0}, share_of(object, {1 - kSlab, 0.3, 0.4}, {1, 0.7, 0.8})};
    region.within.high_m[0] += object.size_m()[0];
    return pushing(name, region, {-kPress * object.size_m()[0], 0, 0});
}

/// Which nodes of a region stand for the tool, and how the others answer for them.
struct Standing {
    std::vector<std::size_t> under;   ///< positions in the region: follow the tool
    std::vector<std::size_t> beside;  ///< the others
    Eigen::MatrixXd weights;  ///< [under][beside] deviation of an under node per deviation of a beside one
};

Standing split(const MeshedRegion& region, const std::vector<bool>& is_under) {
    Standing standing;
    for (std::size_t k = 0; k < region.nodes.size(); ++k)
        (is_under[k] ? standing.under : standing.beside).push_back(k);
    const auto product = [&](std::size_t a, std::size_t b) {
        return region.products_m2[a * region.nodes.size() + b];
    };
    const auto rows = static_cast<Eigen::Index>(standing.under.size());
    const auto columns = static_cast<Eigen::Index>(standing.beside.size());
    standing.weights = Eigen::MatrixXd::Zero(rows, columns);
    if (columns == 0) return standing;
    Eigen::MatrixXd own(rows, rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
        const std::size_t row = standing.under[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j < rows; ++j)
            own(i, j) = product(row, standing.under[static_cast<std::size_t>(j)]);
        for (Eigen::Index j = 0; j < columns; ++j)
            standing.weights(i, j) = -product(row, standing.beside[static_cast<std::size_t>(j)]);
    }
    standing.weights = own.ldlt().solve(standing.weights).eval();
    return standing;
}

Standing stand(const MeshedRegion& region) {
    std::vector<bool> is_under = region.is_inside;
    const auto take_largest = [&] {
        std::size_t best = region.nodes.size();
        for (std::size_t k = 0; k < region.nodes.size(); ++k)
            if (!is_under[k] && (best == region.nodes.size() || region.areas_m2[k] > region.areas_m2[best]))
                best = k;
        is_under[best] = true;
    };
    if (std::find(is_under.begin(), is_under.end(), true) == is_under.end()) take_largest();
    for (;;) {
        Standing standing = split(region, is_under);
        if (standing.beside.empty() ||
            standing.weights.cwiseAbs().rowwise().sum().maxCoeff() <= kLargestLever)
            return standing;
        take_largest();
    }
}

/// How a unit of the felt motion moves a place of the tool.
Vector3d work_direction(const Load& load, const Point& place_m) {
    const Vector3d arm =
        vector_of(place_m) - vector_of(load.motion.pivot_m) - vector_of(load.motion.translation_m);
    return vector_of(load.felt_translation) + vector_of(load.felt_turn_per_m).cross(arm);
}

/// Collects what the load does to each node of the tool.
class Application {
  public:
    Application(const Load& load, const TetMesh& mesh, AppliedLoad& applied)
        : load_(load), mesh_(mesh), applied_(applied) {}

    void follow(std::uint32_t node) {
        applied_.motion.nodes.push_back(node);
        applied_.motion.displacement_m.push_back(point_of(shift(node)));
        applied_.work_directions.push_back(point_of(direction(node)));
    }

    void tie(const MeshedRegion& region, const Standing& standing, std::size_t row) {
        TiedNode tied;
        tied.node = region.nodes[standing.under[row]];
        Vector3d constant = shift(tied.node);
        Vector3d work = direction(tied.node);
        for (std::size_t k = 0; k < standing.beside.size(); ++k) {
            const double weight =
                standing.weights(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k));
            if (std::abs(weight) < kSmallestWeight) continue;
            const std::uint32_t node = region.nodes[standing.beside[k]];
            tied.masters.emplace_back(node, weight);
            constant -= weight * shift(node);
            work -= weight * direction(node);
        }
        tied.displacement_m = point_of(constant);
        if (tied.masters.empty()) return follow(tied.node);
        applied_.motion.ties.push_back(std::move(tied));
        tie_works_.push_back(point_of(work));
    }

    void finish() {
        applied_.work_directions.insert(applied_.work_directions.end(), tie_works_.begin(), tie_works_.end());
    }

  private:
    [[nodiscard]] Vector3d shift(std::uint32_t node) const {
        return vector_of(load_.motion.place_of(mesh_.nodes_m[node])) - vector_of(mesh_.nodes_m[node]);
    }
    [[nodiscard]] Vector3d direction(std::uint32_t node) const {
        return work_direction(load_, load_.motion.place_of(mesh_.nodes_m[node]));
    }

    const Load& load_;
    const TetMesh& mesh_;
    AppliedLoad& applied_;
    std::vector<Point> tie_works_;
};

}  // namespace

Point RigidMotion::place_of(const Point& rest_m) const {
    const Vector3d arm = vector_of(rest_m) - vector_of(pivot_m);
    const Vector3d turned = Eigen::AngleAxisd(angle_rad, vector_of(axis)) * arm;
    return point_of(vector_of(pivot_m) + turned + vector_of(translation_m));
}

const std::vector<std::string>& named_loads() {
    static const std::vector<std::string> names{"press10", "press20", "shear", "twist", "combined",
                                                "pad4",    "pad3",    "tip2",  "side"};
    return names;
}

Load named_load(const std::string& name, const Box& object) {
    const double height = object.size_m()[2];
    const Point down{0, 0, -kPress * height};
    if (name == "press10") return pushing(name, top_of(object), down);
    if (name == "press20") return pushing(name, top_of(object), {0, 0, -kDeepPress * height});
    if (name == "shear") return pushing(name, top_of(object), {kShear * height, 0, 0});
    if (name == "twist") return twisting(name, object);
    if (name == "combined") return combined(name, object);
    if (name == "pad4") return pushing(name, pad_on_top(object, 0.1, 0.5, 0.4, 0.8), down);
    if (name == "pad3") return pushing(name, pad_on_top(object, 0.5, 0.8, 0.2, 0.5), down);
    if (name == "tip2") return pushing(name, pad_on_top(object, 0.3, 0.5, 0.5, 0.7), down);
    if (name == "side") return side_pad(name, object);
    fail_usage("unknown load: " + name);
}

AppliedLoad apply_load(const Load& load, const TetMesh& mesh, const std::vector<bool>& is_held) {
    return apply_load(load, mesh_region(mesh, load.region), mesh, is_held);
}

AppliedLoad apply_load(const Load& load, const MeshedRegion& region, const TetMesh& mesh,
                       const std::vector<bool>& is_held) {
    if (region.nodes.empty()) fail_input(fmt::format("load {}: the object has no surface there", load.name));
    AppliedLoad applied;
    for (std::uint32_t n = 0; n < is_held.size(); ++n)
        if (is_held[n]) applied.motion.nodes.push_back(n);
    applied.held_count = applied.motion.nodes.size();
    applied.motion.displacement_m.assign(applied.held_count, Point{});
    const Standing standing = stand(region);
    Application application(load, mesh, applied);
    for (std::size_t row = 0; row < standing.under.size(); ++row) {
        if (is_held[region.nodes[standing.under[row]]])
            fail_input(fmt::format("load {}: touches what the scene holds", load.name));
        application.tie(region, standing, row);
    }
    application.finish();
    return applied;
}

double felt_force_n(const AppliedLoad& load, const StaticSolution& solution) {
    double felt = 0;
    const std::size_t tool_nodes = load.motion.nodes.size() - load.held_count;
    for (std::size_t k = 0; k < load.work_directions.size(); ++k) {
        const Point& reaction = k < tool_nodes ? solution.reactions_n[load.held_count + k]
                                               : solution.tied_reactions_n[k - tool_nodes];
        for (std::size_t axis = 0; axis < 3; ++axis)
            felt -= load.work_directions[k][axis] * reaction[axis];
    }
    return felt;
}

}  // namespace knead::tools
