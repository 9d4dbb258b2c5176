// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "knead/formats/asset.h"
#include "quality/finding.h"

namespace knead::tools {

/// A force that a hand tells from another (Weber fraction): evaluation.h has the same number.
inline constexpr double kLevelForceError = 0.1;

/// How a level answers one tool, against the fine object: a linear estimate, for small displacements.
struct PressComparison {
    std::string tool;
    std::string problem;     ///< why there is nothing to say, or empty
    double force_error = 0;  ///< force of the level over that of the fine object, less 1
    /// Only where the force errs by more than kLevelForceError: the same with one elasticity everywhere (what
    /// the coarser mesh does), and what is left: (1 + force_error) / (1 + mesh_error) - 1.
    std::optional<double> mesh_error, elasticity_error;
};

/// Presses levels and the fine object with each tool by a tenth of the object along press_direction(), and
/// compares the forces.
///
/// Nodes of a bonded tool all follow; of another tool those that its surface would reach, each to that
/// surface, without sliding (a frictionless tool along a coordinate axis: free to slide). One linear solve of
/// each object with tools/reference, one more where the force errs; the fine object's are kept. What turns or
/// is crushed when a hand presses is not in it.
class LevelCheck {
  public:
    explicit LevelCheck(Asset fine) : fine_(std::move(fine)), forces_n_(fine_.tools.size()) {}

    /// @param level baked from the same scene as the fine asset
    [[nodiscard]] std::vector<PressComparison> compare(const Asset& level);
    [[nodiscard]] const Asset& fine() const { return fine_; }

  private:
    struct Forces {
        std::optional<double> as_it_is, uniform;
    };
    [[nodiscard]] PressComparison compare(const Asset& level, std::size_t tool);

    Asset fine_;
    std::vector<Forces> forces_n_;  // [tools]
};

/// Warnings for what errs by more than kLevelForceError; what could not be compared as information.
[[nodiscard]] Findings findings_of(const std::vector<PressComparison>& comparisons, const Asset& fine,
                                   const std::string& level);

}  // namespace knead::tools
