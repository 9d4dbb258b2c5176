// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/node_reader.h"
#include "core/tool_surface.h"
#include "knead/runtime/local_model.h"

namespace knead::core {

/// Three translations and three rotations. Rows and columns of rotations are zero where nobody asked.
using Vec6 = std::array<Real, 6>;
using Gram = std::array<Vec6, 6>;

/// A node in a tool's hold, at the end of a step. Vectors in scene axes.
struct HeldPart {
    std::uint32_t node = 0;
    Mat held = Mat::Identity();  ///< projector, as in Constraint
    Vec arm_m = Vec::Zero();     ///< from the tool's origin
    Vec outward = Vec::Zero();   ///< unit normal of the tool there; zero if the node is bonded
    Vec force_n = Vec::Zero();   ///< of the object on the tool, without inertia and damping
    /// How the force falls with the tool's translation, a column for each axis, N/m.
    Mat rate = Mat::Zero();
};

/// How the object answers to one tool's motion.
struct Impedance {
    Gram stiffness{}, damping{}, mass{};
    bool converged = true;
    std::uint32_t iterations = 0;
};

/// Products of shapes with each other, twice their energies: with K and with M.
struct Energies {
    Gram elastic{}, mass{};
};

/// Stiffness, damping and mass from the shapes at rest and those of motions that grow as exp(t / time_s).
/// @param damping_per_s of the object, mass-proportional
void fit(const Gram& at_rest, const Energies& fitted, Real time_s, Real damping_per_s,
         Impedance& out) noexcept;

/// The nearest positive semidefinite matrix below a symmetric one that misses being so by rounding: its
/// Cholesky factorisation with pivots, ended where what is left is not positive.
void make_semidefinite(Gram& matrix) noexcept;

/// Origin and matrices.
[[nodiscard]] LocalModel view_of(const Frame& tool, const Impedance& impedance) noexcept;

/// What one tool may touch, for how far a linear view is fair. Allocates in the constructor only.
class ToolReach {
  public:
    /// @param tool valid, nodes numbered as in the model and ascending  @param mean_edge_m of the mesh
    ToolReach(const ToolSet& tool, Real mean_edge_m);

    [[nodiscard]] bool unilateral() const noexcept { return unilateral_; }
    /// Unit, scene axes.
    [[nodiscard]] Vec outward(const Frame& tool, const Vec& place) const noexcept;

    /// Load, normal and radius of the view.
    /// @param held all of the tool's, those not bonded ascending by node  @param tool where it is
    void describe(const Frame& tool, const std::vector<HeldPart>& held, const NodeReader& positions,
                  LocalModel& out) noexcept;

  private:
    void find_load(const std::vector<HeldPart>& held, LocalModel& out) const noexcept;
    [[nodiscard]] Vec normal(const std::vector<HeldPart>& held, const Vec& load_n) const noexcept;
    [[nodiscard]] Real radius(const Frame& tool, const std::vector<HeldPart>& held, const Vec& normal,
                              const NodeReader& positions) noexcept;

    ToolSurface surface_;
    bool unilateral_;
    Real mean_edge_m_;
    std::vector<std::uint32_t> nodes_;  ///< ascending; none if bonded
    std::vector<Real> events_m_;        ///< how far the tool goes until a node is caught or let go
};

}  // namespace knead::core
