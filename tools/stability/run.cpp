// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/run.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "stability/criteria.h"
#include "stability/meters.h"
#include "stability/truth.h"

namespace knead::tools::stability {
namespace {

constexpr std::size_t kEnergySamples = 300;
/// In each of the two tenths of a soak that are compared: dense enough for the peaks of a tremor.
constexpr std::size_t kSoakSamples = 500;

/// Times at which forces are compared: two fifths of them while the tool comes, as many while it goes, the
/// rest while it is still and after it has left.
std::vector<double> compared_times(const Script& script, std::size_t count) {
    struct Phase {
        double from_s, to_s, share;
    };
    const Phase phases[] = {{0, script.still_s, 0.4},
                            {script.still_s, script.leave_s, 0.1},
                            {script.leave_s, script.released_s, 0.4},
                            {script.released_s, script.end_s, 0.1}};
    std::vector<double> times;
    for (const Phase& phase : phases) {
        const auto n = static_cast<std::size_t>(std::ceil(phase.share * static_cast<double>(count)));
        for (std::size_t i = 0; i < n && phase.to_s > phase.from_s; ++i)
            times.push_back(phase.from_s + (phase.to_s - phase.from_s) * (static_cast<double>(i) + 0.5) /
                                               static_cast<double>(n));
    }
    return times;
}

/// One run under way.
class Runner {
  public:
    Runner(const Specimen& specimen, const Script& script, const RunOptions& options)
        : specimen_(specimen),
          script_(script),
          options_(options),
          simulation_(simulation_of(specimen, options.config)),
          energy_(specimen, options.config),
          contact_(specimen),
          times_(compared_times(script, options.compared_steps)) {
        if (options.compared_steps > 0 || options.force_at_rest) truth_.emplace(specimen);
        for (std::size_t k = 0; k < simulation_.tool_count(); ++k)
            rest_.push_back(simulation_.tool_rest_pose(k));
        hands_ = tools_ = rest_;
    }
    Record run();

  private:
    [[nodiscard]] Snapshot snapshot() const;
    void step(std::uint64_t number, double dt_s);
    void count(const StepResult& result);
    void compare(const Snapshot& from, double dt_s, Truth::Step kind, std::vector<ForceSample>& samples);
    void take_the_nearer(std::size_t linearised, std::size_t converged);
    void compare_at_rest();
    void refused(const std::string& words) {
        if (record_.reference_refused++ == 0) record_.reference_words = words;
    }
    void look_at_energy();
    void look_at_contact();
    void soak_tenths();
    [[nodiscard]] bool in_compared_tenth() const {
        const double share = (time_s_ - script_.steady_s) / (script_.end_s - script_.steady_s);
        return (share >= 0 && share < 0.1) || share > 0.9;
    }
    [[nodiscard]] std::vector<Pose> tool_poses(const std::vector<Pose>& hands) const;
    /// That the step is not solved.
    [[nodiscard]] bool told() const {
        return (result_.status & (kStepNotConverged | kStepContactCap | kStepNotFinite)) != 0;
    }
    /// That the object may have no rest.
    [[nodiscard]] bool told_no_rest() const { return told() || (result_.status & kStepInsideOut) != 0; }

    const Specimen& specimen_;
    const Script& script_;
    const RunOptions& options_;
    Simulation simulation_;
    EnergyMeter energy_;
    ContactMeter contact_;
    std::vector<double> times_;
    std::size_t next_compared_ = 0;
    std::optional<Truth> truth_;
    std::optional<Snapshot> before_;  ///< a step before one that is compared

