// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/device_list.h"

#include <fmt/format.h>

namespace knead::tools {
namespace {

std::string cell(const SourcedNumber& number, double unit) {
    return fmt::format("{}{:.4g}", number.assumed() ? "~" : "", number.value / unit);
}

}  // namespace

std::string device_list_text(const std::vector<DevicePreset>& presets) {
    constexpr double kMillimetre = 1e-3, kMicrometre = 1e-6, kGram = 1e-3;
    constexpr const char* kRow = "{:<16} {:>5} {:>6} {:>9} {:>8} {:>6} {:>10}  {}\n";
    std::string text =
        fmt::format(kRow, "name", "N", "N/m", "radius/mm", "count/um", "mass/g", "friction/N", "device");
    for (const DevicePreset& p : presets)
        text +=
            fmt::format(kRow, p.name, cell(p.max_force_n, 1), cell(p.max_stiffness_n_per_m, 1),
                        cell(p.workspace_radius_m, kMillimetre), cell(p.position_resolution_m, kMicrometre),
                        cell(p.apparent_mass_kg, kGram), cell(p.friction_n, 1), p.title);
    return text + "~ assumed; the sources are in share/knead/devices.toml\n";
}

}  // namespace knead::tools
