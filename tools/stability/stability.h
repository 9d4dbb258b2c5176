// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace knead::tools::stability {

/// How a check or a cell ended. Ordered by severity.
enum class CellStatus : std::uint8_t { pass, warn, fail };

/// Every kind of warning of the matrix; its cause and what to do are in advice_for() and docs/stability.md.
enum class Warning : std::uint8_t {
    none,
    not_converged,
    contact_cap,
    iterations,
    step_force,
    linearisation,
    force_at_rest,
    no_reference,
    locking,
    slivers,
    dt_out_of_range,
    spin_loss,
    hooked,
    inside_out,
};

/// One number of a cell against its bound.
struct Check {
    std::string name;  ///< "step_force", "passive", ...
    double value = 0;  ///< NaN: not judged, see note
    double bound = 0;  ///< of a pass
    std::string unit;  ///< "relative", "of the work", "m", "steps", ...
    CellStatus status = CellStatus::pass;
    Warning warning = Warning::none;  ///< with CellStatus::warn
    std::string note;
};

/// What was found for one cell.
struct CellResult {
    std::string name;  ///< "contrast/islands 1e6, nu 0.3, dt 1 ms": family and case
    std::string family;
    std::vector<Check> checks;  ///< the first is the one the cell is about
    std::uint64_t steps = 0;

    [[nodiscard]] CellStatus status() const;
    /// The check that decided the status: the first of the worst ones.
    [[nodiscard]] const Check& decisive() const;
    /// Of every warning, in the order of the checks, each once.
    [[nodiscard]] std::vector<Warning> warnings() const;
};

/// What is run.
struct StabilityRequest {
    std::string pattern;  ///< part of the names of the cells to run; empty: all
    std::uint64_t soak_steps = 100'000;
    bool shortened = false;  ///< as in CI: fewer compared steps, smaller meshes where it costs minutes
    unsigned threads = 1;
    std::function<void(std::size_t done, std::size_t total, std::string_view cell)> progress = {};
};

/// Names of all cells, in the order of the matrix.
[[nodiscard]] std::vector<std::string> stability_cells();

/// Runs the cells on the runtime and judges them. The result depends on the request (but for its threads) and
/// the machine type only. A cell whose run throws is a fail with the message as its reason.
[[nodiscard]] std::vector<CellResult> run_stability(const StabilityRequest& request);

/// "not_converged", ...
[[nodiscard]] const char* name_of(CellStatus status);
[[nodiscard]] const char* name_of(Warning warning);
/// Cause, and what the user should do.
struct Advice {
    const char* cause;
    const char* action;
};
[[nodiscard]] Advice advice_for(Warning warning);
/// All but none.
[[nodiscard]] const std::vector<Warning>& all_warnings();

}  // namespace knead::tools::stability
