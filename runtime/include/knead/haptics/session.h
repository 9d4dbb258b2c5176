// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "knead/formats/result.h"
#include "knead/formats/session_log.h"
#include "knead/haptics/export.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/runtime/config.h"
#include "knead/runtime/simulation.h"

namespace knead {

/// How much a recorder sets aside.
struct SessionCapacity {
    std::size_t ticks = 600'000;  ///< ten minutes at 1 kHz; about 250 bytes each
    std::size_t steps = 0;        ///< of the simulation, two-rate sessions only; about 90 bytes each
};

/// Records a session: every input and output of the haptic loop and of the simulation beside it.
///
/// All memory is taken in create(). The two record() may be called from two threads at the same time, one
/// each; they never allocate, lock or throw. What comes when the memory is full is counted and lost.
class KNEAD_HAPTICS_API SessionRecorder {
  public:
    /// @param asset_content_hash of the asset that the simulation was made from (read_header())
    /// @return the recorder, or invalid_argument: a hash that is none; or out_of_memory
    static Result<SessionRecorder> create(const HapticConfig& haptic, const SimulationConfig& simulation,
                                          std::string asset_content_hash,
                                          const SessionCapacity& capacity = {});

    void record(const HapticTick& tick) noexcept;
    /// Two-rate sessions only.
    void record(const SimulationResult& result) noexcept;

    [[nodiscard]] std::size_t tick_count() const noexcept { return tick_count_; }
    [[nodiscard]] std::size_t step_count() const noexcept { return step_count_; }

    /// What was recorded, as write_session_log() takes it. Not while a thread records. Ends before the first
    /// tick whose step was lost, so that a log can always be replayed to its end.
    [[nodiscard]] SessionLog log() const;

  private:
    SessionRecorder() = default;
    SessionLog log_;  ///< arrays as long as the capacity
    std::size_t tick_count_ = 0, step_count_ = 0;
};

/// The configurations of a recorded session.
/// @return the configuration, or invalid_data: a number is missing, unknown or out of its type's range
KNEAD_HAPTICS_API Result<HapticConfig> haptic_config_of(const SessionLog& log);
KNEAD_HAPTICS_API Result<SimulationConfig> simulation_config_of(const SessionLog& log);

/// What a replay found.
struct ReplayReport {
    std::uint64_t ticks = 0;  ///< compared, the differing one included
    std::uint64_t steps = 0;
    bool same = true;
    /// "tick 1204: force_n[2] is 1.25 (0x3ff4000000000000), recorded 1.5 (0x3ff8000000000000)"; empty: the
    /// same
    std::string first_difference;
};

/// Runs a recorded session again in virtual time, in the recorded order, and compares every output bit by
/// bit; stops at the first difference.
/// @param simulation made from the same asset with simulation_config_of(log), not stepped yet
/// @return the report, or any error of haptic_config_of() or HapticLoop::create(), or invalid_data
KNEAD_HAPTICS_API Result<ReplayReport> replay(const SessionLog& log, Simulation& simulation);

}  // namespace knead
