// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <bit>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <random>

#include "knead/formats/write/write.h"
#include "knead/haptics/simulated_operator.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

using ::testing::HasSubstr;

constexpr double kPeriod = 1e-3;
constexpr int kTicks = 900;

/// A file that goes away with the test.
class File {
  public:
    explicit File(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("knead-session-" + std::to_string(::getpid()) + "-" + name)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

Asset gel() {
    return cube_asset(4, ToolShape::sphere, ToolContact::frictionless);
}

HapticConfig config_of(HapticMode mode) {
    HapticConfig config;
    config.mode = mode;
    config.simulation_rate_hz = 120;
    config.workspace.offset_m = gel().tools[0].rest_position_m;
    config.coupling.stiffness_n_per_m = 350;
    return config;
}

Simulation simulation_of(const SimulationConfig& config) {
    auto made = Simulation::create(gel(), config);
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
}

SimulatedOperator pressing_hand() {
    OperatorConfig config;
    config.position_resolution_m = 20e-6;
    config.coulomb_friction_n = 0.05;
    config.jitter_periods = 0.3;
    config.path = press_path({{0, 0, 0.002}, {1, 0, 0, 0}}, {0.001, 0, -0.017}, 0.1, 0.3);
    auto made = SimulatedOperator::create(config);
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
}

/// Says something broken now and then.
class FaultyDevice final : public Device {
  public:
    explicit FaultyDevice(SimulatedOperator& hand) : hand_(hand) {}
    DeviceState read() noexcept override {
        DeviceState sample = hand_.read();
        sample.buttons = static_cast<std::uint32_t>(count_ % 3);
        if (++count_ == 500) sample.pose.position_m[1] = std::numeric_limits<double>::quiet_NaN();
        if (count_ == 600) sample.pose.position_m[2] += 1;
        return sample;
    }
    void write(const Vec3& force_n, const Vec3& torque_nm) noexcept override {
        hand_.write(force_n, torque_nm);
    }

  private:
    SimulatedOperator& hand_;
    int count_ = 0;
};

SessionRecorder recorder_of(const HapticConfig& haptic, const SimulationConfig& simulation,
                            SessionCapacity capacity = {kTicks, kTicks}) {
    auto made = SessionRecorder::create(haptic, simulation, std::string(64, 'c'), capacity);
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
}

/// A two-rate run whose steps start and arrive when chance says so: some late, some replaced before use.
SessionLog record_two_rate(SessionCapacity capacity = {kTicks, kTicks}) {
    const HapticConfig config = config_of(HapticMode::two_rate);
    const SimulationConfig physics = simulation_config(config);
    Simulation simulation = simulation_of(physics);
    SimulatedOperator hand = pressing_hand();
    FaultyDevice device(hand);
    auto loop = HapticLoop::create(device, simulation, config);
    EXPECT_TRUE(loop.ok());
    SessionRecorder recorder = recorder_of(config, physics, capacity);
    std::mt19937_64 random(7);
    std::deque<SimulationResult> on_the_way;
    for (int i = 0; i < kTicks; ++i) {
        for (auto arrivals = random() % 3; arrivals > 0 && !on_the_way.empty(); --arrivals) {
            loop.value().publish(on_the_way.front());
            on_the_way.pop_front();
        }
        const double late = random() % 50 == 0 ? 1.5 : 1;
        recorder.record(loop.value().tick(late * kPeriod));
        if (random() % 6 == 0) {
            on_the_way.push_back(loop.value().simulate(random() % 2 == 0 ? 1.0 / 120 : 1.0 / 200));
            recorder.record(on_the_way.back());
        }
    }
    return recorder.log();
}

SessionLog record_synchronous() {
    const HapticConfig config = config_of(HapticMode::synchronous);
    const SimulationConfig physics = simulation_config(config);
    Simulation simulation = simulation_of(physics);
    SimulatedOperator hand = pressing_hand();
    auto loop = HapticLoop::create(hand, simulation, config);
    EXPECT_TRUE(loop.ok());
    SessionRecorder recorder = recorder_of(config, physics);
    for (int i = 0; i < kTicks; ++i)
        recorder.record(loop.value().tick(kPeriod));
    return recorder.log();
}

ReplayReport replayed(const SessionLog& log) {
    const auto physics = simulation_config_of(log);
    EXPECT_TRUE(physics.ok()) << physics.error().text();
    Simulation simulation = simulation_of(physics.value());
    const auto report = replay(log, simulation);
    EXPECT_TRUE(report.ok()) << report.error().text();
    return report.ok() ? report.value() : ReplayReport{};
}

SessionLog written_and_read(const SessionLog& log) {
    const File file("log.hdf");
    const Status written = write_session_log(file.path(), log, {"knead-test", "0.1.0", {}, 0, {}});
    EXPECT_TRUE(written.ok()) << written.error().text();
    auto read = read_session_log(file.path());
    EXPECT_TRUE(read.ok()) << read.error().text();
    return std::move(read).value();
}

TEST(Session, Of_two_rates_with_chance_in_its_timing_is_replayed_bit_by_bit) {
    const SessionLog log = record_two_rate();
    ASSERT_EQ(log.ticks.number.size(), static_cast<std::size_t>(kTicks));
    ASSERT_GT(log.steps.number.size(), 100U);
    std::uint32_t status = 0, touched = 0;
    for (std::size_t i = 0; i < log.ticks.number.size(); ++i) {
        status |= log.ticks.status[i];
        touched = std::max(touched, log.ticks.touched_nodes[i]);
    }
    EXPECT_GT(touched, 0U) << "the run was in contact";
    EXPECT_NE(status & kHapticBadPose, 0U) << "and had its faults";
    EXPECT_NE(status & kHapticPoseJump, 0U);
    const ReplayReport report = replayed(written_and_read(log));
    EXPECT_TRUE(report.same) << report.first_difference;
    EXPECT_EQ(report.ticks, static_cast<std::uint64_t>(kTicks));
    EXPECT_EQ(report.steps, log.steps.number.size());
}

TEST(Session, Of_one_rate_is_replayed_bit_by_bit) {
    const SessionLog log = record_synchronous();
    EXPECT_TRUE(log.steps.number.empty());
    const ReplayReport report = replayed(written_and_read(log));
    EXPECT_TRUE(report.same) << report.first_difference;
    EXPECT_EQ(report.ticks, static_cast<std::uint64_t>(kTicks));
    EXPECT_EQ(report.steps, 0U);
}

void flip_last_bit(double& value) {
    value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1U);
}

TEST(Replay, Notices_one_flipped_bit_wherever_it_is) {
    const SessionLog log = record_two_rate();
    {
        SessionLog bent =
            log;  // an input: what follows differs. Its last bits drown in the workspace's offset.
        double& z = bent.ticks.device_position_m[450][2];
        z = std::bit_cast<double>(std::bit_cast<std::uint64_t>(z) ^ (1U << 8U));
        const ReplayReport report = replayed(bent);
        EXPECT_FALSE(report.same);
        EXPECT_GE(report.ticks, 451U);
    }
    {
        SessionLog bent = log;  // an output: the very place
        flip_last_bit(bent.ticks.force_n[700][2]);
        const ReplayReport report = replayed(bent);
        EXPECT_FALSE(report.same);
        EXPECT_EQ(report.ticks, 701U);
        EXPECT_THAT(report.first_difference, HasSubstr("tick 701: force_n[2] is "));
        EXPECT_THAT(report.first_difference, HasSubstr("recorded "));
    }
    {
        SessionLog bent = log;
        flip_last_bit(bent.steps.force_n[40][0]);
        const ReplayReport report = replayed(bent);
        EXPECT_FALSE(report.same);
        EXPECT_THAT(report.first_difference, HasSubstr("step 41: force_n[0] is "));
    }
    {
        SessionLog bent = log;  // a number of the configuration
        for (SessionLog::Setting& setting : bent.settings)
            if (setting.name == "haptic.coupling.stiffness_n_per_m") flip_last_bit(setting.value);
        EXPECT_FALSE(replayed(bent).same);
    }
}

TEST(Replay, Of_a_log_that_lacks_its_start_is_refused) {
    SessionLog log = record_synchronous();
    for (std::uint64_t& number : log.ticks.number)
        ++number;
    Simulation simulation = simulation_of(simulation_config_of(log).value());
    const auto report = replay(log, simulation);
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.error().code, ErrorCode::invalid_data);
}

