// SPDX-License-Identifier: Apache-2.0
// Same asset, configuration, inputs and instruction set: the same bits, whatever else the process does.
#include <gtest/gtest.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <cmath>
#include <cstring>
#include <functional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "unit/runtime/press.h"

namespace knead::test {
namespace {

using core::SimdTarget;

constexpr int kSteps = 400;
constexpr int kStateEvery = 20;  ///< steps between records of all positions and velocities

/// Everything that the steps gave, bit by bit.
struct Trace {
    std::vector<double> results;        ///< forces, torques, tool positions
    std::vector<std::uint32_t> counts;  ///< status, iterations, touched nodes
    std::vector<double> states;

    bool operator==(const Trace& other) const {
        const auto same = [](const auto& a, const auto& b) {  // NaN is like NaN, zero unlike minus zero
            return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
        };
        return same(results, other.results) && same(counts, other.counts) && same(states, other.states);
    }
};

struct Case {
    const char* name;
    ToolShape shape;
    ToolContact contact;
    Precision arithmetic = Precision::float32;
    Preconditioner preconditioner = Preconditioner::factor;
    double coupling_n_per_m = 0;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

constexpr Case kCases[] = {
    {"bonded", ToolShape::plate, ToolContact::bonded},
    {"bonded_double", ToolShape::plate, ToolContact::bonded, Precision::float64},
    {"bonded_mixed", ToolShape::plate, ToolContact::bonded, Precision::mixed},
    {"sphere_coulomb_mixed", ToolShape::sphere, ToolContact::coulomb, Precision::mixed},
    {"sphere_coulomb", ToolShape::sphere, ToolContact::coulomb},
    {"sphere_coulomb_double", ToolShape::sphere, ToolContact::coulomb, Precision::float64},
    {"plate_sticking_coupled", ToolShape::plate, ToolContact::sticking, Precision::float32,
     Preconditioner::factor, 800},
    {"capsule_sparse_inverse", ToolShape::capsule, ToolContact::frictionless, Precision::float32,
     Preconditioner::sparse_inverse},
    {"plate_laplacian", ToolShape::plate, ToolContact::coulomb, Precision::float32,
     Preconditioner::laplacian},
};

/// A stepper and the script it follows: a press with slip that turns, a release, quiet that decays into
/// numbers too small to be normal, touches of 1e-36 m, and a press again; dt changes on the way.
class ScriptedRun {
  public:
    explicit ScriptedRun(const Case& c, SimdTarget target = core::best_simd_target())
        : asset_(cube_asset(4, c.shape, c.contact)), velocities_(3 * asset_.nodes_m.size()) {
        make_heterogeneous(asset_, 11);
        SimulationConfig config;
        config.with_torque = true;
        config.coupling_stiffness_n_per_m = c.coupling_n_per_m;
        Numerics numerics = choose_numerics(asset_);
        numerics.arithmetic = c.arithmetic;
        numerics.preconditioner = c.preconditioner;
        stepper_ = core::make_stepper(asset_, config, numerics, target);
    }

    /// The next step of the script. `around` gets it to call, and may do something before and after.
    void step(const std::function<void(const std::function<void()>&)>& around = [](const auto& f) { f(); }) {
        const Pose pose = hand(step_);
        const double dt_s = step_ % 60 < 40 ? 1e-3 : 2.5e-3;
        StepResult result;
        around([&] { result = stepper_->step(&pose, dt_s); });
        for (const Vec3* v : {&result.force_n, &result.torque_nm, &result.tool_position_m})
            trace_.results.insert(trace_.results.end(), v->begin(), v->end());
        for (const std::uint32_t count : {result.status, result.solver_iterations, result.touched_nodes})
            trace_.counts.push_back(count);
        if (++step_ % kStateEvery == 0) record_state();
    }

    [[nodiscard]] const Trace& trace() const { return trace_; }
    [[nodiscard]] const Trace& to_the_end() {
        while (step_ < kSteps)
            step();
        return trace_;
    }

  private:
    [[nodiscard]] Pose hand(int i) const {
        const double depth_m = i < 100   ? 1e-4 * i
                               : i < 120 ? 5e-4 * (120 - i)
                               : i < 320 ? 0
                                         : 8e-5 * (i - 320);
        Pose pose = moved(asset_, {0.3 * depth_m, i >= 200 && i < 240 ? 1e-36 : 0, -depth_m});
        const double half_angle = 2 * depth_m;
        const Point q = {std::cos(half_angle), std::sin(half_angle), 0};
        const auto& rest =
            asset_.tools[0].rest_orientation_wxyz;  // turned about z before the rest orientation
        pose.orientation_wxyz = {q[0] * rest[0] - q[1] * rest[3], q[0] * rest[1] - q[1] * rest[2],
                                 q[0] * rest[2] + q[1] * rest[1], q[0] * rest[3] + q[1] * rest[0]};
        return pose;
    }

    void record_state() {
        std::vector<double> positions(3 * asset_.nodes_m.size());
        stepper_->positions_m(positions.data());
        stepper_->velocities_m_per_s(velocities_.data());
        trace_.states.insert(trace_.states.end(), positions.begin(), positions.end());
        trace_.states.insert(trace_.states.end(), velocities_.begin(), velocities_.end());
    }

