// SPDX-License-Identifier: GPL-3.0-or-later
// knead-touch: runs the haptic loop on an asset in a terminal.
#include <iostream>
#include <system_error>

#include "common/input.h"
#include "common/progress.h"
#include "common/run_tool.h"
#include "knead/formats/write/write.h"
#include "knead/haptics/session.h"
#include "touch/device_list.h"
#include "touch/interrupt.h"
#include "touch/live_text.h"
#include "touch/options.h"
#include "touch/renderability.h"
#include "touch/screen.h"
#include "touch/touch_report.h"

namespace knead::tools {
namespace {

namespace fs = std::filesystem;

std::vector<DevicePreset> read_devices(ToolContext& context) {
    std::error_code none;
    const fs::path file = devices_file_of(fs::read_symlink("/proc/self/exe", none));
    return parse_device_presets(read_input_bytes(context, file).value, file.string());
}

/// A block that is drawn over itself on a terminal, lines elsewhere.
TouchListener listener_for(const LiveFrame& frame, const ToolContext& context, Screen& screen) {
    constexpr double kScreenPeriod_s = 1.0 / 15, kLinePeriod_s = 0.1;
    TouchListener listener;
    listener.interrupted = interrupted;
    const bool block = Screen::on_terminal();
    listener.show_period_s = block ? kScreenPeriod_s : kLinePeriod_s;
    if (context.quiet) return listener;
    listener.show = [&frame, &screen, block](const TouchTotals& totals, const RunStatistics& statistics) {
        if (block)
            screen.draw(live_block(frame, totals, statistics, screen.columns()));
        else
            std::cout << live_line(frame, totals, statistics) << std::endl;
    };
    return listener;
}

ExitCode touch(ToolContext& context, const TouchOptions& options, const TouchRequest& request) {
    for (const fs::path& output : {options.log, options.json})
        if (!output.empty()) require_writable_folder(output);
    const std::vector<DevicePreset> devices = read_devices(context);
    const DevicePreset& preset = find_device(devices, options.device);
    const Input<Asset> asset = read_input<Asset>(context, options.asset);
    const TouchSetup setup = make_touch_setup(asset.value, preset, request);
    const std::unique_ptr<Device> device = make_device(setup, preset);
    const LiveFrame frame = live_frame(asset.value, setup);

    catch_interrupts();
    TouchOutcome outcome;
    {
        Screen screen;
        outcome = run_touch(asset.value, asset.content_hash, setup, *device, !options.log.empty(),
                            listener_for(frame, context, screen));
    }
    if (outcome.log) {
        if (outcome.log->lost_ticks + outcome.log->lost_steps > 0)
            context.warn("the log was full before the end: what it holds can be replayed");
        Provenance provenance = context.provenance(canonical_arguments(setup));
        provenance.inputs = {{"asset", asset.content_hash}};
        value_or_throw(write_session_log(options.log, *outcome.log, provenance));
    }
    if (!options.json.empty())
        value_or_throw(write_text_file(options.json,
                                       touch_summary_json(asset.value, asset.content_hash, setup, outcome)));
    if (!context.quiet) std::cout << touch_summary_text(setup, outcome);
    return ExitCode::done;
}

ExitCode run_replay(ToolContext& context, const TouchOptions& options) {
    const Input<Asset> asset = read_input<Asset>(context, options.asset);
    const SessionLog log = read_input<SessionLog>(context, options.replay).value;
    if (log.asset_content_hash != asset.content_hash)
        fail_input(options.replay.string() + ": the session was with another asset than " +
                   options.asset.string());
    const ReplayReport report = about(options.replay, [&] {
        Simulation simulation =
            value_or_throw(Simulation::create(asset.value, value_or_throw(simulation_config_of(log))));
        return value_or_throw(replay(log, simulation));
    });
    if (!context.quiet)
        std::cout << (report.same ? "same bits: " + std::to_string(report.ticks) + " ticks, " +
                                        std::to_string(report.steps) + " steps"
                                  : "differs: " + report.first_difference)
                  << "\n";
    return report.same ? ExitCode::done : ExitCode::answer_is_no;
}

ExitCode run_renderability(ToolContext& context, const TouchOptions& options, const TouchRequest& request) {
    if (!options.json.empty()) require_writable_folder(options.json);
    const std::vector<DevicePreset> devices = read_devices(context);
    const DevicePreset& preset = find_device(devices, options.renderability);
    const Input<Asset> asset = read_input<Asset>(context, options.asset);
    const std::size_t tool = find_tool(asset.value, request.tool);
    const PressLine line = press_line(asset.value, tool, request.direction);
    Progress progress(!context.quiet);
    const Renderability found = find_renderability(
        asset.value, tool, line, preset, [&](std::size_t done, std::size_t parts, const std::string& what) {
            progress.show(done, parts, what);
        });
    progress.clear();
    if (!options.json.empty())
        value_or_throw(write_text_file(
            options.json, renderability_json(asset.value, asset.content_hash, tool, preset, found)));
    if (!context.quiet) std::cout << renderability_text(asset.value, tool, preset, found);
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    ToolInfo info{"knead-touch",
                  "touch an asset in a terminal: a scripted press or a simulated hand in the haptic loop.",
                  "knead-touch steak.hdf --hand --press 10mm --log session.hdf --json summary.json",
                  {}};
    info.writes_report = false;
    info.writes_depfile = false;
    TouchOptions options;
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare_options(app, options); },
        [&](ToolContext& context) {
            const TouchRequest request = touch_request(options);
            switch (options.command()) {
                case TouchOptions::Command::list_devices:
                    std::cout << device_list_text(read_devices(context));
                    return ExitCode::done;
                case TouchOptions::Command::replay:
                    return run_replay(context, options);
                case TouchOptions::Command::renderability:
                    return run_renderability(context, options, request);
                case TouchOptions::Command::run:
                    break;
            }
            return touch(context, options, request);
        });
}
