// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/build_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "quality/report_text.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const GatedAsset& asset) {
    Json json{{"level", asset.asset->level},
              {"file", asset.asset->file.string()},
              {"warnings", asset.warning_count()},
              {"quality", to_json(asset.report)},
              {"presses", Json::array()}};
    for (const PressComparison& press : asset.presses) {
        Json entry{{"tool", press.tool}, {"linear_estimate", true}};
        if (press.problem.empty()) {
            entry["force_error"] = press.force_error;
            if (press.mesh_error) entry["elasticity_error"] = *press.elasticity_error;
            if (press.mesh_error) entry["mesh_error"] = *press.mesh_error;
        } else {
            entry["problem"] = press.problem;
        }
        json["presses"].push_back(std::move(entry));
    }
    json["findings"] = to_json(asset.findings);
    return json;
}

}  // namespace

std::string summary(const std::string& name, const GatedAsset& asset) {
    const StepPrediction& step = asset.report.step;
    const std::size_t warnings = asset.warning_count();
    return fmt::format(
        "{}: radius ratio {:.2g} at least, a step of 1 ms probably {:.0f} us ({:.0f} to {:.0f}), {} {}", name,
        asset.report.mesh.min_radius_ratio, step.time_us, step.low_us, step.high_us,
        warnings == 0 ? "no" : std::to_string(warnings), warnings == 1 ? "warning" : "warnings");
}

std::string build_report(const BuildResult& result, const std::vector<GatedAsset>& gated) {
    Json json;
    json["schema"] = "knead-build-report/1";
    for (const StageOutcome& outcome : result.outcomes)
        json["stages"].push_back({{"tool", outcome.stage->tool},
                                  {"output", outcome.stage->output.string()},
                                  {"made", outcome.made},
                                  {"seconds", outcome.seconds}});
    json["assets"] = Json::array();
    for (const GatedAsset& asset : gated)
        json["assets"].push_back(json_of(asset));
    return json.dump(2) + "\n";
}

}  // namespace knead::tools