TEST(Settings_of_a_session, Give_back_both_configurations) {
    HapticConfig haptic = config_of(HapticMode::two_rate);
    haptic.rendering = LocalRendering::linear;
    haptic.safety.passivity = false;
    haptic.safety.torque_passivity.travel = 0.0625;
    haptic.workspace.rotation_wxyz = {0.6, 0, 0.8, 0};
    SimulationConfig physics = simulation_config(haptic);
    physics.tools = {2};
    physics.arithmetic = Arithmetic::float64;
    physics.max_contact_passes = 17;
    physics.max_linearisations = 3;
    auto recorder = SessionRecorder::create(haptic, physics, std::string(64, '0'), {1, 0});
    ASSERT_TRUE(recorder.ok());
    const SessionLog log = recorder.value().log();
    ASSERT_TRUE(validate(log).ok());
    const auto found = haptic_config_of(log);
    ASSERT_TRUE(found.ok()) << found.error().text();
    EXPECT_EQ(found.value().mode, HapticMode::two_rate);
    EXPECT_EQ(found.value().rendering, LocalRendering::linear);
    EXPECT_FALSE(found.value().safety.passivity);
    EXPECT_EQ(found.value().safety.torque_passivity.travel, 0.0625);
    EXPECT_EQ(found.value().workspace.rotation_wxyz, haptic.workspace.rotation_wxyz);
    EXPECT_EQ(found.value().coupling.stiffness_n_per_m, 350);
    const auto found_physics = simulation_config_of(log);
    ASSERT_TRUE(found_physics.ok()) << found_physics.error().text();
    EXPECT_EQ(found_physics.value().tools, std::vector<std::size_t>{2});
    EXPECT_EQ(found_physics.value().arithmetic, Arithmetic::float64);
    EXPECT_EQ(found_physics.value().max_contact_passes, 17);
    EXPECT_EQ(found_physics.value().max_linearisations, 3);
    EXPECT_EQ(found_physics.value().expected_dt_s, physics.expected_dt_s);
}

