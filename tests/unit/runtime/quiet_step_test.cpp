// SPDX-License-Identifier: Apache-2.0
// A step makes no system call, takes no lock and allocates nothing. Each case is stepped in a child process
// that has given up every system call but exit: the kernel kills it at the first one.
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <string>

#include "core/simd/kernels.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/haptics/scripted_device.h"
#include "knead/runtime/simulation.h"
#include "unit/runtime/press.h"
#include "unit/runtime/watched_calls.h"

namespace knead::test {
namespace {

/// How a child ended. Its exit code says which, so that it needs no pipe.
enum class Verdict : int {
    quiet = 0,
    allocated = 10,
    freed = 11,
    locked = 12,
    did_nothing = 13,  ///< the case did not get into the state that it is about
    no_seccomp = 14,   ///< this system does not offer it
    system_call = 15,  ///< killed for one
    crashed = 16,
};

std::ostream& operator<<(std::ostream& out, Verdict verdict) {
    return out << "Verdict " << static_cast<int>(verdict);
}

constexpr int kSteps = 3000;

/// What a case does in each step, made before the system calls are given up. `reached` tells whether the
/// steps got to what the case is about.
struct Steps {
    std::function<void(int)> step;
    std::function<bool()> reached = [] { return true; };
};
using MakeSteps = std::function<Steps()>;

[[noreturn]] void leave(Verdict verdict) {
    if (kSanitized)
        _exit(static_cast<int>(verdict));          // the thread sanitizer has a thread of its own: all end
    syscall(SYS_exit, static_cast<int>(verdict));  // not exit_group: strict mode has the former only
    __builtin_unreachable();
}

/// Without system calls, except under a sanitizer: its own would be the end of the child.
[[noreturn]] void run_child(const MakeSteps& make_steps) {
    const Steps steps = make_steps();
    if (!kSanitized && prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) leave(Verdict::no_seccomp);
    const WatchedCalls before = watched_calls();
    for (int i = 0; i < kSteps; ++i)
        steps.step(i);
    const WatchedCalls during = watched_calls() - before;
    if (during.allocations != 0) leave(Verdict::allocated);
    if (during.frees != 0) leave(Verdict::freed);
    if (during.locks != 0) leave(Verdict::locked);
    leave(steps.reached() ? Verdict::quiet : Verdict::did_nothing);
}

Verdict verdict_on(const MakeSteps& make_steps) {
    const pid_t child = fork();
    if (child == 0) run_child(make_steps);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return Verdict::crashed;
    if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGKILL ? Verdict::system_call : Verdict::crashed;
    return static_cast<Verdict>(WEXITSTATUS(status));
}

// ---- The check itself can fail
// -----------------------------------------------------------------------------

Verdict verdict_on(void (*step)()) {
    return verdict_on([step] {
        return Steps{[step](int i) {
            if (i == kSteps / 2) step();
        }};
    });
}

void* volatile kept = nullptr;  // NOLINT: keeps the compiler from leaving allocations out

TEST(Check_for_quiet_steps, passes_arithmetic) {
    const Verdict verdict = verdict_on([] {});
    if (verdict == Verdict::no_seccomp) GTEST_SKIP() << "this system has no strict seccomp mode";
    EXPECT_EQ(verdict, Verdict::quiet);
}

TEST(Check_for_quiet_steps, finds_operator_new) {
    EXPECT_EQ(verdict_on([] { kept = new int(1); }), Verdict::allocated);
    const auto number = std::make_unique<int>(1);
    kept = number.get();  // the child deletes its own copy
    EXPECT_EQ(verdict_on([] { delete static_cast<int*>(kept); }), Verdict::freed);
}

TEST(Check_for_quiet_steps, finds_each_way_to_allocate) {
    if (kSanitized) GTEST_SKIP() << "a sanitizer has these functions; operator new alone is counted";
    EXPECT_EQ(verdict_on([] { kept = std::malloc(10); }), Verdict::allocated);
    EXPECT_EQ(verdict_on([] { kept = std::calloc(10, 1); }), Verdict::allocated);
    EXPECT_EQ(verdict_on([] { kept = std::realloc(nullptr, 10); }), Verdict::allocated);
    EXPECT_EQ(verdict_on([] { kept = std::aligned_alloc(64, 64); }), Verdict::allocated);
    EXPECT_EQ(verdict_on([] {
                  void* memory = nullptr;
                  if (posix_memalign(&memory, 64, 64) == 0) kept = memory;
              }),
              Verdict::allocated);
    kept = nullptr;
    EXPECT_EQ(verdict_on([] { std::free(kept); }), Verdict::freed);
}

TEST(Check_for_quiet_steps, finds_locks) {
    if (kSanitized) GTEST_SKIP() << "a sanitizer has these functions";
    EXPECT_EQ(verdict_on([] {
                  static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
                  pthread_mutex_lock(&mutex);
                  pthread_mutex_unlock(&mutex);
              }),
              Verdict::locked);
    EXPECT_EQ(verdict_on([] {
                  static pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
                  pthread_rwlock_rdlock(&lock);
                  pthread_rwlock_unlock(&lock);
              }),
              Verdict::locked);
    EXPECT_EQ(verdict_on([] {
                  static sem_t semaphore;
                  (void)sem_trywait(&semaphore);
              }),
              Verdict::locked);
}

TEST(Check_for_quiet_steps, finds_system_calls) {
    if (kSanitized) GTEST_SKIP() << "sanitizers make system calls of their own";
    EXPECT_EQ(verdict_on([] { (void)getppid(); }), Verdict::system_call);
    EXPECT_EQ(verdict_on([] { sched_yield(); }), Verdict::system_call);
    EXPECT_EQ(verdict_on([] { kept = std::malloc(std::size_t{64} << 20); }), Verdict::system_call);  // mmap
}

TEST(Check_for_quiet_steps, finds_a_case_that_does_not_get_there) {
    EXPECT_EQ(verdict_on([] { return Steps{[](int) {}, [] { return false; }}; }), Verdict::did_nothing);
}

// ---- The cases
// ---------------------------------------------------------------------------------------------

struct Case {
    const char* name;
    ToolShape shape;
    ToolContact contact;
    Arithmetic arithmetic = Arithmetic::float32;
    double coupling_n_per_m = 0;
    Preconditioner preconditioner = Preconditioner::factor;
    double poissons_ratio = 0.3;
    int max_iterations = 500;
    std::uint32_t expected_status = 0;  ///< bits that must be seen, beside bad input
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

/// Down and up again a bit faster each time, and to the side; from above the surface to `deepest` below it.
Vec3 hand_move(int i, double deepest_m) {
    const double phase = 0.02 * i * (1 + i / 2000.0);
    return {2e-3 * std::sin(0.7 * phase), 1e-3 * std::sin(1.3 * phase),
            0.002 - deepest_m * 0.5 * (1 - std::cos(phase))};
}

/// Now and then another dt that lasts, so that the preconditioner is made anew for it; jitter between.
double dt_of(int i) {
    static constexpr double kLasting_s[] = {1e-3, 4e-3, 0.25e-3, 20e-3, 1e-3};
    return i % 97 == 96 ? 2e-3 : kLasting_s[(i / 300) % 5];
}

/// Every input that a step refuses, and one that it cannot survive.
Pose poor(int i, Pose pose) {
    if (i % 250 == 100) pose.position_m[1] = std::nan("");
    if (i % 250 == 101) pose.position_m[0] = std::numeric_limits<double>::infinity();
    if (i % 250 == 102) pose.orientation_wxyz = {0, 0, 0, 0};
    if (i % 1000 == 103) pose.position_m[0] = 1e306;
    return pose;
}

/// The core's stepper under `c`, and what it has seen.
struct Subject {
    explicit Subject(const Case& c)
        : asset(cube_asset(4, c.shape, c.contact, {22e3, c.poissons_ratio, 1000})),
          expected_status(c.expected_status) {
        make_heterogeneous(asset, 7);
        for (PaletteEntry& entry : asset.palette)
            entry.poissons_ratio = c.poissons_ratio;
        SimulationConfig config;
        config.coupling_stiffness_n_per_m = c.coupling_n_per_m;
        config.coupling_damping_n_s_per_m = c.coupling_n_per_m > 0 ? 0.5 : 0;
        config.max_solver_iterations = c.max_iterations;
        config.max_linearisations = c.arithmetic == Arithmetic::mixed ? 3 : 0;
        config.with_torque = true;
        Numerics numerics = choose_numerics(asset);
        numerics.arithmetic = c.arithmetic == Arithmetic::float64 ? Precision::float64
                              : c.arithmetic == Arithmetic::mixed ? Precision::mixed
                                                                  : Precision::float32;
        numerics.preconditioner = c.preconditioner;
        stepper = core::make_stepper(asset, config, numerics, core::best_simd_target());
    }

