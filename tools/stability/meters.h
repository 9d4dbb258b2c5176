// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "knead/runtime/config.h"
#include "knead/runtime/step_result.h"
#include "reference/elastic_body.h"
#include "stability/specimen.h"
#include "stability/truth.h"

namespace knead::tools::stability {

/// What the hand has put in and what the object holds. Work is the force at the end of a step times the
/// motion of the hand in it; energy is elastic, kinetic, of gravity and, with a coupling, of its spring and
/// the tool's mass, taken anew in double precision by the reference's element.
class EnergyMeter {
  public:
    EnergyMeter(const Specimen& specimen, const SimulationConfig& config);

    void work(const std::vector<Pose>& from, const std::vector<Pose>& to,
              const std::vector<ToolResult>& results, double dt_s);
    [[nodiscard]] double energy_j(const Snapshot& at, const std::vector<Pose>& hands,
                                  const std::vector<ToolResult>& results) const;
    [[nodiscard]] double net_work_j() const { return net_work_j_; }
    [[nodiscard]] double positive_work_j() const { return positive_work_j_; }
    /// Kinetic energy of the velocity error that a step may make (criteria.h).
    [[nodiscard]] double slack_j() const;

  private:
    const Specimen& specimen_;
    ElasticBody body_;
    double total_mass_kg_, stiffness_n_per_m_, tool_mass_kg_;
    double potential_at_rest_j_;
    double net_work_j_ = 0, positive_work_j_ = 0;
    double kinetic_of_tools_j_ = 0;
    std::vector<Eigen::Vector3d> tools_before_m_;
};

/// Whether unilateral tools only push, keep in the cone of friction and keep nodes out.
class ContactMeter {
  public:
    explicit ContactMeter(const Specimen& specimen) : specimen_(specimen) {}

    struct Law {
        double pull_n = 0, cone_excess_n = 0;
    };
    /// Pull: along a plate's normal, or upwards for balls and capsules, which come from above. A curved tool
    /// that sticks may pull (docs/reference.md) and is left out. The cone: of plates.
    [[nodiscard]] Law law(std::size_t tool, const Pose& pose, const ToolResult& result) const;
    [[nodiscard]] double deepest_m(const Snapshot& at) const;

  private:
    const Specimen& specimen_;
};

/// Root mean square distance of the nodes from their rest places, over the size.
[[nodiscard]] double off_rest(const Specimen& specimen, const Snapshot& at);

}  // namespace knead::tools::stability