TEST(Settings_of_a_session, Missing_unknown_or_out_of_range_are_refused_by_name) {
    const SessionLog log = recorder_of({}, {}, {1, 0}).log();
    const auto message = [&](auto change) {
        SessionLog bent = log;
        change(bent.settings);
        const auto config = haptic_config_of(bent);
        EXPECT_FALSE(config.ok());
        return config.ok() ? std::string() : config.error().text();
    };
    const auto index = [&](const std::string& name) {
        for (std::size_t i = 0; i < log.settings.size(); ++i)
            if (log.settings[i].name == name) return static_cast<std::ptrdiff_t>(i);
        ADD_FAILURE() << name;
        return std::ptrdiff_t{0};
    };
    EXPECT_THAT(message([&](auto& s) { s.erase(s.begin() + index("haptic.rate_hz")); }),
                HasSubstr("haptic.rate_hz is missing"));
    EXPECT_THAT(message([](auto& s) { s.push_back({"haptic.zeal", 1}); }), HasSubstr("haptic.zeal"));
    EXPECT_THAT(message([&](auto& s) { s[index("haptic.mode")].value = 2; }), HasSubstr("haptic.mode is 2"));
    EXPECT_THAT(message([&](auto& s) { s[index("haptic.safety.passivity")].value = 0.5; }),
                HasSubstr("haptic.safety.passivity"));
}

TEST(Session_recorder, That_is_full_keeps_what_can_be_replayed_and_counts_the_rest) {
    const SessionLog log = record_two_rate({kTicks, 30});
    EXPECT_EQ(log.steps.number.size(), 30U);
    EXPECT_LT(log.ticks.number.size(), static_cast<std::size_t>(kTicks));
    EXPECT_EQ(log.ticks.number.size() + log.lost_ticks, static_cast<std::size_t>(kTicks));
    EXPECT_GT(log.lost_steps, 0U);
    const ReplayReport report = replayed(log);
    EXPECT_TRUE(report.same) << report.first_difference;
    const SessionLog few = record_two_rate({100, kTicks});
    EXPECT_EQ(few.ticks.number.size(), 100U);
    EXPECT_TRUE(replayed(few).same);
}

TEST(Session_recorder, Refuses_what_is_no_hash_and_more_than_one_tool) {
    EXPECT_FALSE(SessionRecorder::create({}, {}, "abc").ok());
    SimulationConfig two;
    two.tools = {0, 1};
    EXPECT_FALSE(SessionRecorder::create({}, two, std::string(64, 'a')).ok());
}

}  // namespace
}  // namespace knead::test
