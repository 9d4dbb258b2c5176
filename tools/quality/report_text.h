// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "quality/gate.h"

namespace knead::tools {

/// Histograms, worst tetrahedra, conditioning and prediction, a line each.
[[nodiscard]] std::vector<std::string> to_lines(const QualityReport& report);

/// "[sliver] 3 of 48 tetrahedra ...; mesh anew with another edge length"
[[nodiscard]] std::string to_text(const Finding& finding);

/// For --report: {measure, mesh, conditioning, step, warnings, findings}, docs/quality.md.
[[nodiscard]] nlohmann::ordered_json to_json(const QualityReport& report);
/// The part of it that is known of a mesh alone.
[[nodiscard]] nlohmann::ordered_json to_json(const MeshQuality& quality);
[[nodiscard]] nlohmann::ordered_json to_json(const Findings& findings);

}  // namespace knead::tools
