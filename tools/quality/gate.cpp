// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/gate.h"

#include <algorithm>

namespace knead::tools {

std::size_t QualityReport::warning_count() const {
    return static_cast<std::size_t>(
        std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.warning; }));
}

QualityReport examine(const Asset& asset) {
    QualityReport report;
    TetMesh mesh;
    mesh.nodes_m = asset.nodes_m;
    mesh.tetrahedra = asset.tetrahedra;
    report.mesh = measure(mesh);
    report.conditioning = condition_of(asset);
    report.step = predict_step(asset, report.conditioning);
    for (Findings found : {examine_units(asset, report.mesh), examine_shapes(asset, report.mesh),
                           examine_matter(asset, report.conditioning), examine_tools(asset, report.mesh),
                           examine_step(report.conditioning, report.step)})
        std::move(found.begin(), found.end(), std::back_inserter(report.findings));
    std::stable_sort(report.findings.begin(), report.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.warning && !b.warning; });
    return report;
}

}  // namespace knead::tools
