// SPDX-License-Identifier: Apache-2.0
#include "touch/device_presets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "common/error.h"

namespace knead::tools::test {
namespace {

using ::testing::HasSubstr;

std::string shipped_text() {
    std::ifstream stream(KNEAD_DEVICES_FILE);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string message_of(const std::string& text) {
    try {
        (void)parse_device_presets(text, "my.toml");
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "";
}

/// A device without anything optional; `change` replaces one line, by its key.
std::string device_text(const std::string& key = "", const std::string& line = "") {
    const char* numbers[] = {"max_force_n",           "max_stiffness_n_per_m", "workspace_radius_m",
                             "position_resolution_m", "apparent_mass_kg",      "friction_n",
                             "damping_n_s_per_m"};
    std::ostringstream text;
    text << "[[device]]\n";
    text << (key == "name" ? line : "name = \"mine\"") << "\n";
    text << (key == "title" ? line : "title = \"My device\"") << "\n";
    for (const char* number : numbers)
        text << (key == number ? line : std::string(number) + " = {value = 2, source = \"a sheet\"}") << "\n";
    if (key == "more") text << line << "\n";
    return text.str();
}

// The design page's table, written out here once more.
TEST(Shipped_devices, Have_the_forces_and_stiffnesses_of_the_design) {
    struct Row {
        const char* name;
        double force_n, stiffness_n_per_m;
    };
    const Row rows[] = {{"touch", 3.3, 400},   {"omni", 3.3, 700},    {"phantom_desktop", 7.9, 1000},
                        {"falcon", 8, 3000},   {"omega.3", 12, 5000}, {"delta.3", 20, 5000},
                        {"sigma.7", 12, 4000}, {"inverse3", 10, 1000}};
    const std::vector<DevicePreset> presets = parse_device_presets(shipped_text(), "devices.toml");
    EXPECT_EQ(presets.size(), std::size(rows));
    for (const Row& row : rows) {
        const DevicePreset& preset = find_device(presets, row.name);
        EXPECT_EQ(preset.max_force_n.value, row.force_n) << row.name;
        EXPECT_EQ(preset.max_stiffness_n_per_m.value, row.stiffness_n_per_m) << row.name;
        EXPECT_EQ(preset.max_force_n.note, "CHAI3D application limit");
        EXPECT_EQ(preset.max_stiffness_n_per_m.note, "CHAI3D application limit");
        EXPECT_FALSE(preset.max_force_n.assumed());
    }
}

TEST(Shipped_devices, Make_an_operator_and_a_safety_chain_each) {
    for (const DevicePreset& preset : parse_device_presets(shipped_text(), "devices.toml")) {
        const auto made = SimulatedOperator::create(operator_on(preset));
        EXPECT_TRUE(made.ok()) << preset.name;
        EXPECT_EQ(made.value().config().max_force_n, preset.max_force_n.value);
        const auto chain = SafetyChain::create(safety_for(preset));
        EXPECT_TRUE(chain.ok()) << preset.name << ": " << (chain.ok() ? "" : chain.error().text());
        EXPECT_EQ(chain.value().config().max_force_n, preset.max_force_n.value);
    }
}

TEST(Devices_file, Is_beside_the_programs_folder) {
    EXPECT_EQ(devices_file_of("/opt/knead/bin/knead-touch"), "/opt/knead/share/knead/devices.toml");
}

TEST(Devices_file, With_something_wrong_is_refused_with_its_line) {
    EXPECT_EQ(message_of(device_text()), "");
    struct Case {
        const char *key, *line, *part;
    };
    const Case cases[] = {
        {"name", "", "name"},
        {"title", "title = 3", "my.toml:3"},
        {"max_force_n", "", "max_force_n"},
        {"max_force_n", "max_force_n = 3.3", "my.toml:4"},
        {"max_force_n", "max_force_n = {value = 3.3}", "source"},
        {"max_force_n", "max_force_n = {value = 3.3, source = \"\"}", "source"},
        {"max_force_n", "max_force_n = {source = \"a sheet\"}", "value"},
        {"max_force_n", "max_force_n = {value = 0, source = \"a sheet\"}", "must be > 0"},
        {"max_force_n", "max_force_n = {value = nan, source = \"a sheet\"}", "my.toml:4"},
        {"friction_n", "friction_n = {value = -1, source = \"a sheet\"}", "must be >= 0"},
        {"friction_n", "friction_n = {value = 1, source = \"a sheet\", unit = \"N\"}", "my.toml:9"},
        {"more", "max_forse_n = {value = 1, source = \"a sheet\"}", "did you mean"},
        {"more", "[[device]]\nname = \"mine\"", "title"},
        {"more", "= 3", "not valid TOML"},
    };
    for (const Case& bad : cases)
        EXPECT_THAT(message_of(device_text(bad.key, bad.line)), HasSubstr(bad.part)) << bad.line;
    EXPECT_THAT(message_of(device_text() + device_text()), HasSubstr("my.toml:12: device[1].name"));
    EXPECT_THAT(message_of(""), HasSubstr("no device"));
    EXPECT_THAT(message_of("colour = 1\n" + device_text()), HasSubstr("my.toml:1"));
}

TEST(Device_name, That_is_unknown_is_answered_with_the_nearest) {
    const std::vector<DevicePreset> presets = parse_device_presets(shipped_text(), "devices.toml");
    try {
        (void)find_device(presets, "omega3");
        FAIL();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_usage);
        EXPECT_THAT(error.what(), HasSubstr("did you mean \"omega.3\"?"));
        EXPECT_THAT(error.what(), HasSubstr("phantom_desktop"));
    }
}

}  // namespace
}  // namespace knead::tools::test
