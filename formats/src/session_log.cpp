// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/session_log.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "failure.h"
#include "offenders.h"
#include "session_parts.h"

namespace knead {
namespace {

constexpr std::size_t kLongestName = 128;

void check_lengths(const SessionLog& log) {
    const auto check = [](const std::string& group, std::size_t rows, const char* what) {
        return [=](const char* name, const auto& array, const char*) {
            if (array.size() != rows)
                fail(ErrorCode::invalid_data,
                     std::to_string(array.size()) + " entries for " + std::to_string(rows) + " " + what,
                     group + "/" + name);
        };
    };
    for_each_array(log.ticks, check(kTicks, log.ticks.number.size(), "ticks"));
    for_each_array(log.steps, check(kSteps, log.steps.number.size(), "steps"));
}

bool is_setting_name(const std::string& name) {
    return !name.empty() && name.size() <= kLongestName &&
           std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
}

void check_settings(const SessionLog& log) {
    Offenders names, order, values;
    for (std::size_t i = 0; i < log.settings.size(); ++i) {
        if (!is_setting_name(log.settings[i].name)) names.add(i);
        if (i > 0 && log.settings[i].name <= log.settings[i - 1].name) order.add(i);
        if (!std::isfinite(log.settings[i].value)) values.add(i);
    }
    const std::size_t count = log.settings.size();
    if (names.any())
        fail(
            ErrorCode::invalid_data,
            names.text(count, "names are not 1 to 128 printable ASCII characters without blanks", "settings"),
            kSettings + "/names");
    if (order.any())
        fail(ErrorCode::invalid_data, order.text(count, "names are not in increasing order", "settings"),
             kSettings + "/names");
    if (values.any())
        fail(ErrorCode::invalid_data, values.text(count, "values are not finite", "settings"),
             kSettings + "/values");
}

/// Numbers start at 1 and strictly increase.
void check_numbers(const std::vector<std::uint64_t>& number, const std::string& group, const char* ids) {
    Offenders bad;
    for (std::size_t i = 0; i < number.size(); ++i)
        if (number[i] <= (i == 0 ? 0 : number[i - 1])) bad.add(i);
    if (bad.any())
        fail(ErrorCode::invalid_data, bad.text(number.size(), "numbers do not increase from 1 on", ids),
             group + "/number");
}

/// Each entry is 0 or one of `numbers`, and none is smaller than the one before.
void check_references(const std::vector<std::uint64_t>& references, const std::vector<std::uint64_t>& numbers,
                      const std::string& where, const char* what, const char* ids) {
    Offenders unknown, back;
    for (std::size_t i = 0; i < references.size(); ++i) {
        if (references[i] != 0 && !std::binary_search(numbers.begin(), numbers.end(), references[i]))
            unknown.add(i);
        if (i > 0 && references[i] < references[i - 1]) back.add(i);
    }
    if (unknown.any())
        fail(ErrorCode::invalid_data,
             unknown.text(references.size(), std::string("name no recorded ") + what, ids), where);
    if (back.any())
        fail(ErrorCode::invalid_data,
             back.text(references.size(), std::string("go back to an earlier ") + what, ids), where);
}

/// What a step used happened before what used the step.
void check_order(const SessionLog& log) {
    Offenders bad;
    std::size_t step = 0;
    for (std::size_t i = 0; i < log.ticks.number.size(); ++i) {
        const std::uint64_t used = log.ticks.used_step[i];
        while (step < log.steps.number.size() && log.steps.number[step] < used)
            ++step;
        if (used != 0 && log.steps.hand_tick[step] >= log.ticks.number[i]) bad.add(i);
    }
    if (bad.any())
        fail(ErrorCode::invalid_data,
             bad.text(log.ticks.number.size(), "use a step that used a tick not before them", "ticks"),
             kTicks + "/used_step");
}

void check_written(const std::vector<SessionLog::Triple>& rows, const std::string& where) {
    Offenders bad;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const double component : rows[i])
            if (!std::isfinite(component)) {
                bad.add(i);
                break;
            }
    if (bad.any())
        fail(ErrorCode::invalid_data, bad.text(rows.size(), "rows are not finite", "ticks"), where);
}

}  // namespace

Status validate(const SessionLog& log) {
    return guarded(kSession, [&] {
        const std::string& hash = log.asset_content_hash;
        if (hash.size() != 64 || hash.find_first_not_of("0123456789abcdef") != std::string::npos)
            fail(ErrorCode::invalid_data, "is not a SHA-256 in lowercase hexadecimal digits",
                 kSession + "@asset_content_hash");
        check_lengths(log);
        check_settings(log);
        check_numbers(log.ticks.number, kTicks, "ticks");
        check_numbers(log.steps.number, kSteps, "steps");
        check_references(log.ticks.used_step, log.steps.number, kTicks + "/used_step", "step", "ticks");
        check_references(log.steps.hand_tick, log.ticks.number, kSteps + "/hand_tick", "tick", "steps");
        check_order(log);
        check_written(log.ticks.force_n, kTicks + "/force_n");
        check_written(log.ticks.torque_nm, kTicks + "/torque_nm");
        return Unit{};
    });
}

}  // namespace knead