    void step(int i) {
        if (i % 500 == 410) stepper->reset();  // soon after another dt came to last: see dt_of()
        const Pose pose = poor(i, moved(asset, hand_move(i, i > 2 * kSteps / 3 ? 0.05 : 0.01)));
        const double dt_s = i % 400 == 399 ? std::nan("") : dt_of(i);
        const StepResult result = stepper->step(&pose, dt_s);
        seen_status |= result.status;
        most_touched = std::max(most_touched, result.touched_nodes);
        least_touched = std::min(least_touched, i > 0 ? result.touched_nodes : least_touched);
    }

    /// It touched and, unless bonded, left; bad input was seen and told.
    [[nodiscard]] bool reached() const {
        const std::uint32_t expected = expected_status | kStepBadInput;
        const bool left = asset.tools[0].contact == ToolContact::bonded || least_touched == 0;
        return (seen_status & expected) == expected && most_touched > 0 && left;
    }

    Asset asset;
    std::unique_ptr<core::Stepper> stepper;
    std::uint32_t expected_status;
    std::uint32_t seen_status = 0, most_touched = 0, least_touched = 1000;
};

class Quiet_step : public testing::TestWithParam<Case> {};

void expect_quiet(const MakeSteps& make_steps) {
    const Verdict verdict = verdict_on(make_steps);
    if (verdict == Verdict::no_seccomp) GTEST_SKIP() << "this system has no strict seccomp mode";
    EXPECT_EQ(verdict, Verdict::quiet) << "see Verdict";
    if (kSanitized) GTEST_SKIP() << "under a sanitizer only operator new was counted, system calls were not";
}

TEST_P(Quiet_step, makes_no_system_call_takes_no_lock_and_allocates_nothing) {
    expect_quiet([] {
        const auto subject = std::make_shared<Subject>(GetParam());
        return Steps{[subject](int i) { subject->step(i); }, [subject] { return subject->reached(); }};
    });
}

constexpr Case kCases[] = {
    {"bonded", ToolShape::plate, ToolContact::bonded},
    {"bonded_double", ToolShape::plate, ToolContact::bonded, Arithmetic::float64},
    {"bonded_mixed", ToolShape::plate, ToolContact::bonded, Arithmetic::mixed},
    {"coulomb_plate_mixed", ToolShape::plate, ToolContact::coulomb, Arithmetic::mixed},
    {"bonded_coupled", ToolShape::plate, ToolContact::bonded, Arithmetic::float32, 800},
    {"sphere", ToolShape::sphere, ToolContact::frictionless},
    {"sphere_double", ToolShape::sphere, ToolContact::frictionless, Arithmetic::float64},
    {"sphere_coupled", ToolShape::sphere, ToolContact::frictionless, Arithmetic::float32, 800},
    {"sticking_capsule", ToolShape::capsule, ToolContact::sticking},
    {"coulomb_capsule_coupled", ToolShape::capsule, ToolContact::coulomb, Arithmetic::float32, 800},
    {"coulomb_plate", ToolShape::plate, ToolContact::coulomb},
    {"coulomb_plate_double", ToolShape::plate, ToolContact::coulomb, Arithmetic::float64},
    {"coulomb_plate_coupled", ToolShape::plate, ToolContact::coulomb, Arithmetic::float32, 800},
    {"laplacian", ToolShape::plate, ToolContact::coulomb, Arithmetic::float32, 0, Preconditioner::laplacian},
    {"laplacian_double", ToolShape::plate, ToolContact::bonded, Arithmetic::float64, 0,
     Preconditioner::laplacian},
    {"sparse_inverse", ToolShape::plate, ToolContact::coulomb, Arithmetic::float32, 0,
     Preconditioner::sparse_inverse},
    {"sparse_inverse_double", ToolShape::sphere, ToolContact::sticking, Arithmetic::float64, 0,
     Preconditioner::sparse_inverse},
    {"nearly_incompressible", ToolShape::plate, ToolContact::coulomb, Arithmetic::float32, 0,
     Preconditioner::factor, 0.49},
    {"not_converging", ToolShape::plate, ToolContact::coulomb, Arithmetic::float32, 0,
     Preconditioner::sparse_inverse, 0.49, 2, kStepNotConverged},
};

INSTANTIATE_TEST_SUITE_P(each, Quiet_step, testing::ValuesIn(kCases),
                         [](const auto& c) { return std::string(c.param.name); });

/// The public classes of the application, as one: two tools on one object, read, stepped and drawn.
struct Application {
    static Asset with_two_tools() {
        Asset asset = cube_asset(4, ToolShape::plate, ToolContact::bonded);
        asset.tools.push_back(cube_asset(4, ToolShape::sphere, ToolContact::coulomb).tools[0]);
        asset.tools[1].name = "ball";
        for (std::size_t k = 0; k < 2; ++k)  // a half of the top each
            asset.tools[k].nodes = free_nodes(
                asset, [k](const Point& p) { return at_height(0.1)(p) && (p[0] < 0.05) == (k == 0); });
        asset.tools[1].rest_position_m[0] = 0.08;
        return asset;
    }

