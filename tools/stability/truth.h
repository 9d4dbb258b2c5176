// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "knead/runtime/pose.h"
#include "reference/contact_problem.h"
#include "reference/elastic_body.h"
#include "stability/specimen.h"

namespace knead::tools::stability {

/// The runtime's state between two steps, as it hands it out.
struct Snapshot {
    MotionState state;
    std::vector<Pose> tools;           ///< where the tools are
    std::vector<std::size_t> touched;  ///< [tools] nodes that each holds
};

/// Forces that the reference finds for what the runtime was asked.
class Truth {
  public:
    explicit Truth(const Specimen& specimen);

    enum class Step {
        linearised,  ///< the problem that a step of the runtime poses: solver against solver
        converged    ///< the nonlinear step: what one linearisation leaves out as well
    };
    struct Forces {
        std::vector<Eigen::Vector3d> force_n;  ///< [tools]
        std::vector<std::size_t> touched;      ///< [tools]
    };
    /// One step from `from` with the tools at `to`; what a unilateral tool held before is seen from the
    /// geometry of `from`.
    /// @throws ToolError(no_valid_result)
    /// @param before the state a step earlier: tells which nodes slid under Coulomb friction
    /// @param residual unbalanced force over the reactions that the reference leaves
    [[nodiscard]] Forces step(const Snapshot& from, const std::vector<Pose>& to, double dt_s, Step kind,
                              double residual = kResidual, const Snapshot* before = nullptr);

    struct AtRest {
        std::vector<Eigen::Vector3d> force_n;  ///< [tools]
        double unbalanced_n = 0;               ///< with the forces of the place itself
        std::string refused;                   ///< what the reference said when it found no equilibrium
    };
    /// The force on each tool of the equilibrium in which everything that touches a tool stays where it is,
    /// searched from where the object is. A crushed body has several equilibria: where the one found is
    /// another than that which the object is in (kSamePlace), the forces of the very place, and how far they
    /// are from balance. Without gravity.
    [[nodiscard]] AtRest at_rest(const Snapshot& at);
    static constexpr double kSamePlace = 1e-3;  ///< farthest that a node may go, over the size

    /// Far below the errors of 1e-3 that are looked for.
    static constexpr double kResidual = 1e-8;
    /// Of a force that is far smaller than the others of its run: rounding is larger than kResidual there.
    static constexpr double kResidualOfSmall = 1e-3;

  private:
    struct NodeAt {
        std::uint32_t slot;  // among the tool's nodes
        double gap_m;
    };
    [[nodiscard]] ContactTool tool_at(std::size_t k, const Snapshot& from, const Snapshot* before,
                                      const Pose& to) const;
    [[nodiscard]] bool slid(std::size_t k, std::uint32_t node, const Snapshot& before,
                            const Snapshot& now) const;
    [[nodiscard]] std::vector<NodeAt> touching(std::size_t k, const Snapshot& at) const;
    [[nodiscard]] PrescribedMotion with_bonded(const std::vector<Pose>& poses) const;

    [[nodiscard]] MotionState exactly_bonded(const Snapshot& at) const;
    [[nodiscard]] std::optional<StaticSolution> equilibrium_near(const PrescribedMotion& held,
                                                                 const Snapshot& at, std::string& refused);

    const Specimen& specimen_;
    ContactProblem problem_;
    StaticProblem static_;
    ElasticBody body_;
};

/// A point in a tool's frame.
[[nodiscard]] Eigen::Vector3d to_local(const Pose& pose, const Point& scene_m);

}  // namespace knead::tools::stability
