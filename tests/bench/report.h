// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/haptic_cycle.h"
#include "bench/hard_cases.h"
#include "bench/leave_out.h"
#include "bench/machine.h"
#include "bench/speed.h"

namespace knead::bench {

/// Everything that one run measured.
struct Report {
    Machine machine;
    double flops_per_s = 0;
    std::string command;
    std::vector<SpeedRow> steps;
    std::vector<HardCaseRow> hard_cases;
    std::vector<LeaveOutRow> leave_out;
    std::vector<HapticCycleRow> haptic_cycle;
};

/// The report as "knead-bench/1" (docs/benchmark.md). Numbers that are not finite become null.
[[nodiscard]] std::string to_json(const Report& report);

// Lines for a person; a heading first, then one line per row as it is measured.
[[nodiscard]] std::string machine_text(const Machine& machine, double flops_per_s);
[[nodiscard]] std::string speed_heading();
[[nodiscard]] std::string speed_line(const SpeedRow& row);
[[nodiscard]] std::string cost_heading();
[[nodiscard]] std::string cost_line(const SpeedRow& row);
[[nodiscard]] std::string hard_case_heading();
[[nodiscard]] std::string hard_case_line(const HardCaseRow& row);
[[nodiscard]] std::string leave_out_heading();
[[nodiscard]] std::string leave_out_line(const LeaveOutRow& row);
[[nodiscard]] std::string haptic_cycle_heading();
[[nodiscard]] std::string haptic_cycle_line(const HapticCycleRow& row);

}  // namespace knead::bench
