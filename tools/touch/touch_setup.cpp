// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/touch_setup.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "knead/haptics/scripted_device.h"
#include "knead/haptics/simulated_operator.h"

namespace knead::tools {
namespace {

constexpr double kWait_s = 0.35;  ///< the safety chain's ramp is over then
constexpr double kRest_s = 0.2;   ///< after the release

double press_s(const Press& press) {
    return press.depth_m / press.speed_m_per_s;
}

double script_s(const Press& press) {
    const double sum_s = kWait_s + press_s(press) + press.hold_s + press.release_s + kRest_s;
    return std::round(1e6 * sum_s) / 1e6;  // for who reads it
}

Vec3 unit(const Vec3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

Vec3 down_axis(const ToolSet& tool) {
    const auto& [w, x, y, z] = tool.rest_orientation_wxyz;
    const Eigen::Vector3d down = Eigen::Quaterniond(w, x, y, z) * Eigen::Vector3d(0, 0, -1);
    return {down.x(), down.y(), down.z()};
}

/// From the tool to the nearest point of the box of its nodes; nothing when it is in the box.
std::optional<Vec3> way_to_nodes(const Asset& asset, const ToolSet& tool) {
    if (tool.nodes.empty()) return std::nullopt;
    Point low = asset.nodes_m[tool.nodes.front()], high = low;
    for (const std::uint32_t node : tool.nodes)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], asset.nodes_m[node][axis]);
            high[axis] = std::max(high[axis], asset.nodes_m[node][axis]);
        }
    Vec3 way{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        way[axis] =
            std::clamp(tool.rest_position_m[axis], low[axis], high[axis]) - tool.rest_position_m[axis];
    if (way == Vec3{}) return std::nullopt;
    return unit(way);
}

/// In the device's frame: its origin is where the tool rests.
Pose start_of(const TouchSetup& setup) {
    Pose start;
    start.orientation_wxyz = setup.line.rest.orientation_wxyz;
    return start;
}

Vec3 travel_of(const TouchSetup& setup) {
    Vec3 travel = setup.line.direction;
    for (double& way : travel)
        way *= setup.request.press.depth_m;
    return travel;
}

std::unique_ptr<Device> scripted(const TouchSetup& setup) {
    const Press& press = setup.request.press;
    PressScript script;
    script.start = start_of(setup);
    script.travel_m = travel_of(setup);
    script.wait_s = kWait_s;
    script.press_s = press_s(press);
    script.hold_s = press.hold_s;
    script.release_s = press.release_s;
    script.rest_s = kRest_s;
    script.rate_hz = setup.haptic.rate_hz;
    std::vector<DeviceState> samples = press_samples(script);
    if (samples.empty()) fail_usage("the press takes too long to be scripted");
    return std::make_unique<ScriptedDevice>(std::move(samples));
}

std::unique_ptr<Device> held_by_a_hand(const TouchSetup& setup, const DevicePreset& preset) {
    const Press& press = setup.request.press;
    OperatorConfig hand = operator_on(preset);
    hand.period_s = 1 / setup.haptic.rate_hz;
    const Pose start = start_of(setup);
    Pose deep = start;
    deep.position_m = travel_of(setup);
    const double in_s = kWait_s + press_s(press), out_s = in_s + press.hold_s;
    hand.path = {{kWait_s, start}, {in_s, deep}, {out_s, deep}, {out_s + press.release_s, start}};
    return std::make_unique<SimulatedOperator>(value_or_throw(SimulatedOperator::create(hand)));
}

}  // namespace

std::uint64_t TouchSetup::tick_count() const {
    return static_cast<std::uint64_t>(std::llround(seconds * haptic.rate_hz));
}

std::size_t find_tool(const Asset& asset, const std::string& tool) {
    std::string names;
    for (std::size_t i = 0; i < asset.tools.size(); ++i) {
        if (tool == asset.tools[i].name || tool == std::to_string(i)) return i;
        names += fmt::format("{}{} {}", names.empty() ? "" : ", ", i, asset.tools[i].name);
    }
    if (names.empty()) fail_input("the asset has no tool: nothing can touch it");
    fail_usage(fmt::format("tool \"{}\" is none of the asset's: {}", tool, names));
}

PressLine press_line(const Asset& asset, std::size_t tool, const std::optional<Vec3>& direction) {
    const ToolSet& set = asset.tools.at(tool);
    PressLine line;
    line.rest.position_m = set.rest_position_m;
    line.rest.orientation_wxyz = set.rest_orientation_wxyz;
    if (direction)
        line.direction = unit(*direction);
    else if (const auto towards = set.shape == ToolShape::plate ? std::nullopt : way_to_nodes(asset, set))
        line.direction = *towards;
    else
        line.direction = down_axis(set);
    return line;
}

TouchSetup make_touch_setup(const Asset& asset, const DevicePreset& preset, const TouchRequest& request) {
    TouchSetup setup;
    setup.request = request;
    setup.device_name = preset.name;
    setup.tool = find_tool(asset, request.tool);
    setup.line = press_line(asset, setup.tool, request.direction);
    setup.seconds = request.seconds.value_or(script_s(request.press));
    if (!(std::max(setup.seconds, script_s(request.press)) <= kLongestTouch_s))
        fail_usage(fmt::format("the run would take more than {:g} s", kLongestTouch_s));

    HapticConfig& haptic = setup.haptic;
    haptic.workspace.offset_m = setup.line.rest.position_m;
    haptic.force_scale = request.force_scale;
    haptic.rate_hz = request.rate_hz;
    haptic.mode = request.mode;
    haptic.simulation_rate_hz = request.simulation_rate_hz;
    haptic.rendering = request.rendering;
    haptic.coupling.stiffness_n_per_m = request.coupling_n_per_m.value_or(preset.max_stiffness_n_per_m.value);
    DevicePreset limited = preset;
    if (request.max_force_n) limited.max_force_n.value = *request.max_force_n;
    haptic.safety = safety_for(limited);
    haptic.safety.passivity = request.passivity;

    SimulationConfig base;
    base.tools = {setup.tool};
    setup.simulation = simulation_config(haptic, base);
    return setup;
}

std::unique_ptr<Device> make_device(const TouchSetup& setup, const DevicePreset& preset) {
    return setup.request.simulated_hand ? held_by_a_hand(setup, preset) : scripted(setup);
}

}  // namespace knead::tools
