// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/live_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace knead::tools {
namespace {

constexpr double kMillimetres = 1e3, kMicroseconds = 1e6, kPercent = 100;
constexpr std::size_t kWidestBar = 40, kNarrowestBar = 4;

std::string rates(const LiveFrame& frame) {
    if (frame.mode == HapticMode::synchronous) return fmt::format("{:g} Hz, synchronous", frame.rate_hz);
    return fmt::format("{:g} Hz, simulation {:g} Hz", frame.rate_hz, frame.simulation_rate_hz);
}

std::string row(const char* name, const std::string& text) {
    return fmt::format("  {:<10} {}", name, text);
}

std::string time_text(const LiveFrame& frame, const TouchTotals& totals) {
    return fmt::format("{:.1f} of {:.1f} s{}", totals.seconds, frame.seconds,
                       frame.virtual_time ? ", virtual" : "");
}

std::string force_text(const LiveFrame& frame, const TouchTotals& totals, std::size_t columns) {
    const double share = totals.force_n / frame.limit_n;
    const std::string number = fmt::format("{:6.2f} N ", totals.force_n);
    const std::string rest = fmt::format(" {:3.0f} % of {:.2f} N", kPercent * share, frame.limit_n);
    constexpr std::size_t kAround = 15;  // name of the row and brackets
    const std::size_t taken = kAround + number.size() + rest.size();
    const std::size_t room = columns > taken ? columns - taken : 0;
    return number + bar(share, std::clamp(room, kNarrowestBar, kWidestBar)) + rest;
}

/// Millimetres that are not printed as "-0.00".
double shown_mm(double metres) {
    const double mm = kMillimetres * metres;
    return std::abs(mm) < 0.5e-3 ? 0 : mm;
}

std::string miss_text(const RunStatistics& statistics) {
    return fmt::format("{} ours, {} machine's", statistics.misses_ours, statistics.misses_preempted);
}

}  // namespace

LiveFrame live_frame(const Asset& asset, const TouchSetup& setup) {
    LiveFrame frame;
    frame.title = fmt::format("{} {}, tool {}, {}{}", asset.name, asset.level, asset.tools[setup.tool].name,
                              setup.request.simulated_hand ? "a hand on " : "", setup.device_name);
    frame.seconds = setup.seconds;
    frame.limit_n = setup.haptic.safety.max_force_n;
    frame.mode = setup.haptic.mode;
    frame.rate_hz = setup.haptic.rate_hz;
    frame.simulation_rate_hz = setup.haptic.simulation_rate_hz;
    frame.virtual_time = setup.request.virtual_time;
    return frame;
}

std::string bar(double share, std::size_t cells) {
    const double filled = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) * static_cast<double>(cells) : 0;
    const auto full = static_cast<std::size_t>(filled + 1e-9);
    return "[" + std::string(full, '#') + std::string(cells - full, '-') + (full == cells ? "!" : "]");
}

std::vector<std::string> live_block(const LiveFrame& frame, const TouchTotals& totals,
                                    const RunStatistics& statistics, std::size_t columns) {
    std::vector<std::string> lines{"knead-touch: " + frame.title};
    lines.push_back(row("time", time_text(frame, totals) + "   " + rates(frame)));
    if (!frame.virtual_time) {
        lines.push_back(
            row("reached", fmt::format("{:.1f} Hz, missed {}", statistics.rate_hz, miss_text(statistics))));
        std::string took = fmt::format("p50 {:.0f} us, p99 {:.0f} us", kMicroseconds * statistics.tick.p50_s,
                                       kMicroseconds * statistics.tick.p99_s);
        if (frame.mode == HapticMode::two_rate)
            took += fmt::format("; step p50 {:.0f} us", kMicroseconds * statistics.simulation.p50_s);
        lines.push_back(row("tick", took));
    }
    lines.push_back(row("force", force_text(frame, totals, columns)));
    lines.push_back(
        row("depth", fmt::format("tool {:.2f} mm, hand {:.2f} mm, {} nodes", shown_mm(totals.tool_depth_m),
                                 shown_mm(totals.hand_depth_m), totals.touched_nodes)));
    lines.push_back(
        row("saturated", fmt::format("{:.1f} % of the time", kPercent * totals.saturated_share())));
    lines.push_back(row("status", status_words(totals.recent_haptic_status, totals.recent_step_status)));
    for (std::string& line : lines)
        if (line.size() > columns) line.resize(columns);
    return lines;
}

std::string live_line(const LiveFrame& frame, const TouchTotals& totals, const RunStatistics& statistics) {
    std::string line =
        fmt::format("{:7.3f} s  force {:6.3f} N  depth {:6.3f} mm  hand {:6.3f} mm  saturated {:5.1f} %",
                    totals.seconds, totals.force_n, shown_mm(totals.tool_depth_m),
                    shown_mm(totals.hand_depth_m), kPercent * totals.saturated_share());
    if (!frame.virtual_time) line += fmt::format("  missed {}", statistics.misses);
    return line + "  " + status_words(totals.recent_haptic_status, totals.recent_step_status);
}

}  // namespace knead::tools
