// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/level_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.h"
#include "knead/formats/asset_object.h"
#include "knead/formats/numerics.h"
#include "quality/tool_place.h"
#include "quality/union_find.h"
#include "reference/static_problem.h"

namespace knead::tools {
namespace {

constexpr double kPress = 0.1;             ///< of the object's extent along the press, as in knead-evaluate
constexpr std::size_t kFewestNodes = 3;    ///< a curved tool that reaches fewer is not resolved by the mesh
constexpr double kAlongAnAxis = 1 - 1e-9;  ///< rounding of a unit quaternion
constexpr double kInclusionContrast =
    3;  ///< from here on the force's path is soft beside the stiffest matter
constexpr double kUniformModulus_pa = 1e4;  ///< any: the ratio of two forces does not depend on it

double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A press as both objects get it.
struct Press {
    Point direction{};
    double way_m = 0;    ///< of the tool
    double start_m = 0;  ///< way to the first node of the fine object
};

Press press_of(const Asset& fine, const ToolSet& tool) {
    Press press{press_direction(tool), 0, 0};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& node : fine.nodes_m) {
        low = std::min(low, dot(node, press.direction));
        high = std::max(high, dot(node, press.direction));
    }
    press.way_m = kPress * (high - low);
    if (tool.contact == ToolContact::bonded) return press;
    press.start_m = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : tool.nodes)
        if (const ToolGap gap = gap_of(tool, fine.nodes_m[node]); gap.beside_m == 0)
            press.start_m = std::min(press.start_m, gap.ahead_m);
    return press;
}

/// What is held first, then what the tool moves.
PrescribedMotion motion_of(const Asset& asset, const ToolSet& tool, const Press& press) {
    PrescribedMotion motion;
    std::uint8_t tool_axes = kAllAxes;
    if (tool.contact == ToolContact::frictionless)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (std::abs(press.direction[axis]) > kAlongAnAxis)
                tool_axes = static_cast<std::uint8_t>(1U << axis);
    const auto move = [&](std::uint32_t node, double way_m, std::uint8_t axes) {
        motion.nodes.push_back(node);
        motion.displacement_m.push_back(
            {way_m * press.direction[0], way_m * press.direction[1], way_m * press.direction[2]});
        motion.axes.push_back(axes);
    };
    for (std::uint32_t n = asset.free_node_count; n < asset.nodes_m.size(); ++n)
        move(n, 0, kAllAxes);
    for (const std::uint32_t node : tool.nodes) {
        if (tool.contact == ToolContact::bonded) {
            move(node, press.way_m, kAllAxes);
            continue;
        }
        const ToolGap gap = gap_of(tool, asset.nodes_m[node]);
        const double depth_m = press.start_m + press.way_m - gap.ahead_m;
        if (gap.beside_m == 0 && depth_m > 0) move(node, depth_m, tool_axes);
    }
    return motion;
}

/// Force against the press, newtons.
double force_n(const Asset& asset, const PrescribedMotion& motion, const Press& press, bool uniform) {
    MaterialObject object = object_of(asset);
    if (uniform)
        object.material.youngs_modulus_pa.assign(object.material.youngs_modulus_pa.size(),
                                                 kUniformModulus_pa);
    const StaticSolution solution = StaticProblem(object.mesh, object.material).solve_linear(motion);
    double force = 0;
    for (std::size_t k = asset.nodes_m.size() - asset.free_node_count; k < motion.nodes.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((motion.axes[k] & (1U << axis)) != 0)
                force -= solution.reactions_n[k][axis] * press.direction[axis];
    return force;
}

/// What makes one elasticity for all a bad guess: said before an error that it explains.
std::string cause_in(const Asset& fine) {
    const double path_pa = path_youngs_modulus_pa(fine);
    const Numerics numerics = choose_numerics(fine);
    if (numerics.press_contrast <= kInclusionContrast) return {};
    // Stiff bodies: what hangs together of the matter nearer to the stiffest than to the path of the force.
    const double stiff_pa = path_pa * std::sqrt(numerics.press_contrast);
    const auto is_stiff = [&](std::size_t t) {
        return fine.palette[fine.palette_index[t]].youngs_modulus_pa > stiff_pa;
    };
    UnionFind bodies(fine.nodes_m.size());
    for (std::size_t t = 0; t < fine.tetrahedra.size(); ++t)
        for (std::size_t k = 1; is_stiff(t) && k < 4; ++k)
            bodies.join(fine.tetrahedra[t][0], fine.tetrahedra[t][k]);
    std::vector<bool> reached(fine.nodes_m.size(), false);  // by a tool, or held; of roots
    for (std::uint32_t n = fine.free_node_count; n < fine.nodes_m.size(); ++n)
        reached[bodies.root(n)] = true;
    for (const ToolSet& tool : fine.tools)
        for (const std::uint32_t node : tool.nodes)
            reached[bodies.root(node)] = true;
    std::size_t inside = 0, stiff = 0;
    for (std::size_t t = 0; t < fine.tetrahedra.size(); ++t) {
        if (!is_stiff(t)) continue;
        ++stiff;
        if (!reached[bodies.root(fine.tetrahedra[t][0])]) ++inside;
    }
    return 2 * inside > stiff ? "a stiff inclusion in soft matter: " : "stiff and soft matter in a row: ";
}

std::string percent(double error) {
    return fmt::format("{:+.0f} %", 100 * error);
}

const char* advice_for(const PressComparison& comparison) {
    if (std::abs(*comparison.mesh_error) > std::abs(*comparison.elasticity_error))
        return "use a finer mesh for this level";
    return "try rule = \"volume-average\", more bins and clusters, or another seed, and look at it with "
           "knead-evaluate";
}

}  // namespace

