// SPDX-License-Identifier: Apache-2.0
// Built together with the core's sources without exceptions and RTTI: links and steps, or this program fails.
#include <cstdio>

#include "core/step.h"

int main() {
    knead::Asset asset;
    asset.nodes_m = {{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    asset.free_node_count = 1;
    asset.tetrahedra = {{1, 2, 3, 0}};
    asset.palette = {{1e4, 0.3, 1000}};
    asset.palette_index = {0};
    knead::ToolSet tool;
    tool.name = "tip";
    tool.rest_position_m = {0, 0, 1};
    tool.nodes = {0};
    asset.tools = {tool};
    const std::unique_ptr<knead::core::Stepper> stepper = knead::core::make_stepper(asset, {});
    knead::Pose pose;
    pose.position_m = {0, 0, 0.9};
    const knead::StepResult result = stepper->step(&pose, 1e-3);
    const bool good = result.status == knead::kStepOk && result.force_n[2] > 0;
    std::printf("%s: %g N\n", good ? "ok" : "FAILED", result.force_n[2]);
    return good ? 0 : 1;
}
