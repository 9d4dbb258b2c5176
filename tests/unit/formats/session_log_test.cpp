// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/session_log.h"

#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <limits>

#include "knead/formats/compare.h"
#include "knead/formats/inspect.h"
#include "samples.h"
#include "session_sample.h"

namespace knead::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Session_file, Gives_back_every_bit_also_of_what_is_no_number) {
    const Folder folder;
    const auto file = folder / "run.session.hdf", again = folder / "again.hdf";
    SessionLog log = sample_session();
    log.ticks.device_position_m[2] = {kNan, -0.0, std::numeric_limits<double>::infinity()};
    log.steps.force_n[1][0] = std::numeric_limits<double>::denorm_min();
    ASSERT_TRUE(write_session_log(file, log, sample_provenance()).ok());
    ASSERT_TRUE(write_session_log(again, log, sample_provenance()).ok());
    EXPECT_EQ(bytes_of(file), bytes_of(again));
    const auto read = read_session_log(file);
    ASSERT_TRUE(read.ok()) << read.error().text();
    EXPECT_TRUE(same(read.value(), log));
    log.ticks.device_position_m[2][1] = 0.0;
    EXPECT_FALSE(same(read.value(), log)) << "also the sign of a zero";
}

TEST(Session_file, Of_a_session_without_steps_or_ticks_is_read_too) {
    const Folder folder;
    const auto file = folder / "empty.hdf";
    SessionLog log = sample_session();
    log.steps = {};
    log.ticks = {};
    ASSERT_TRUE(write_session_log(file, log, {}).ok());
    const auto read = read_session_log(file);
    ASSERT_TRUE(read.ok()) << read.error().text();
    EXPECT_TRUE(read.value().ticks.number.empty());
    EXPECT_TRUE(read.value().steps.number.empty());
    log.settings.clear();
    ASSERT_TRUE(write_session_log(file, log, {}).ok());
    EXPECT_TRUE(read_session_log(file).ok());
}

TEST(Session_file, Is_known_to_inspect_validate_and_compare) {
    const Folder folder;
    const auto a = folder / "a.hdf", b = folder / "b.hdf", mesh = folder / "mesh.hdf";
    SessionLog log = sample_session();
    log.ticks.device_position_m[0][0] = kNan;
    ASSERT_TRUE(write_session_log(a, log, {}).ok());
    log.ticks.force_n[1][2] += 0.25;
    ASSERT_TRUE(write_session_log(b, log, {}).ok());
    ASSERT_TRUE(write_tet_mesh(mesh, sample_mesh(), {}).ok());
    EXPECT_EQ(validate_file(a).value(), FileKind::session);
    EXPECT_STREQ(to_string(FileKind::session), "session");
    const auto info = inspect_file(a);
    ASSERT_TRUE(info.ok());
    EXPECT_EQ(info.value().header.kind, FileKind::session);
    EXPECT_TRUE(compare_files(a, a).value().empty()) << "a NaN is the same NaN";
    const auto differences = compare_files(a, b).value();
    ASSERT_EQ(differences.size(), 1U);
    EXPECT_EQ(differences[0].path, "/knead/session/ticks/force_n");
    EXPECT_EQ(differences[0].count, 1U);
    EXPECT_EQ(read_session_log(mesh).error().code, ErrorCode::wrong_kind);
    EXPECT_EQ(read_asset(a).error().code, ErrorCode::wrong_kind);
}

TEST(Session_file, With_more_ticks_than_the_limit_gives_too_large) {
    const Folder folder;
    const auto file = folder / "a.hdf";
    ASSERT_TRUE(write_session_log(file, sample_session(), {}).ok());
    ReadLimits limits;
    limits.max_nodes = 2;
    EXPECT_EQ(read_session_log(file, limits).error().code, ErrorCode::too_large);
}

template <class Change>
void expect_refused(Change change, const std::string& part, const char* what) {
    SessionLog log = sample_session();
    change(log);
    const Status status = validate(log);
    ASSERT_FALSE(status.ok()) << what;
    EXPECT_EQ(status.error().code, ErrorCode::invalid_data) << what;
    EXPECT_NE(status.error().text().find(part), std::string::npos) << what << ": " << status.error().text();
}

TEST(Validation_of_a_session, Refuses_each_broken_invariant_with_its_place) {
    struct Break {
        const char* what;
        std::function<void(SessionLog&)> change;
        const char* part;
    };
    const Break breaks[] = {
        {"hash", [](auto& l) { l.asset_content_hash = "abc"; }, "@asset_content_hash"},
        {"upper", [](auto& l) { l.asset_content_hash[5] = 'A'; }, "@asset_content_hash"},
        {"length", [](auto& l) { l.ticks.dt_s.pop_back(); }, "ticks/dt_s: 4 entries for 5 ticks"},
        {"rows", [](auto& l) { l.ticks.force_n.pop_back(); }, "ticks/force_n: 4 entries for 5 ticks"},
        {"steps", [](auto& l) { l.steps.status.pop_back(); }, "steps/status: 1 entries for 2 steps"},
        {"name", [](auto& l) { l.settings[1].name = "a b"; }, "settings/names: 1 of 2"},
        {"no name", [](auto& l) { l.settings[0].name = ""; }, "settings/names: 1 of 2"},
        {"order", [](auto& l) { std::swap(l.settings[0], l.settings[1]); }, "not in increasing order"},
        {"value", [](auto& l) { l.settings[1].value = kNan; }, "settings/values: 1 of 2"},
        {"zero", [](auto& l) { l.ticks.number[0] = 0; }, "ticks/number: 1 of 5 numbers do not increase"},
        {"twice", [](auto& l) { l.ticks.number[3] = 3; }, "(ticks 3)"},
        {"step twice", [](auto& l) { l.steps.number[1] = 1; }, "steps/number"},
        {"no such step", [](auto& l) { l.ticks.used_step[4] = 9; }, "name no recorded step (ticks 4)"},
        {"back", [](auto& l) { l.ticks.used_step[4] = 0; }, "go back to an earlier step (ticks 4)"},
        {"no such tick", [](auto& l) { l.steps.hand_tick[1] = 9; }, "name no recorded tick (steps 1)"},
        {"hand back", [](auto& l) { l.steps.hand_tick[1] = 0; }, "go back to an earlier tick (steps 1)"},
        {"before it was",
         [](auto& l) {
             l.ticks.used_step = {0, 0, 2, 2, 2};
         },
         "used a tick not before them (ticks 2)"},
        {"force", [](auto& l) { l.ticks.force_n[2][1] = kNan; }, "ticks/force_n: 1 of 5 rows are not finite"},
        {"torque", [](auto& l) { l.ticks.torque_nm[4][0] = HUGE_VAL; }, "ticks/torque_nm: 1 of 5"},
    };
    EXPECT_TRUE(validate(sample_session()).ok());
    for (const auto& [what, change, part] : breaks)
        expect_refused(change, part, what);
}

TEST(Validation_of_a_session, Takes_whatever_a_device_or_a_simulation_said) {
    SessionLog log = sample_session();
    log.ticks.device_position_m[1] = {kNan, HUGE_VAL, 0};
    log.ticks.dt_s[1] = kNan;
    log.ticks.device_time_s[1] = -HUGE_VAL;
    log.ticks.scene_force_n[1][0] = kNan;
    log.steps.force_n[0][2] = kNan;
    EXPECT_TRUE(validate(log).ok());
}

}  // namespace
}  // namespace knead::test
