// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stability/run.h"
#include "stability/stability.h"

namespace knead::tools::stability {

/// Which of the checks a run is made for; the bounds are in criteria.h.
struct Demands {
    std::string about = "step_force";  ///< the check that the cell is about: named first
    bool forces = true;                ///< against the reference's steps
    bool force_at_rest = true;         ///< against the reference's equilibrium
    bool energy = true;                ///< bounded, passive, no drift
    bool recovery = true;
    bool contact_law = false;  ///< unilateral tools: no pull, friction in its cone, nothing inside, no force
                               ///< after the tool has left
    bool soak = false;
};

/// Every number of a run against its bound. Depends on nothing else.
[[nodiscard]] std::vector<Check> judge(const Record& record, const Demands& demands, double size_m);

/// A number that must be at most `bound`; above it `above`.
[[nodiscard]] Check at_most(const std::string& name, double value, double bound, const std::string& unit,
                            CellStatus above = CellStatus::fail, Warning warning = Warning::none);
/// Something that is so or is not.
[[nodiscard]] Check must_be(const std::string& name, bool is_so, const std::string& note);

}  // namespace knead::tools::stability
