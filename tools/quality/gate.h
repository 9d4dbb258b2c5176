// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "knead/formats/asset.h"
#include "quality/conditioning.h"
#include "quality/finding.h"
#include "quality/mesh_quality.h"
#include "quality/step_time.h"

namespace knead::tools {

/// What can be told of an asset before it is touched.
struct QualityReport {
    MeshQuality mesh;  ///< of the asset's tetrahedra: their positions are those in the asset
    Conditioning conditioning;
    StepPrediction step;
    Findings findings;  ///< warnings first

    [[nodiscard]] std::size_t warning_count() const;
};

/// Looks at an asset and says what its maker should know; changes nothing. Time n log n in the tetrahedra.
/// Precondition: validate(asset).ok() and a free node. docs/quality.md has every finding, its threshold and
/// the reason for it.
[[nodiscard]] QualityReport examine(const Asset& asset);

// The parts of it, each for one kind of mistake.
[[nodiscard]] Findings examine_shapes(const Asset& asset, const MeshQuality& mesh);
[[nodiscard]] Findings examine_units(const Asset& asset, const MeshQuality& mesh);
[[nodiscard]] Findings examine_matter(const Asset& asset, const Conditioning& conditioning);
[[nodiscard]] Findings examine_tools(const Asset& asset, const MeshQuality& mesh);
[[nodiscard]] Findings examine_step(const Conditioning& conditioning, const StepPrediction& step);

}  // namespace knead::tools
