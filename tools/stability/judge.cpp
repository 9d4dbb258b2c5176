// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability/criteria.h"

namespace knead::tools::stability {
namespace {

constexpr double kNotJudged = std::numeric_limits<double>::quiet_NaN();

Check not_judged(const std::string& name, double bound, const std::string& unit, const std::string& note) {
    return {name, kNotJudged, bound, unit, CellStatus::pass, Warning::none, note};
}

/// Largest relative error of the samples that said nothing, and of those that did.
struct Errors {
    double when_ok = 0, when_told = 0;
};
Errors errors_of(const std::vector<ForceSample>& samples, double largest_n) {
    Errors errors;
    for (const ForceSample& sample : samples) {
        const double scale = std::max(sample.reference_n, criteria::kSmallestForceShare * largest_n);
        if (!(sample.difference_n > 0)) continue;
        const double error = sample.difference_n / scale;
        double& worst = sample.told ? errors.when_told : errors.when_ok;
        worst = std::max(worst, std::isfinite(error) ? error : HUGE_VAL);
    }
    return errors;
}

double largest_reference_n(const Record& record) {
    double largest = 0;
    for (const auto* samples : {&record.against_linearised, &record.against_converged})
        for (const ForceSample& sample : *samples)
            largest = std::max(largest, sample.reference_n);
    return largest;
}

/// Wrong and told as right: fail. Between good and wrong, and wrong but told: warning.
Check force_check(const std::string& name, const Errors& errors, Warning slightly) {
    Check check{name, errors.when_ok, criteria::kForceGood, "relative", CellStatus::pass, Warning::none, ""};
    if (errors.when_ok > criteria::kForceWrong) {
        check.status = CellStatus::fail;
        check.note = fmt::format("force wrong by {:.2g} and told as right", errors.when_ok);
    } else if (errors.when_ok > criteria::kForceGood) {
        check.status = CellStatus::warn;
        check.warning = slightly;
        check.note = fmt::format("force off by {:.2g}", errors.when_ok);
    }
    if (errors.when_told > 0)
        check.note +=
            fmt::format("{}{:.2g} in steps that told it", check.note.empty() ? "" : "; ", errors.when_told);
    return check;
}

void judge_forces(const Record& record, const Demands& demands, std::vector<Check>& checks) {
    const double largest_n = largest_reference_n(record);
    if (demands.forces && !record.against_linearised.empty()) {
        checks.push_back(
            force_check("step_force", errors_of(record.against_linearised, largest_n), Warning::step_force));
        if (record.not_compared > 0)
            checks.back().note += fmt::format("{}{} samples left out: the touched set changed",
                                              checks.back().note.empty() ? "" : "; ", record.not_compared);
    } else if (demands.forces) {
        checks.push_back({"step_force", kNotJudged, criteria::kForceGood, "relative", CellStatus::warn,
                          Warning::no_reference, "no step could be compared"});
    }
    if (demands.forces && !record.against_converged.empty()) {
        const Errors errors = errors_of(record.against_converged, largest_n);
        checks.push_back(at_most("linearisation", errors.when_ok, criteria::kForceWrong, "relative",
                                 CellStatus::warn, Warning::linearisation));
        if (checks.back().status != CellStatus::pass)
            checks.back().note =
                fmt::format("one linearisation: {:.2g} from the converged step", errors.when_ok);
    }
    if (demands.force_at_rest && record.at_rest) {
        checks.push_back(
            force_check("force_at_rest", errors_of({*record.at_rest}, largest_n), Warning::force_at_rest));
    } else if (demands.force_at_rest && !record.complete) {
        checks.push_back(not_judged("force_at_rest", criteria::kForceGood, "relative",
                                    "rest takes too many steps of this length"));
    }
    if (record.reference_refused > 0)
        checks.push_back({"reference_refused", static_cast<double>(record.reference_refused), 0, "solves",
                          CellStatus::warn, Warning::no_reference,
                          fmt::format("{} solves; {}", record.reference_refused, record.reference_words)});
}

void judge_energy(const Record& record, std::vector<Check>& checks) {
    checks.push_back(
        at_most("bounded", record.energy_over_work, 1 + criteria::kEnergySlack, "of the work done"));
    checks.push_back(
        at_most("passive", record.energy_over_net_work, criteria::kEnergySlack, "of the work done"));
    checks.push_back(at_most("drift", record.growth_while_still, criteria::kEnergyDrift, "of the work done"));
}

void judge_status(const Record& record, std::vector<Check>& checks) {
    const auto steps = static_cast<double>(std::max<std::uint64_t>(1, record.steps));
    const auto told = [&](const char* name, std::uint64_t count, double most, Warning warning) {
        const double share = static_cast<double>(count) / steps;
        Check check{name, static_cast<double>(count), 0, "steps", CellStatus::pass, Warning::none, ""};
        if (count > 0) {
            check.status = share > most ? CellStatus::fail : CellStatus::warn;
            check.warning = warning;
            check.note = fmt::format("{} of {} steps", count, record.steps);
        }
        checks.push_back(check);
    };
    told("not_converged", record.not_converged, criteria::kToldShare, Warning::not_converged);
    told("contact_cap", record.contact_cap, criteria::kToldShare, Warning::contact_cap);
    told("inside_out", record.inside_out, 1, Warning::inside_out);
    checks.push_back(at_most("bad_input", static_cast<double>(record.bad_input), 0, "steps"));
    checks.push_back(at_most("iterations", record.mean_iterations, criteria::kMeanIterations, "a step, mean",
                             CellStatus::warn, Warning::iterations));
    checks.back().note = fmt::format("{} at most", record.most_iterations);
}

void judge_contact(const Record& record, bool hooked, double size_m, std::vector<Check>& checks) {
    const double scale_n = record.largest_force_n > 0 ? record.largest_force_n : 1;
    checks.push_back(must_be("touches", record.touching_steps > 0, "the tool never touched"));
    if (!hooked)
        checks.push_back(
            at_most("pull", record.strongest_pull_n / scale_n, criteria::kContactLaw, "relative"));
    checks.push_back(at_most("cone", record.cone_excess_n / scale_n, criteria::kContactLaw, "relative"));
    checks.push_back(
        at_most("penetration", record.deepest_m / size_m, criteria::kPenetration, "of the size"));
    checks.push_back(at_most("force_away", record.force_away_n / scale_n, criteria::kForceAway, "relative"));
}

double growth(double last, double first) {
    return first > 0 ? last / first - 1 : (last > 0 ? HUGE_VAL : 0);
}

}  // namespace

Check at_most(const std::string& name, double value, double bound, const std::string& unit, CellStatus above,
              Warning warning) {
    Check check{name, value, bound, unit, CellStatus::pass, Warning::none, ""};
    if (value <= bound) return check;  // false for NaN: that is above everything
    check.status = std::isfinite(value) ? above : CellStatus::fail;
    check.warning = check.status == CellStatus::warn ? warning : Warning::none;
    check.note = fmt::format("{} {:.3g}, at most {:.3g} {}", name, value, bound, unit);
    return check;
}

Check must_be(const std::string& name, bool is_so, const std::string& note) {
    return {name,          is_so ? 1.0 : 0.0, 1, "yes", is_so ? CellStatus::pass : CellStatus::fail,
            Warning::none, is_so ? "" : note};
}

std::vector<Check> judge(const Record& record, const Demands& demands, double size_m) {
    std::vector<Check> checks;
    checks.push_back(must_be("finite", record.finite && record.not_finite == 0,
                             fmt::format("not finite ({} steps told it)", record.not_finite)));
    judge_forces(record, demands, checks);
    if (demands.energy) judge_energy(record, checks);
    const bool hooked = demands.recovery && demands.contact_law && record.touches_at_end;
    if (hooked)
        checks.push_back(
            {"leaves", 0, 1, "yes", CellStatus::warn, Warning::hooked, "the tool has left with nodes on it"});
    if (demands.recovery && record.complete && !hooked)
        checks.push_back(at_most("recovery", record.off_rest, criteria::kOffRest, "of the size"));
    if (demands.recovery && !record.complete)
        checks.push_back(not_judged("recovery", criteria::kOffRest, "of the size",
                                    "rest takes too many steps of this length"));
    judge_status(record, checks);
    if (demands.contact_law) judge_contact(record, hooked, size_m, checks);
    if (demands.soak) {
        checks.push_back(at_most("force_growth",
                                 growth(record.last_tenth_force_n, record.first_tenth_force_n),
                                 criteria::kSoakGrowth, "last tenth over first"));
        checks.push_back(at_most("energy_growth",
                                 growth(record.last_tenth_energy_j, record.first_tenth_energy_j),
                                 criteria::kSoakGrowth, "last tenth over first"));
    }
    const auto about = std::find_if(checks.begin(), checks.end(),
                                    [&](const Check& check) { return check.name == demands.about; });
    if (about != checks.end()) std::rotate(checks.begin(), about, about + 1);
    return checks;
}

}  // namespace knead::tools::stability