    double time_s_ = 0;
    std::vector<Pose> rest_, hands_, tools_;
    StepResult result_;
    std::vector<ToolResult> results_;
    double least_while_still_j_ = HUGE_VAL;
    bool moved_ = false;  ///< a tool, since energy was looked at
    double iterations_ = 0;
    Record record_;
};

std::vector<Pose> Runner::tool_poses(const std::vector<Pose>& hands) const {
    std::vector<Pose> poses = hands;
    for (std::size_t k = 0; k < poses.size(); ++k)
        poses[k].position_m = results_.empty() ? poses[k].position_m : results_[k].tool_position_m;
    return poses;
}

Snapshot Runner::snapshot() const {
    Snapshot shot;
    const std::size_t nodes = simulation_.node_count();
    shot.state.positions_m.resize(nodes);
    shot.state.velocities_m_per_s.resize(nodes);
    std::copy_n(simulation_.positions_m(), 3 * nodes, shot.state.positions_m[0].data());
    simulation_.velocities_m_per_s(shot.state.velocities_m_per_s[0].data());
    shot.tools = tools_;
    for (std::size_t k = 0; k < tools_.size(); ++k)
        shot.touched.push_back(results_.empty() ? 0 : results_[k].touched_nodes);
    return shot;
}

void Runner::count(const StepResult& result) {
    ++record_.steps;
    const auto bit = [&](std::uint32_t status) { return (result.status & status) != 0 ? 1U : 0U; };
    record_.not_converged += bit(kStepNotConverged);
    record_.contact_cap += bit(kStepContactCap);
    record_.not_finite += bit(kStepNotFinite);
    record_.bad_input += bit(kStepBadInput);
    record_.inside_out += bit(kStepInsideOut);
    iterations_ += result.solver_iterations;
    record_.most_iterations = std::max(record_.most_iterations, result.solver_iterations);
}

void Runner::step(std::uint64_t number, double dt_s) {
    time_s_ += dt_s;
    std::vector<Pose> hands = rest_;
    script_.move(time_s_, hands);
    const bool compared = next_compared_ < times_.size() && time_s_ >= times_[next_compared_];
    std::optional<Snapshot> from;
    if (compared) {
        while (next_compared_ < times_.size() && time_s_ >= times_[next_compared_])
            ++next_compared_;
        from = snapshot();
    } else {
        before_.reset();
        if (next_compared_ < times_.size() && time_s_ + script_.dt(number + 1) >= times_[next_compared_])
            before_ = snapshot();
    }
    result_ = simulation_.step(hands.data(), dt_s);
    results_.resize(hands.size());
    for (std::size_t k = 0; k < hands.size(); ++k) {
        results_[k] = simulation_.tool(k);
        if (options_.tamper) options_.tamper(number, results_[k], result_.status);
    }
    count(result_);
    energy_.work(hands_, hands, results_, dt_s);
    for (std::size_t k = 0; k < hands.size(); ++k)
        moved_ = moved_ || hands[k].position_m != hands_[k].position_m ||
                 hands[k].orientation_wxyz != hands_[k].orientation_wxyz;
    hands_ = hands;
    tools_ = tool_poses(hands);
    for (const ToolResult& tool : results_) {
        const double force = std::hypot(tool.force_n[0], tool.force_n[1], tool.force_n[2]);
        record_.finite = record_.finite && std::isfinite(force);
        record_.largest_force_n = std::max(record_.largest_force_n, force);
        record_.touching_steps += tool.touched_nodes > 0 ? 1 : 0;
    }
    if (!record_.finite || !from) return;
    const std::size_t linearised = record_.against_linearised.size();
    const std::size_t converged = record_.against_converged.size();
    compare(*from, dt_s, Truth::Step::linearised, record_.against_linearised);
    if (!options_.compare_converged) return;
    compare(*from, dt_s, Truth::Step::converged, record_.against_converged);
    if (dt_s > criteria::kMayLineariseAgain_s) take_the_nearer(linearised, converged);
}

/// Of both kinds of samples, where this step gave one of each for every tool.
/// @param linearised, converged  where those of this step begin
void Runner::take_the_nearer(std::size_t linearised, std::size_t converged) {
    if (record_.against_linearised.size() - linearised != results_.size() ||
        record_.against_converged.size() - converged != results_.size())
        return;
    for (std::size_t k = 0; k < results_.size(); ++k) {
        ForceSample& sample = record_.against_linearised[linearised + k];
        const ForceSample& other = record_.against_converged[converged + k];
        if (other.difference_n < sample.difference_n) sample = other;
    }
}

void Runner::compare(const Snapshot& from, double dt_s, Truth::Step kind, std::vector<ForceSample>& samples) {
    try {
        double force_n = 0;
        for (const ToolResult& tool : results_)
            force_n = std::max(force_n, std::hypot(tool.force_n[0], tool.force_n[1], tool.force_n[2]));
        const bool small = force_n < criteria::kSmallestForceShare * record_.largest_force_n;
        const Truth::Forces truth =
            truth_->step(from, tools_, dt_s, kind, small ? Truth::kResidualOfSmall : Truth::kResidual,
                         before_ ? &*before_ : nullptr);
        for (std::size_t k = 0; k < results_.size(); ++k) {
            const bool same_set = specimen_.asset.tools[k].contact == ToolContact::bonded ||
                                  (from.touched[k] == results_[k].touched_nodes &&
                                   truth.touched[k] == results_[k].touched_nodes);
            if (!same_set) {
                ++record_.not_compared;
                continue;
            }
            const Eigen::Map<const Eigen::Vector3d> force(results_[k].force_n.data());
            samples.push_back({(force - truth.force_n[k]).norm(), truth.force_n[k].norm(), told()});
        }
    } catch (const ToolError& error) {
        refused(error.what());
    }
}

void Runner::compare_at_rest() {
    const Truth::AtRest truth = truth_->at_rest(snapshot());
    ForceSample worst;
    for (std::size_t k = 0; k < results_.size(); ++k) {
        const Eigen::Map<const Eigen::Vector3d> force(results_[k].force_n.data());
        const double reference_n = truth.force_n[k].norm();
        const ForceSample sample{(force - truth.force_n[k]).norm() + truth.unbalanced_n, reference_n,
                                 told_no_rest()};
        const bool is_worse = sample.difference_n * worst.reference_n >= worst.difference_n * reference_n;
        if (k == 0 || is_worse) worst = sample;
    }
    // Where the reference finds none, only a balance is an answer.
    if (!truth.refused.empty() && !(worst.difference_n <= criteria::kForceGood * worst.reference_n))
        refused(truth.refused);
    else
        record_.at_rest = worst;
}

void Runner::look_at_energy() {
    const Snapshot shot = snapshot();
    const double energy_j = energy_.energy_j(shot, hands_, results_);
    record_.finite = record_.finite && std::isfinite(energy_j);
    const double above_noise_j = energy_j - energy_.slack_j();
    const double work_j = energy_.positive_work_j();
    if (work_j > 0) {
        record_.energy_over_work = std::max(record_.energy_over_work, above_noise_j / work_j);
        record_.energy_over_net_work =
            std::max(record_.energy_over_net_work, (above_noise_j - energy_.net_work_j()) / work_j);
    }
    if (moved_) least_while_still_j_ = HUGE_VAL;
    if (!moved_ && script_.steady_s < 0) {
        if (work_j > 0 && std::isfinite(least_while_still_j_))
            record_.growth_while_still =
                std::max(record_.growth_while_still, (above_noise_j - least_while_still_j_) / work_j);
        least_while_still_j_ = std::min(least_while_still_j_, energy_j);
    }
    moved_ = false;
    record_.deepest_m = std::max(record_.deepest_m, contact_.deepest_m(shot));
    if (script_.steady_s < 0) return;
    const double length_s = script_.end_s - script_.steady_s, since_s = time_s_ - script_.steady_s;
    if (since_s >= 0 && since_s < 0.1 * length_s)
        record_.first_tenth_energy_j = std::max(record_.first_tenth_energy_j, energy_j);
    if (since_s > 0.9 * length_s)
        record_.last_tenth_energy_j = std::max(record_.last_tenth_energy_j, energy_j);
}

void Runner::look_at_contact() {
    for (std::size_t k = 0; k < results_.size(); ++k) {
        const ContactMeter::Law law = contact_.law(k, tools_[k], results_[k]);
        record_.strongest_pull_n = std::max(record_.strongest_pull_n, law.pull_n);
        record_.cone_excess_n = std::max(record_.cone_excess_n, law.cone_excess_n);
        const bool away = time_s_ > script_.released_s &&
                          specimen_.asset.tools[k].contact != ToolContact::bonded &&
                          results_[k].touched_nodes == 0;
        if (away) {
            const auto& f = results_[k].force_n;
            record_.force_away_n = std::max(record_.force_away_n, std::hypot(f[0], f[1], f[2]));
        }
    }
}

void Runner::soak_tenths() {
    const double length_s = script_.end_s - script_.steady_s, since_s = time_s_ - script_.steady_s;
    if (since_s < 0) return;
    for (const ToolResult& tool : results_) {
        const double force = std::hypot(tool.force_n[0], tool.force_n[1], tool.force_n[2]);
        if (since_s < 0.1 * length_s)
            record_.first_tenth_force_n = std::max(record_.first_tenth_force_n, force);
        if (since_s > 0.9 * length_s)
            record_.last_tenth_force_n = std::max(record_.last_tenth_force_n, force);
    }
}

Record Runner::run() {
    const std::uint64_t most = options_.most_steps > 0 ? options_.most_steps : criteria::kMostSteps;
    const double expected = script_.end_s / script_.dt(0);
    const auto spread = [&](double count) {
        return std::max<std::size_t>(1, static_cast<std::size_t>(expected / count));
    };
    const std::size_t every = spread(static_cast<double>(kEnergySamples));
    const std::size_t every_of_soak = spread(10.0 * static_cast<double>(kSoakSamples));
    const double end_s = script_.end_s * (1 + 1e-9);
    for (std::uint64_t k = 0;; ++k) {
        const double dt_s = script_.dt(k);
        if (time_s_ + dt_s > end_s || !record_.finite) break;
        if (k == most) {
            record_.complete = false;
            break;
        }
        const bool was_held = time_s_ <= script_.leave_s;
        step(k, dt_s);
        look_at_contact();
        if (script_.steady_s >= 0) soak_tenths();
        const bool dense = script_.steady_s >= 0 && in_compared_tenth();
        if (k % (dense ? every_of_soak : every) == 0 || time_s_ + script_.dt(k + 1) > end_s) look_at_energy();
        const bool last_held = was_held && time_s_ + script_.dt(k + 1) > script_.leave_s && !record_.at_rest;
        if (options_.force_at_rest && truth_ && last_held && script_.leave_s > script_.still_s &&
            record_.finite)
            compare_at_rest();
    }
    record_.mean_iterations = iterations_ / static_cast<double>(std::max<std::uint64_t>(1, record_.steps));
    record_.positive_work_j = energy_.positive_work_j();
    for (std::size_t k = 0; k < results_.size(); ++k)
        record_.touches_at_end =
            record_.touches_at_end ||
            (results_[k].touched_nodes > 0 && specimen_.asset.tools[k].contact != ToolContact::bonded);
    record_.off_rest = off_rest(specimen_, snapshot());
    record_.finite = record_.finite && std::isfinite(record_.off_rest);
    return record_;
}

}  // namespace

Simulation simulation_of(const Specimen& specimen, const SimulationConfig& config) {
    Result<Simulation> created = Simulation::create(specimen.asset, config);
    if (!created.ok()) fail_result("the runtime refuses: " + created.error().text());
    return std::move(created).value();
}

SimulationConfig config_for(const Specimen& specimen, double dt_s) {
    SimulationConfig config;
    config.tools.clear();
    for (std::size_t k = 0; k < specimen.asset.tools.size(); ++k)
        config.tools.push_back(k);
    config.expected_dt_s = dt_s;
    config.with_torque = true;
    return config;
}

Record run(const Specimen& specimen, const Script& script, const RunOptions& options) {
    return Runner(specimen, script, options).run();
}

}  // namespace knead::tools::stability