PressComparison LevelCheck::compare(const Asset& level, std::size_t tool) {
    PressComparison result;
    result.tool = fine_.tools[tool].name;
    const std::size_t fine_held = fine_.nodes_m.size() - fine_.free_node_count;
    const std::size_t level_held = level.nodes_m.size() - level.free_node_count;
    if (fine_held == 0) {
        result.problem = "nothing holds the object";
        return result;
    }
    const Press press = press_of(fine_, fine_.tools[tool]);
    const PrescribedMotion fine_motion = motion_of(fine_, fine_.tools[tool], press);
    const PrescribedMotion level_motion = motion_of(level, level.tools[tool], press);
    const std::size_t reached =
        std::min(fine_motion.nodes.size() - fine_held, level_motion.nodes.size() - level_held);
    if (reached < kFewestNodes) {
        result.problem = fmt::format("a press of {:.3g} m reaches {} nodes", press.way_m, reached);
        return result;
    }
    const auto error = [&](std::optional<double>& fine_n, bool uniform) {
        if (!fine_n) fine_n = force_n(fine_, fine_motion, press, uniform);
        return force_n(level, level_motion, press, uniform) / *fine_n - 1;
    };
    try {
        result.force_error = error(forces_n_[tool].as_it_is, false);
        if (std::abs(result.force_error) > kLevelForceError) {
            result.mesh_error = error(forces_n_[tool].uniform, true);
            result.elasticity_error = (1 + result.force_error) / (1 + *result.mesh_error) - 1;
        }
    } catch (const ToolError& failure) {
        result.problem = failure.what();
    }
    return result;
}

std::vector<PressComparison> LevelCheck::compare(const Asset& level) {
    std::vector<PressComparison> comparisons;
    for (std::size_t tool = 0; tool < fine_.tools.size(); ++tool)
        comparisons.push_back(compare(level, tool));
    return comparisons;
}

Findings findings_of(const std::vector<PressComparison>& comparisons, const Asset& fine,
                     const std::string& level) {
    const std::string cause = cause_in(fine);
    Findings findings;
    for (const PressComparison& comparison : comparisons) {
        if (!comparison.problem.empty()) {
            findings.push_back(
                {false, "level-unchecked", 0, "",
                 fmt::format("level {} was not compared with the fine object under tool {}: {}", level,
                             comparison.tool, comparison.problem),
                 "use knead-evaluate"});
            continue;
        }
        const bool errs = std::abs(comparison.force_error) > kLevelForceError;
        std::string text = fmt::format("level {} errs by {} in the force on tool {}", level,
                                       percent(comparison.force_error), comparison.tool);
        if (errs) text = cause + text;
        if (errs)
            text += fmt::format(": {} by its elasticities, {} by its mesh",
                                percent(*comparison.elasticity_error), percent(*comparison.mesh_error));
        text += fmt::format(" (linear estimate; a hand tells {:g} %)", 100 * kLevelForceError);
        findings.push_back({errs, "level-force", comparison.force_error, "", text,
                            errs ? advice_for(comparison) : "nothing"});
    }
    return findings;
}

}  // namespace knead::tools
