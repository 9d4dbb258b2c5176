// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/touch_report.h"

#include <fmt/format.h>

#include <cmath>

#include "touch/asset_json.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3, kMillijoules = 1e3, kMicroseconds = 1e6, kPercent = 100;

std::uint32_t bits_of(const auto& ticks) {
    std::uint32_t bits = 0;
    for (std::size_t bit = 0; bit < ticks.size(); ++bit)
        if (ticks[bit] > 0) bits |= std::uint32_t{1} << bit;
    return bits;
}

Json counts(const auto& ticks, const auto& names) {
    Json json = Json::object();
    for (std::size_t bit = 0; bit < names.size(); ++bit)
        json[names[bit]] = ticks[bit];
    return json;
}

Json json_of(const DurationStatistics& times) {
    return {{"count", times.count},
            {"p50_s", times.p50_s},
            {"p99_s", times.p99_s},
            {"p999_s", times.p999_s},
            {"max_s", times.max_s}};
}

Json json_of(const RunStatistics& run) {
    return {{"seconds", run.seconds},
            {"rate_hz", run.rate_hz},
            {"jitter_s", run.jitter_s},
            {"haptic", json_of(run.haptic)},
            {"tick", json_of(run.tick)},
            {"simulation", json_of(run.simulation)},
            {"misses", run.misses},
            {"misses_ours", run.misses_ours},
            {"misses_preempted", run.misses_preempted},
            {"simulation_misses", run.simulation_misses},
            {"longest_tick_s", run.longest_tick_s},
            {"realtime_priority", run.realtime_priority},
            {"realtime_error", run.realtime_error}};
}

Json json_of(const TouchSetup& setup) {
    const Press& press = setup.request.press;
    return {{"kind", setup.request.simulated_hand ? "simulated_hand" : "press"},
            {"device", setup.device_name},
            {"depth_m", press.depth_m},
            {"speed_m_per_s", press.speed_m_per_s},
            {"hold_s", press.hold_s},
            {"release_s", press.release_s},
            {"direction", setup.line.direction}};
}

/// What would be printed as "-0.000" is 0.
double without_minus_zero(double value) {
    return std::abs(value) < 0.5e-3 ? 0 : value;
}

std::string real_time_text(const TouchSetup& setup, const RunStatistics& run) {
    std::string text = fmt::format("  rate       {:.1f} Hz{}\n", run.rate_hz,
                                   run.realtime_priority ? "" : ", without real-time priority");
    text += fmt::format("  missed     {} ours, {} machine's\n", run.misses_ours, run.misses_preempted);
    text += fmt::format("  tick       p50 {:.0f} us, p99 {:.0f} us, longest {:.0f} us\n",
                        kMicroseconds * run.tick.p50_s, kMicroseconds * run.tick.p99_s,
                        kMicroseconds * run.tick.max_s);
    if (setup.haptic.mode == HapticMode::two_rate)
        text += fmt::format("  step       p50 {:.0f} us, p99 {:.0f} us; {} of {} late\n",
                            kMicroseconds * run.simulation.p50_s, kMicroseconds * run.simulation.p99_s,
                            run.simulation_misses, run.simulation.count);
    return text;
}

}  // namespace

std::string touch_summary_text(const TouchSetup& setup, const TouchOutcome& outcome) {
    const TouchTotals& t = outcome.totals;
    std::string text = fmt::format("{} after {:.3f} s, {} ticks\n",
                                   outcome.interrupted ? "interrupted" : "done", t.seconds, t.ticks);
    text += fmt::format("  force      at most {:.3f} N of {:g} N; wanted {:.3f} N\n", t.largest_force_n,
                        setup.haptic.safety.max_force_n, setup.haptic.force_scale * t.largest_scene_force_n);
    text += fmt::format("  saturated  {:.1f} % of the time\n", kPercent * t.saturated_share());
    text += fmt::format("  depth      tool {:.3f} mm, hand {:.3f} mm, {} nodes at most\n",
                        kMillimetres * t.largest_tool_depth_m, kMillimetres * t.largest_hand_depth_m,
                        t.most_touched_nodes);
    text += fmt::format("  energy     {:.3f} mJ from the hand (net), lowest {:.3f} mJ\n",
                        without_minus_zero(kMillijoules * t.absorbed_j),
                        without_minus_zero(kMillijoules * t.least_absorbed_j));
    if (!setup.request.virtual_time) text += real_time_text(setup, outcome.statistics);
    text +=
        "  status     " + status_words(bits_of(t.haptic_status_ticks), bits_of(t.step_status_ticks)) + "\n";
    return text;
}

std::string touch_summary_json(const Asset& asset, const std::string& asset_content_hash,
                               const TouchSetup& setup, const TouchOutcome& outcome) {
    const TouchTotals& t = outcome.totals;
    Json json;
    json["schema"] = "knead-touch/1";
    json["asset"] = asset_json(asset, asset_content_hash, setup.tool);
    json["hand"] = json_of(setup);
    json["time"] = setup.request.virtual_time ? "virtual" : "real";
    json["asked_s"] = setup.seconds;
    json["end"] = outcome.interrupted ? "interrupted" : "done";
    json["ticks"] = t.ticks;
    json["seconds"] = t.seconds;
    json["force"] = {{"largest_n", t.largest_force_n},
                     {"largest_of_object_n", t.largest_scene_force_n},
                     {"limit_n", setup.haptic.safety.max_force_n},
                     {"saturated_share", t.saturated_share()}};
    json["depth"] = {{"largest_of_tool_m", t.largest_tool_depth_m},
                     {"largest_of_hand_m", t.largest_hand_depth_m},
                     {"most_touched_nodes", t.most_touched_nodes}};
    json["energy"] = {{"absorbed_j", t.absorbed_j}, {"least_absorbed_j", t.least_absorbed_j}};
    json["haptic_status_ticks"] = counts(t.haptic_status_ticks, kHapticStatusNames);
    json["step_status_ticks"] = counts(t.step_status_ticks, kStepStatusNames);
    if (!setup.request.virtual_time) json["statistics"] = json_of(outcome.statistics);
    Json& config = json["config"] = Json::object();
    for (const SessionLog::Setting& setting : outcome.settings)
        config[setting.name] = setting.value;
    return json.dump(2) + "\n";
}

}  // namespace knead::tools
