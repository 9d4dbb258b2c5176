// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/options.h"

#include <fmt/format.h>

#include <cmath>

#include "common/run_tool.h"

namespace knead::tools {
namespace {

constexpr double kSlowest_hz = 500, kSlowestSimulation_hz = 50, kFastest_hz = 4000;  // as HapticLoop

void declare_press(CLI::App& app, TouchOptions& o) {
    const char* const group = "Touch";
    TouchRequest& r = o.request;
    const auto keep = [&](CLI::Option* option) { o.run_only.push_back(option->group(group)); };
    keep(app.add_option("--press", o.depth, "how deep, from the tool's rest pose")
             ->type_name("LENGTH")
             ->capture_default_str());
    keep(app.add_option("--speed", o.speed, "on the way in, per second")
             ->type_name("LENGTH/s")
             ->capture_default_str());
    keep(app.add_option("--hold", r.press.hold_s, "seconds at the deepest point")
             ->type_name("S")
             ->capture_default_str());
    keep(app.add_option("--release", r.press.release_s, "seconds for the way back")
             ->type_name("S")
             ->capture_default_str());
    keep(app.add_flag("--hand", r.simulated_hand,
                      "a simulated hand wants this press and holds the device: mass, friction, encoders and "
                      "force limit are the device's"));
    keep(app.add_option("--device", o.device, "whose limits hold: see --list-devices")
             ->type_name("NAME")
             ->capture_default_str());
    o.tool_option = app.add_option("--tool", r.tool, "tool of the asset, by index or name")
                        ->type_name("TOOL")
                        ->capture_default_str()
                        ->group(group);
    o.direction_option =
        app.add_option("--direction", o.direction,
                       "x y z of the press in the scene [where a plate looks, else to the object]")
            ->type_name("NUMBER")
            ->expected(3)
            ->group(group);
}

void declare_loop(CLI::App& app, TouchOptions& o) {
    const char* const group = "Haptic loop";
    TouchRequest& r = o.request;
    const auto keep = [&](CLI::Option* option) {
        o.run_only.push_back(option->group(group));
        return option;
    };
    const auto keep_two_rate = [&](CLI::Option* option) { o.two_rate_only.push_back(keep(option)); };
    keep(app.add_option("--mode", o.mode, "a step each period, or steps on a thread of their own")
             ->type_name("MODE")
             ->check(CLI::IsMember({"synchronous", "two-rate"}))
             ->capture_default_str());
    keep(app.add_option("--rate", r.rate_hz, "periods per second, 500 to 4000")
             ->type_name("HZ")
             ->capture_default_str());
    keep_two_rate(
        app.add_option("--simulation-rate", r.simulation_rate_hz, "two-rate: steps per second, 50 to 4000")
            ->type_name("HZ")
            ->capture_default_str());
    keep_two_rate(app.add_option("--rendering", o.rendering, "two-rate: what is felt between two steps")
                      ->type_name("KIND")
                      ->check(CLI::IsMember({"reduced-object", "linear", "hold"}))
                      ->capture_default_str());
    keep(app.add_option("--coupling", r.coupling_n_per_m,
                        "stiffness between hand and tool [what the device renders]")
             ->type_name("N/m"));
    keep(app.add_option("--force-scale", r.force_scale, "device newtons per newton of the object")
             ->type_name("RATIO")
             ->capture_default_str());
    keep(app.add_option("--max-force", r.max_force_n, "largest force on the hand [the device's]")
             ->type_name("N"));
    keep(app.add_flag("--no-passivity", o.no_passivity, "the passivity controller only watches"));
    keep(app.add_option("--seconds", r.seconds, "how long to run [until the press is over]")->type_name("S"));
    auto* virtual_time = keep(app.add_flag("--virtual-time", r.virtual_time,
                                           "without a clock: as fast as it goes, the same bits each time"));
    keep(app.add_flag("--real-time", o.real_time, "by the clock, on threads of its own; the default")
             ->excludes(virtual_time));
}

void positive(const char* option, double value) {
    if (!(value > 0 && std::isfinite(value)))
        fail_usage(fmt::format("{}: {:g} is not a finite number greater than 0", option, value));
}
void not_negative(const char* option, double value) {
    if (!(value >= 0 && std::isfinite(value)))
        fail_usage(fmt::format("{}: {:g} is not a finite number of at least 0", option, value));
}
void between(const char* option, double value, double least, double most) {
    if (!(value >= least && value <= most))
        fail_usage(fmt::format("{}: {:g} is not between {:g} and {:g}", option, value, least, most));
}

double length(const char* option, const std::string& text) {
    double metres = 0;
    try {
        metres = parse_length_m(text);
    } catch (const ToolError& error) {
        fail_usage(fmt::format("{}: {}", option, error.what()));
    }
    if (!(metres > 0)) fail_usage(fmt::format("{}: \"{}\" is not greater than 0", option, text));
    return metres;
}

/// "50mm/s" or "50mm": lengths in a second.
double speed(const char* option, std::string text) {
    if (text.size() > 2 && text.ends_with("/s")) text.resize(text.size() - 2);
    return length(option, text);
}

Vec3 direction(const std::vector<double>& numbers) {
    const double length = std::hypot(numbers[0], numbers[1], numbers[2]);
    if (!(length > 0 && std::isfinite(length)))
        fail_usage("--direction: needs three finite numbers, not all of them 0");
    return {numbers[0], numbers[1], numbers[2]};
}

void refuse_given(const std::vector<CLI::Option*>& options, const std::string& with) {
    for (const CLI::Option* option : options)
        if (option->count() > 0) fail_usage(fmt::format("{} does not go with {}", option->get_name(), with));
}

void check_combination(const TouchOptions& o) {
    using Command = TouchOptions::Command;
    if (static_cast<int>(!o.replay.empty()) + static_cast<int>(!o.renderability.empty()) +
            static_cast<int>(o.list_devices) >
        1)
        fail_usage("only one of --replay, --renderability and --list-devices at a time");
    const Command command = o.command();
    if (command == Command::list_devices) {
        if (!o.asset.empty()) fail_usage("--list-devices needs no asset");
        refuse_given({o.tool_option, o.direction_option, o.json_option}, "--list-devices");
        refuse_given(o.run_only, "--list-devices");
        return;
    }
    if (o.asset.empty()) fail_usage("ASSET is required");
    if (command == Command::replay) {
        refuse_given({o.tool_option, o.direction_option, o.json_option}, "--replay");
        refuse_given(o.run_only, "--replay");
    }
    if (command == Command::renderability) refuse_given(o.run_only, "--renderability");
    if (command == Command::run && o.mode == "synchronous")
        refuse_given(o.two_rate_only, "--mode synchronous");
}

}  // namespace

TouchOptions::Command TouchOptions::command() const {
    if (list_devices) return Command::list_devices;
    if (!replay.empty()) return Command::replay;
    return renderability.empty() ? Command::run : Command::renderability;
}

void declare_options(CLI::App& app, TouchOptions& options) {
    app.add_option("ASSET", options.asset, "asset that knead-bake wrote");
    declare_press(app, options);
    declare_loop(app, options);
    const char* const output = "Output";
    options.run_only.push_back(
        app.add_option("--log", options.log, "write every input and output of the session")
            ->type_name("FILE")
            ->group(output));
    options.json_option =
        app.add_option("--json", options.json, "write the summary as JSON")->type_name("FILE")->group(output);
    const char* const instead = "Instead of a touch";
    app.add_option("--replay", options.replay, "run a log again; exit 1 unless every bit is the same")
        ->type_name("LOG")
        ->group(instead);
    app.add_option(
           "--renderability", options.renderability,
           "what this device can render of the asset: which depth saturates, which coupling is stable")
        ->type_name("DEVICE")
        ->group(instead);
    app.add_flag("--list-devices", options.list_devices, "print the devices that are known")->group(instead);
}

TouchRequest touch_request(const TouchOptions& options) {
    check_combination(options);
    TouchRequest request = options.request;
    if (!options.direction.empty()) request.direction = direction(options.direction);
    request.press.depth_m = length("--press", options.depth);
    request.press.speed_m_per_s = speed("--speed", options.speed);
    not_negative("--hold", request.press.hold_s);
    positive("--release", request.press.release_s);
    request.mode = options.mode == "two-rate" ? HapticMode::two_rate : HapticMode::synchronous;
    request.rendering = options.rendering == "hold"     ? LocalRendering::hold
                        : options.rendering == "linear" ? LocalRendering::linear
                                                        : LocalRendering::reduced_object;
    between("--rate", request.rate_hz, kSlowest_hz, kFastest_hz);
    between("--simulation-rate", request.simulation_rate_hz, kSlowestSimulation_hz, kFastest_hz);
    positive("--force-scale", request.force_scale);
    if (request.coupling_n_per_m) positive("--coupling", *request.coupling_n_per_m);
    if (request.max_force_n) positive("--max-force", *request.max_force_n);
    if (request.seconds) positive("--seconds", *request.seconds);
    request.passivity = !options.no_passivity;
    return request;
}

std::vector<std::string> canonical_arguments(const TouchSetup& setup) {
    const TouchRequest& r = setup.request;
    const auto number = [](double value) { return fmt::format("{}", value); };
    std::vector<std::string> arguments{
        "--press", number(r.press.depth_m), "--speed",   number(r.press.speed_m_per_s),
        "--hold",  number(r.press.hold_s),  "--release", number(r.press.release_s)};
    const auto add = [&](std::initializer_list<std::string> more) {
        arguments.insert(arguments.end(), more);
    };
    if (r.simulated_hand) add({"--hand"});
    add({"--device", setup.device_name, "--tool", std::to_string(setup.tool), "--direction"});
    for (const double component : setup.line.direction)
        add({number(component)});
    const bool two_rate = r.mode == HapticMode::two_rate;
    add({"--mode", two_rate ? "two-rate" : "synchronous", "--rate", number(r.rate_hz)});
    if (two_rate)
        add({"--simulation-rate", number(r.simulation_rate_hz), "--rendering",
             r.rendering == LocalRendering::hold     ? "hold"
             : r.rendering == LocalRendering::linear ? "linear"
                                                     : "reduced-object"});
    add({"--coupling", number(setup.haptic.coupling.stiffness_n_per_m), "--force-scale",
         number(r.force_scale), "--max-force", number(setup.haptic.safety.max_force_n)});
    if (!r.passivity) add({"--no-passivity"});
    add({"--seconds", number(setup.seconds), r.virtual_time ? "--virtual-time" : "--real-time"});
    return arguments;
}

}  // namespace knead::tools
