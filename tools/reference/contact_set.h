// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/contact_law.h"
#include "reference/tool_surface.h"

namespace knead::tools {

/// One node that one tool may touch.
struct Candidate {
    std::size_t tool = 0;
    std::size_t slot = 0;  ///< among the tool's nodes
    std::uint32_t node = 0;
    NodeLaw law;
    bool keeps_anchor = false;  ///< sticking and bonded: touching means being at the anchor
    bool stuck_before = false;  ///< it touched and did not slip in the step before
    bool ignored = false;       ///< beside the plate
    bool let_slide = false;     ///< sticking has no solution for it in this step
    bool known = false;         ///< among the nodes whose law is solved
    bool touching = false;
    bool slipping = false;
    Eigen::Vector3d anchor_m = Eigen::Vector3d::Zero();  ///< scene
    bool has_plane = false;
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< scene; normal and two tangents
    Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();     ///< scene; on the tangent plane
    Eigen::Vector3d force_n = Eigen::Vector3d::Zero();    ///< scene; of the tool on the node, as last solved
};

/// All candidates of all tools: who touches, where, and how far everything is from where it must be.
class ContactSet {
  public:
    /// @param is_prescribed [3 nodes]
    /// @param start_m [3 nodes] positions at the start of the step
    /// @param predicted_m [3 nodes] where velocity alone leads
    /// @param planes_stay tangent planes are taken once instead of at each call of take_planes()
    /// @throws ToolError(bad_input) when a tool breaks an invariant of its type
    ContactSet(const std::vector<ContactTool>& tools, const std::vector<bool>& is_prescribed,
               Eigen::VectorXd start_m, Eigen::VectorXd predicted_m, bool planes_stay);

    [[nodiscard]] std::vector<Candidate>& candidates() { return candidates_; }
    [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }
    [[nodiscard]] const std::vector<ToolSurface>& surfaces() const { return surfaces_; }

    /// Takes the tangent planes of the known candidates at these positions.
    void take_planes(const Eigen::VectorXd& positions_m);
    /// Makes known every candidate that is inside its tool; sets aside what slid off a plate's edge.
    /// @return whether anything changed
    /// @throws ToolError(no_valid_result) for a node that touches two tools
    bool find_new(const Eigen::VectorXd& positions_m, double tolerance_m);
    /// Puts touching nodes exactly where they belong: at their anchors or on the surface.
    void put_on_surface(Eigen::VectorXd& positions_m) const;
    /// How far a candidate is from where it must be: off its anchor, or inside its tool.
    [[nodiscard]] double violation_m(const Candidate& candidate, const Eigen::VectorXd& positions_m) const;
    /// Distance from the true surface; negative inside.
    [[nodiscard]] double gap_m(const Candidate& candidate, const Eigen::VectorXd& positions_m) const;
    /// What the step hands on about a candidate.
    [[nodiscard]] NodeTouch touch(const Candidate& candidate, const Eigen::VectorXd& positions_m) const;

  private:
    void add_tool(const ContactTool& tool, const std::vector<bool>& is_prescribed);
    void take_plane(Candidate& candidate, const Eigen::Vector3d& place_m) const;
    void catch_node(Candidate& candidate, const Eigen::Vector3d& place_m);
    void refuse_second_tool(const Candidate& candidate) const;

    Eigen::VectorXd start_, predicted_;
    bool planes_stay_;
    std::vector<ToolSurface> surfaces_, surfaces_before_;
    std::vector<CatchPlace> catch_places_;
    std::vector<Candidate> candidates_;
};

}  // namespace knead::tools