    Asset asset_;
    std::unique_ptr<core::Stepper> stepper_;
    std::vector<double> velocities_;
    Trace trace_;
    int step_ = 0;
};

class Same_bits : public testing::TestWithParam<Case> {
  protected:
    [[nodiscard]] static const Case& param() { return GetParam(); }
    const Trace alone_ = ScriptedRun(param()).to_the_end();
};

TEST_P(Same_bits, come_from_a_run_that_touches_and_presses) {
    std::uint32_t most_touched = 0;
    double most_n = 0;
    for (std::size_t i = 0; i < alone_.counts.size(); i += 3) {
        most_touched = std::max(most_touched, alone_.counts[i + 2]);
        most_n = std::max(most_n, alone_.results[3 * i + 2]);
    }
    EXPECT_GT(most_touched, 0u);
    EXPECT_GT(most_n, 0.05);
}

TEST_P(Same_bits, come_from_two_that_take_turns) {
    ScriptedRun first(param());
    const std::vector<char> between(12345);  // the second one lies elsewhere in memory
    ScriptedRun second(param());
    for (int i = 0; i < kSteps; ++i) {
        first.step();
        second.step();
    }
    EXPECT_TRUE(first.trace() == alone_);
    EXPECT_TRUE(second.trace() == alone_);
}

TEST_P(Same_bits, come_from_one_that_goes_ahead_of_the_other) {
    ScriptedRun first(param()), second(param());
    for (int i = 0; i < kSteps / 2; ++i)
        first.step();
    (void)second.to_the_end();
    EXPECT_TRUE(first.to_the_end() == alone_);
    EXPECT_TRUE(second.trace() == alone_);
}

TEST_P(Same_bits, come_from_two_threads_at_once) {
    ScriptedRun first(param()), second(param());
    std::thread other([&second] { (void)second.to_the_end(); });
    (void)first.to_the_end();
    other.join();
    EXPECT_TRUE(first.trace() == alone_);
    EXPECT_TRUE(second.trace() == alone_);
}

INSTANTIATE_TEST_SUITE_P(each, Same_bits, testing::ValuesIn(kCases),
                         [](const auto& c) { return std::string(c.param.name); });

// ---- Whatever the caller's floating-point environment is
// ---------------------------------------------------

#if defined(__SSE2__)

// Bits of the control word. A trap is off where its bit is set.
constexpr unsigned kTrapsOff = 0x1f80, kTrapsOnInvalidAndZeroDivide = 0x1d00;
constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
constexpr unsigned kDownwards = 0x2000, kUpwards = 0x4000, kTowardsZero = 0x6000;
constexpr unsigned kSeenInexact = 0x0020;

TEST_P(Same_bits, come_under_any_control_word_of_the_caller_which_is_restored) {
    for (const unsigned word :
         {kTrapsOff, kTrapsOff | kFlushToZero | kDenormalsAreZero, kTrapsOff | kDenormalsAreZero,
          kTrapsOff | kSeenInexact, kTrapsOff | kDownwards, kTrapsOff | kUpwards, kTrapsOff | kTowardsZero,
          kTrapsOnInvalidAndZeroDivide}) {
        ScriptedRun run(param());
        unsigned after = 0;
        for (int i = 0; i < kSteps; ++i) {
            run.step([&](const auto& step) {
                const unsigned usual = _mm_getcsr();
                _mm_setcsr(word);
                step();
                after = _mm_getcsr();
                _mm_setcsr(usual);
            });
            ASSERT_EQ(after, word) << "not restored by step " << i;
        }
        EXPECT_TRUE(run.trace() == alone_) << std::hex << word;
    }
}

#endif

// ---- Each instruction set
// ----------------------------------------------------------------------------------

/// Of the largest force of the run. Each step is within 1e-3 of the exact one; 2e-6 was measured, and what
/// the order of sums does to a long run of another machine is left room for.
constexpr double kForce = 1e-4;

/// Forces on the hand, newtons, one after the other.
std::vector<Vec3> forces_of(const Trace& trace) {
    std::vector<Vec3> forces;
    for (std::size_t i = 0; i < trace.results.size(); i += 9)
        forces.push_back({trace.results[i], trace.results[i + 1], trace.results[i + 2]});
    return forces;
}

double norm(const Vec3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The largest difference of two runs' forces, relative to the largest force.
double difference(const Trace& a, const Trace& b) {
    const std::vector<Vec3> first = forces_of(a), second = forces_of(b);
    double largest_n = 0, most_n = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        largest_n = std::max(largest_n, norm(first[i]));
        Vec3 apart{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            apart[axis] = first[i][axis] - second[i][axis];
        most_n = std::max(most_n, norm(apart));
    }
    return most_n / largest_n;
}

TEST_P(Same_bits, come_from_each_instruction_set_by_itself_and_forces_near_those_of_the_others) {
    const Trace portable = ScriptedRun(param(), SimdTarget::portable).to_the_end();
    for (const SimdTarget target : {SimdTarget::portable, SimdTarget::avx2, SimdTarget::avx512}) {
        if (!core::has_simd_target(target)) continue;
        const Trace trace = ScriptedRun(param(), target).to_the_end();
        EXPECT_TRUE(ScriptedRun(param(), target).to_the_end() == trace) << static_cast<int>(target);
        EXPECT_LT(difference(trace, portable), kForce) << static_cast<int>(target);
        RecordProperty("difference_" + std::to_string(static_cast<int>(target)),
                       std::to_string(difference(trace, portable)));
    }
}

TEST(Simd_targets, are_really_different_code) {
    if (core::best_simd_target() == SimdTarget::portable) GTEST_SKIP() << "this processor has one only";
    EXPECT_FALSE(ScriptedRun(kCases[0], SimdTarget::portable).to_the_end() ==
                 ScriptedRun(kCases[0]).to_the_end());
}

}  // namespace
}  // namespace knead::test
