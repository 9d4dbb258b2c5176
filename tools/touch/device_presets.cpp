// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/device_presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "scene/toml_table.h"

namespace knead::tools {
namespace {

constexpr double kRampSeconds = 1.0 / 3;  ///< from nothing to the whole force
constexpr double kSlewShare = 1.0 / 3;    ///< of the whole force in a millisecond
constexpr double kCountsOfNoise = 2;      ///< less motion than this may be the encoder's

/// The number stands in the table of the same name.
std::optional<SourcedNumber> read_number(TomlTable& device, const char* key, bool may_be_zero) {
    std::optional<TomlTable> table = device.table(key);
    if (!table) return std::nullopt;
    SourcedNumber number;
    const std::optional<double> value = table->number("value");
    const std::optional<std::string> source = table->text("source");
    if (!value) table->fail_missing("value");
    if (!source || source->empty() || *source == "assumed: ") table->fail_missing("source");
    if (!std::isfinite(*value) || *value < 0 || (*value == 0 && !may_be_zero))
        table->fail("value", may_be_zero ? "must be >= 0" : "must be > 0");
    number.value = *value;
    number.source = *source;
    number.note = table->text("note").value_or("");
    table->finish();
    return number;
}

SourcedNumber required_number(TomlTable& device, const char* key, bool may_be_zero = false) {
    const std::optional<SourcedNumber> number = read_number(device, key, may_be_zero);
    if (!number) device.fail_missing(key);
    return *number;
}

std::string required_text(TomlTable& table, const char* key) {
    const std::optional<std::string> text = table.text(key);
    if (!text || text->empty()) table.fail_missing(key);
    return *text;
}

DevicePreset read_device(TomlTable& table) {
    DevicePreset preset;
    preset.name = required_text(table, "name");
    preset.title = required_text(table, "title");
    preset.max_force_n = required_number(table, "max_force_n");
    preset.max_stiffness_n_per_m = required_number(table, "max_stiffness_n_per_m");
    preset.workspace_radius_m = required_number(table, "workspace_radius_m");
    preset.position_resolution_m = required_number(table, "position_resolution_m", true);
    preset.apparent_mass_kg = required_number(table, "apparent_mass_kg");
    preset.friction_n = required_number(table, "friction_n", true);
    preset.damping_n_s_per_m = required_number(table, "damping_n_s_per_m", true);
    preset.max_torque_nm = read_number(table, "max_torque_nm", false);
    preset.max_damping_n_s_per_m = read_number(table, "max_damping_n_s_per_m", false);
    table.finish();
    return preset;
}

std::vector<std::string> names_of(const std::vector<DevicePreset>& presets) {
    std::vector<std::string> names;
    for (const DevicePreset& preset : presets)
        names.push_back(preset.name);
    return names;
}

}  // namespace

std::vector<DevicePreset> parse_device_presets(std::string_view text, const std::string& file) {
    const toml::table parsed = parse_toml(text, file);
    TomlTable root(parsed, file, "");
    std::vector<DevicePreset> presets;
    for (TomlTable& table : root.tables("device")) {
        DevicePreset preset = read_device(table);
        const std::vector<std::string> names = names_of(presets);
        if (std::find(names.begin(), names.end(), preset.name) != names.end())
            table.fail("name", fmt::format("\"{}\" is the name of an earlier device", preset.name));
        presets.push_back(std::move(preset));
    }
    root.finish();
    if (presets.empty()) fail_input(file + ": no device");
    return presets;
}

const DevicePreset& find_device(const std::vector<DevicePreset>& presets, const std::string& name) {
    for (const DevicePreset& preset : presets)
        if (preset.name == name) return preset;
    const std::vector<std::string> names = names_of(presets);
    const std::string near = nearest_word(name, names);
    fail_usage(fmt::format("device \"{}\" is none of {}{}", name, fmt::join(names, ", "),
                           near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

std::filesystem::path devices_file_of(const std::filesystem::path& program) {
    return program.parent_path().parent_path() / "share" / "knead" / "devices.toml";
}

OperatorConfig operator_on(const DevicePreset& preset, OperatorConfig hand) {
    hand.device_mass_kg = preset.apparent_mass_kg.value;
    hand.device_damping_n_s_per_m = preset.damping_n_s_per_m.value;
    hand.coulomb_friction_n = preset.friction_n.value;
    hand.position_resolution_m = preset.position_resolution_m.value;
    hand.max_force_n = preset.max_force_n.value;
    hand.max_torque_nm = preset.max_torque_nm ? preset.max_torque_nm->value : 0;
    return hand;
}

SafetyConfig safety_for(const DevicePreset& preset, SafetyConfig base) {
    base.max_force_n = preset.max_force_n.value;
    base.slew_n_per_ms = kSlewShare * base.max_force_n;
    base.ramp_n_per_s = base.max_force_n / kRampSeconds;
    base.max_torque_nm = preset.max_torque_nm ? preset.max_torque_nm->value : 0;
    if (base.max_torque_nm > 0) {
        base.slew_nm_per_ms = kSlewShare * base.max_torque_nm;
        base.ramp_nm_per_s = base.max_torque_nm / kRampSeconds;
    }
    if (preset.position_resolution_m.value > 0)
        base.force_passivity.resolution = kCountsOfNoise * preset.position_resolution_m.value;
    return base;
}

}  // namespace knead::tools
