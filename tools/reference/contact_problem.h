// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "knead/formats/asset.h"
#include "reference/implicit_euler.h"

namespace knead::tools {

/// Where a tool is: its frame to the scene.
struct RigidPose {
    Point position_m{};
    std::array<double, 4> orientation_wxyz{1, 0, 0, 0};  ///< unit quaternion
};

/// How a node stands to a tool.
enum class TouchMode : std::uint8_t {
    apart,
    sticking,  ///< touches and did not slip in this step
    sliding,   ///< touches; without friction, or slipped in this step
    /// Behind the face of a plate but beyond its rectangle: left alone until it is in front again.
    beside
};

/// What one step hands to the next about one node and one tool.
struct NodeTouch {
    TouchMode mode = TouchMode::apart;
    Point anchor_m{};  ///< the point of the tool that it touches, in the tool's frame; else meaningless
};

/// Where a node that was apart is caught: this point, dropped onto the tool's surface, is its anchor.
enum class CatchPlace : std::uint8_t {
    /// Where its velocity alone carries it in the step (static: where it starts), seen from the tool at its
    /// pose now. Depends on nothing that the solver does.
    predicted,
    /// Where it was relative to the tool at the start of the step: needs ContactTool::pose_before.
    on_the_tool_before,
    /// Where the elastic solution leads it in which it is found to pass the surface, as the runtime does.
    solved_without_it
};

/// A rigid tool, its law of contact and what it may touch. Axes, sizes and laws as in ToolSet.
///
/// Invariants: nodes unique and < node count; a node held in all axes is skipped, one held in some is
/// refused; before empty (all apart) or as long as nodes; a bonded tool has all its nodes `sticking` in
/// `before`.
struct ContactTool {
    ToolShape shape = ToolShape::plate;  ///< plate: face along -z of the tool, object on that side
    ToolContact law = ToolContact::sticking;
    double radius_m = 0;                     ///< sphere and capsule, > 0
    double half_length_m = 0;                ///< capsule, >= 0: 0 is a sphere
    std::array<double, 2> half_extents_m{};  ///< plate; {0, 0}: unbounded
    double friction_coefficient = 0;         ///< coulomb, finite, >= 0
    RigidPose pose;                          ///< at the end of the step
    RigidPose pose_before;                   ///< at its start; used by CatchPlace::on_the_tool_before only
    CatchPlace catch_place = CatchPlace::predicted;
    std::vector<std::uint32_t> nodes;  ///< that it may touch
    std::vector<NodeTouch> before;     ///< [nodes] from the step before, or empty
};

/// The contact tool of an asset's or bake's tool set, before its first step: bonded nodes are anchored, and
/// those behind a plate but beside it marked, at the rest pose, where the tool is.
[[nodiscard]] ContactTool contact_tool(const ToolSet& set, const std::vector<Point>& rest_m);

/// What one tool feels.
struct ToolReaction {
    Point force_n{};     ///< of the object on the tool
    Point torque_n_m{};  ///< about the tool's origin, scene axes
    /// [nodes of the tool] what the next step needs in ContactTool::before.
    std::vector<NodeTouch> touches;
    std::vector<Point> forces_n;  ///< [nodes of the tool] of the object on the tool at each node
};

/// The conditions of contact (Karush, Kuhn, Tucker), taken anew from the final positions.
///
/// Forces come from the derivative of the energy there, not from the solver. Nothing is returned that breaks
/// them by more than the limits; here are the figures.
struct ContactCheck {
    double residual_n = 0;  ///< norm of the unbalanced forces, those against the law of friction included
    double residual_limit_n = 0;
    double force_scale_n = 0;   ///< norm of all reactions, or of the inertia where larger
    double deepest_m = 0;       ///< deepest penetration of any candidate, >= 0
    double widest_touch_m = 0;  ///< farthest that a touching node is off the surface or its anchor, >= 0
    double gap_limit_m = 0;
    double strongest_pull_n = 0;   ///< largest normal force that a unilateral tool pulls with, >= 0
    double cone_excess_n = 0;      ///< largest |tangential| - mu * normal, >= 0
    double slip_error_n = 0;       ///< largest distance of a friction force from mu * normal against the slip
    double complementarity_j = 0;  ///< largest |gap| * |normal force| of any candidate
};

/// A state in contact, and how it was found.
struct ContactSolution {
    MotionState state;
    std::vector<ToolReaction> tools;  ///< [tools given]
    /// [held nodes] force of the object on the holder, as in StaticSolution
    std::vector<Point> held_reactions_n;
    double energy_j = 0;  ///< elastic; in the linearised step its quadratic model, up to a constant
    ContactCheck check;
    int newton_iterations = 0;  ///< factorisations
    int law_iterations = 0;     ///< dense solves of the contact laws
    int law_fallbacks = 0;      ///< rounds of sweeps that Newton's method on the laws needed
    std::size_t touching = 0;   ///< nodes, of all tools
    std::size_t let_slide = 0;  ///< sticking nodes that slid without friction: see ContactProblem
};

/// When a solve in contact is good enough and when it is given up.
struct ContactLimits {
    double relative_residual =
        1e-10;                    ///< residual over force scale; rounding noise of the forces is the floor
    double relative_gap = 1e-10;  ///< gaps over the object's largest extent
    int max_iterations = 200;     ///< Newton's
    int max_catch_rounds = 100;   ///< rounds in one of them in which a further node is found to touch
};

/// The object of StaticProblem and ImplicitEuler under rigid tools that touch and leave: the exact oracle.
///
/// One step solves the implicit Euler equation with contact forces, to the limits given, together with the
/// conditions of contact at its end: no node inside a tool, no pulling, no force at a distance, and the law:
///   - sticking: the node stays at its anchor for as long as it would not have to be pulled along the normal
///     there. Such a law may have no solution (held, a node is pulled; let go, it goes inside): the nodes
///     concerned slide without friction in this step, are anchored anew, and are counted in let_slide
///   - frictionless: it stays on the surface; the force is along the normal at its final place
///   - coulomb: |t| <= mu n; where it slips, |t| = mu n against the tangential displacement of the step
///     relative to the tool, which for a touching node is counted from its anchor; tangents at the final
///     place
///   - bonded: it stays at its anchor
/// Newton's method on the exact second derivative with a line search; each iteration condenses the object to
/// the nodes in contact (direct solves) and solves the laws of all of them exactly. A node may touch one tool
/// at a time. Friction may have several solutions; one is found.
/// @thread-safety one thread at a time; different objects are independent
class ContactProblem {
  public:
    /// @throws ToolError(bad_input) as ImplicitEuler
    ContactProblem(const TetMesh& mesh, const Material& material, const BodyForces& forces = {});
    ContactProblem(ContactProblem&&) noexcept;
    ContactProblem& operator=(ContactProblem&&) noexcept;
    ~ContactProblem();

