// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "touch/asset_json.h"
#include "touch/renderability.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3, kMillijoules = 1e3;

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

std::string force_table(const PressCurve& curve) {
    std::string text = "  tool at    force        static stiffness\n";
    if (const auto contact = curve.contact())
        text += fmt::format("  {:5.2f} mm   {:7.3f} N   {:8.0f} N/m   first touch\n",
                            kMillimetres * contact->depth_m, contact->force_n, contact->stiffness_n_per_m);
    for (const double depth_m : kToldDepths_m) {
        if (const auto point = curve.at(depth_m))
            text += fmt::format("  {:5.2f} mm   {:7.3f} N   {:8.0f} N/m\n", kMillimetres * depth_m,
                                point->force_n, point->stiffness_n_per_m);
        else
            text += fmt::format("  {:5.2f} mm   not tried: deeper than {:.2f} mm\n", kMillimetres * depth_m,
                                kMillimetres * curve.deepest_m());
    }
    return text;
}

std::string saturation_text(const DevicePreset& preset, const Renderability& found) {
    const double limit_n = preset.max_force_n.value;
    if (!found.saturation_depth_m)
        return fmt::format("  The device's {:g} N are not reached within {:.2f} mm.\n", limit_n,
                           kMillimetres * found.curve.deepest_m());
    return fmt::format(
        "  The device's {:g} N are reached with the tool at {:.2f} mm; the hand is then at {:.2f} mm,\n"
        "  through a coupling of the {:g} N/m that the device renders.\n"
        "  A force scale of {:.3f} brings {:.2f} mm within its force.\n",
        limit_n, kMillimetres * *found.saturation_depth_m, kMillimetres * *found.saturation_hand_depth_m,
        preset.max_stiffness_n_per_m.value, found.force_scale, kMillimetres * found.curve.deepest_m());
}

std::string rate_name(const RenderableRate& rate) {
    if (rate.mode == HapticMode::synchronous) return fmt::format("synchronous, {:g} Hz", rate.rate_hz);
    return fmt::format("two-rate, {:g} and {:g} Hz", rate.rate_hz, rate.simulation_rate_hz);
}

/// What stiffer couplings do.
std::string beyond(const ZWidth& width) {
    if (width.at_most) return "the stiffest tried";
    if (!width.bad.stable)
        return fmt::format("beyond: swings by {:.2f} mm", kMillimetres * width.bad.oscillation_m);
    return fmt::format("beyond: gives {:.2f} mJ to the hand", kMillijoules * width.bad.given_j);
}

std::string rate_table(const DevicePreset& preset, const std::vector<RenderableRate>& rates) {
    std::string text = "  stiffest coupling that is stable and passive in a simulated hand:\n";
    for (const RenderableRate& rate : rates)
        text += fmt::format("  {:<28} {:6.0f} N/m   {}\n", rate_name(rate), rate.width.stiffness_n_per_m,
                            beyond(rate.width));
    return text + fmt::format("  (the device renders {:g} N/m)\n", preset.max_stiffness_n_per_m.value);
}

Json json_of(const PressPoint& point) {
    return {{"depth_m", point.depth_m},
            {"force_n", point.force_n},
            {"stiffness_n_per_m", point.stiffness_n_per_m},
            {"touched_nodes", point.touched_nodes}};
}

Json json_of(const ZWidthProbe& probe) {
    return {{"stable", probe.stable},
            {"passive", probe.passive},
            {"oscillation_m", probe.oscillation_m},
            {"given_j", probe.given_j},
            {"force_n", probe.force_n}};
}

Json json_of(const RenderableRate& rate) {
    const bool synchronous = rate.mode == HapticMode::synchronous;
    const ZWidth& width = rate.width;
    Json json;
    json["mode"] = synchronous ? "synchronous" : "two-rate";
    json["rate_hz"] = rate.rate_hz;
    if (!synchronous) json["simulation_rate_hz"] = rate.simulation_rate_hz;
    json["stiffness_n_per_m"] = width.stiffness_n_per_m;
    json["stiffest_tried_is_good"] = width.at_most;
    json["probes"] = width.probes;
    json["at_it"] = width.stiffness_n_per_m > 0 ? json_of(width.good) : Json(nullptr);
    json["beyond"] = width.at_most ? Json(nullptr) : json_of(width.bad);
    return json;
}

}  // namespace

std::string renderability_text(const Asset& asset, std::size_t tool, const DevicePreset& preset,
                               const Renderability& found) {
    return fmt::format("{} {}, tool {}, on {} ({:g} N, {:g} N/m)\n", asset.name, asset.level,
                       asset.tools[tool].name, preset.title, preset.max_force_n.value,
                       preset.max_stiffness_n_per_m.value) +
           force_table(found.curve) + saturation_text(preset, found) + rate_table(preset, found.rates);
}

std::string renderability_json(const Asset& asset, const std::string& asset_content_hash, std::size_t tool,
                               const DevicePreset& preset, const Renderability& found) {
    Json json;
    json["schema"] = "knead-touch-renderability/1";
    json["asset"] = asset_json(asset, asset_content_hash, tool);
    json["device"] = {{"name", preset.name},
                      {"title", preset.title},
                      {"max_force_n", preset.max_force_n.value},
                      {"max_stiffness_n_per_m", preset.max_stiffness_n_per_m.value}};
    json["saturation"] = {{"tool_depth_m", or_null(found.saturation_depth_m)},
                          {"hand_depth_m", or_null(found.saturation_hand_depth_m)},
                          {"deepest_tried_m", found.curve.deepest_m()},
                          {"force_scale", found.force_scale}};
    const auto contact = found.curve.contact();
    json["contact"] = contact ? json_of(*contact) : Json(nullptr);
    Json& depths = json["depths"] = Json::array();
    for (const double depth_m : kToldDepths_m)
        if (const auto point = found.curve.at(depth_m)) depths.push_back(json_of(*point));
    Json& curve = json["curve"] = Json::array();
    for (const PressPoint& point : found.curve.points)
        curve.push_back(json_of(point));
    Json& rates = json["coupling"] = Json::array();
    for (const RenderableRate& rate : found.rates)
        rates.push_back(json_of(rate));
    return json.dump(2) + "\n";
}

}  // namespace knead::tools
