// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "knead/runtime/pose.h"
#include "stability/specimen.h"

namespace knead::tools::stability {

/// What the tools do in a run.
///
/// Time runs from 0; the tools rest until `moves_s` at the earliest. Phases that the judge knows: the tools
/// are still from `still_s` until `leave_s`; the object rests, released, from `released_s` until `end_s`.
struct Script {
    /// Where the tools are at a time. @param poses in: the rest poses; out
    std::function<void(double time_s, std::vector<Pose>& poses)> move;
    double dt_s = 1e-3;
    /// Length of each step, if they are not all the same. @param step from 0
    std::function<double(std::size_t step)> varying_dt_s = {};
    double still_s = 0, leave_s = 0;
    double released_s = 0;
    double end_s = 0;
    /// Start of the soak's steady part, if it is one: its first and last tenth are compared.
    double steady_s = -1;

    [[nodiscard]] double dt(std::size_t step) const { return varying_dt_s ? varying_dt_s(step) : dt_s; }
};

/// Hand speed of the presses.
inline constexpr double kHandSpeed_m_per_s = 0.1;

/// How far, how fast and whether the tool leaves the object at the end.
struct Press {
    Point way_m{};  ///< of all tools
    Eigen::AngleAxisd turn = Eigen::AngleAxisd(0, Eigen::Vector3d::UnitZ());
    double ramp_s = 0;    ///< zero: at kHandSpeed_m_per_s, a radian in half a second, 20 steps at least
    bool leaves = false;  ///< afterwards the tool is a size away; else back at its rest pose
    bool holds = true;    ///< until the object has come to rest; else for a tenth of the ramp
    bool rests = true;    ///< likewise after the release
    double longer_s = 0;  ///< beside the time that the object needs, for both
};
[[nodiscard]] Script press_script(const Specimen& specimen, const Press& press, double dt_s);

/// `rest` moved and turned about its own origin.
[[nodiscard]] Pose moved(const Pose& rest, const Point& way_m, const Eigen::AngleAxisd& turn);

}  // namespace knead::tools::stability
