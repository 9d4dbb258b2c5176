// SPDX-License-Identifier: Apache-2.0
// Presses a finger 2 mm deep beside the lump and over it: the force tells where it is.
#include <cstdio>

#include "knead/runtime/simulation.h"

namespace {

/// Force up on the finger after one second at this place.
double press_at(knead::Simulation& pad, double x_m, double y_m) {
    constexpr double kDepthM = 2e-3;
    constexpr double kStepS = 1e-3;
    pad.reset();
    knead::Pose finger = pad.tool_rest_pose();  // just touching the top
    const double top_z_m = finger.position_m[2];
    knead::StepResult step;
    for (int i = 1; i <= 1000; ++i) {
        finger.position_m = {x_m, y_m, top_z_m - kDepthM * i / 1000.0};
        step = pad.step(finger, kStepS);
        if (step.status != knead::kStepOk) std::printf("step %d: status %u\n", i, step.status);
    }
    return step.force_n[2];
}

}  // namespace

int main(int argc, char** argv) {
    auto pad = knead::Simulation::load(argc > 1 ? argv[1] : "lump.hdf");
    if (!pad.ok()) {
        std::fprintf(stderr, "find_lump: %s\n", pad.error().text().c_str());
        return 1;
    }
    const double beside_n = press_at(pad.value(), 0.055, 0.04);
    const double over_n = press_at(pad.value(), 0.025, 0.04);
    std::printf("beside the lump %.3f N, over it %.3f N\n", beside_n, over_n);
    return over_n > beside_n ? 0 : 1;
}
