// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/runtime/pose.h"

namespace knead {

/// What happened in a step; bits, so that several can be told at once. Zero is a good step.
enum StepStatus : std::uint32_t {
    kStepOk = 0,
    kStepNotConverged = 1u << 0,  ///< the solver stopped at its cap; the force is its best estimate
    kStepNotFinite = 1u << 1,     ///< the state would not be finite: force zero, last good state kept
    kStepBadInput = 1u << 2,      ///< pose or dt not finite or out of range, or a bonded tool farther from
                                  ///< its rest pose than 1e4 times the object: force zero, state kept
    kStepContactCap = 1u << 3,    ///< the set of touched nodes had not settled at its cap
    kStepInsideOut = 1u << 4,     ///< the step went through a state with tetrahedra turned inside out: the
                                  ///< force is the model's, but matter cannot be there, and there may be no
                                  ///< rest
};

/// Whether the force is the solution of the step, of matter that may be inside out.
constexpr bool is_solved(std::uint32_t status) noexcept {
    return (status & ~std::uint32_t{kStepInsideOut}) == kStepOk;
}

/// What one step yields for one tool.
struct ToolResult {
    /// On the hand: what the object (or, with a coupling, the coupling) exerts. Newtons, scene frame.
    /// Without a coupling it includes the inertia of the nodes that the tool holds, as a hand would feel it.
    Vec3 force_n{};
    Vec3 torque_nm{};  ///< of the object, about the tool's origin, scene frame; zero unless asked for
    std::uint32_t touched_nodes = 0;  ///< held by the tool at the end of the step
    Vec3 tool_position_m{};           ///< where the tool is; the given position unless coupled
};

/// What one step yields, with the result of its first tool.
struct StepResult : ToolResult {
    std::uint32_t status = kStepOk;       ///< StepStatus bits
    std::uint32_t solver_iterations = 0;  ///< of the conjugate gradients, all contact passes together
};

}  // namespace knead
