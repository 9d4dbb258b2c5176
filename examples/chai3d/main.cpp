// SPDX-License-Identifier: Apache-2.0
// chai3d_touch ASSET: touch an asset with the first device that CHAI3D finds, until Enter is pressed.
#include <cstdio>

#include "knead/haptics/haptic_loop.h"
#include "knead/runtime/simulation.h"
#include "knead_chai3d_device.h"

namespace {

int fail(const knead::Error& error) {
    std::fprintf(stderr, "chai3d_touch: error: %s\n", error.text().c_str());
    return 3;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "Usage: chai3d_touch ASSET\n");
        return 2;
    }
    chai3d::cHapticDeviceHandler handler;
    chai3d::cGenericHapticDevicePtr chai_device;
    if (!handler.getDevice(chai_device, 0) || !chai_device->open()) {
        std::fprintf(stderr, "chai3d_touch: error: no device, or it does not open\n");
        return 3;
    }
    chai_device->calibrate();

    knead::HapticConfig config = knead_examples::config_for(chai_device->getSpecifications());
    auto simulation = knead::Simulation::load(argv[1], simulation_config(config));
    if (!simulation) return fail(simulation.error());
    // The middle of the device's workspace is where the tool waits.
    config.workspace.offset_m = simulation.value().tool_rest_pose().position_m;

    knead_examples::Chai3dDevice device(chai_device);
    auto loop = knead::HapticLoop::create(device, simulation.value(), config);
    if (!loop) return fail(loop.error());
    if (const knead::Status started = loop.value().start(); !started) return fail(started.error());
    std::printf("Touch it. Enter ends.\n");
    std::getchar();
    loop.value().stop();
    chai_device->close();
    const knead::RunStatistics run = loop.value().statistics();
    std::printf("%.0f Hz, %llu of %llu periods late\n", run.rate_hz,
                static_cast<unsigned long long>(run.misses), static_cast<unsigned long long>(run.ticks));
    return 0;
}