    [[nodiscard]] MotionState rest() const;

    /// Equilibrium (with gravity, if there is any) reached from `start_m` (empty: the rest state).
    /// Velocities of the result are zero.
    /// @throws ToolError(bad_input); ToolError(no_valid_result), with the figures, when the conditions cannot
    /// be
    ///     met within the limits or the object is not held
    [[nodiscard]] ContactSolution equilibrium(const PrescribedMotion& held,
                                              const std::vector<ContactTool>& tools,
                                              const std::vector<Point>& start_m = {},
                                              const ContactLimits& limits = {});

    /// One converged implicit Euler step.
    [[nodiscard]] ContactSolution step(const MotionState& from, const PrescribedMotion& held,
                                       const std::vector<ContactTool>& tools, double dt_s,
                                       const ContactLimits& limits = {});

    /// The step as the runtime poses it: elastic force and corotational stiffness R K0 R^T of one
    /// linearisation point, the tangent plane of a curved tool taken once (at its anchor for a node that
    /// stuck in the step before, at the linearisation point for one that slid, at the place where it is
    /// caught for a new one). Contact is exact for that problem; a node that is not touched keeps clear of
    /// the true surface.
    /// @param at_m [mesh nodes] the linearisation point. Empty, as the runtime: where velocities alone lead,
    ///     touching nodes too, and held nodes at their targets
    [[nodiscard]] ContactSolution linearised_step(const MotionState& from, const PrescribedMotion& held,
                                                  const std::vector<ContactTool>& tools, double dt_s,
                                                  const std::vector<Point>& at_m = {},
                                                  const ContactLimits& limits = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead::tools