    Application() {
        SimulationConfig config;
        config.tools = {0, 1};
        both = std::make_unique<Simulation>(Simulation::create(asset, config).value());
        config.tools = {1};
        one = std::make_unique<Simulation>(Simulation::create(asset, config).value());
        PressScript script;
        script.start = one->tool_rest_pose();
        script.travel_m = {0, 0, -0.01};
        script.release_s = 0.5;
        script.rest_s = 0.9;
        device = std::make_unique<ScriptedDevice>(press_samples(script));
        loop = std::make_unique<HapticLoop>(HapticLoop::create(*device, *one).value());
        velocities.resize(3 * both->node_count());
    }

    void step(int i) {
        const Pose poses[] = {moved(asset, hand_move(i, 0.01), 0), moved(asset, hand_move(2 * i, 0.01), 1)};
        (void)both->step(poses, 1e-3);
        most_touched = std::max(most_touched, both->tool(1).touched_nodes);
        sum += both->positions_m()[0];
        both->velocities_m_per_s(velocities.data());
        force_n = std::max(force_n, loop->tick(1e-3).step.force_n[2]);
    }

    Asset asset = with_two_tools();
    std::unique_ptr<Simulation> both, one;
    std::unique_ptr<ScriptedDevice> device;
    std::unique_ptr<HapticLoop> loop;
    std::vector<double> velocities;
    std::uint32_t most_touched = 0;
    double sum = 0, force_n = 0;
};

TEST(Quiet_application, makes_no_system_call_takes_no_lock_and_allocates_nothing) {
    expect_quiet([] {
        const auto app = std::make_shared<Application>();
        return Steps{[app](int i) { app->step(i); },
                     [app] { return app->most_touched > 0 && app->force_n > 0.1; }};
    });
}

TEST(Watched_calls, see_those_of_the_runtime_library) {
    const WatchedCalls before = watched_calls();
    const Application app;
    EXPECT_GT((watched_calls() - before).allocations, 100);
}

}  // namespace
}  // namespace knead::test
