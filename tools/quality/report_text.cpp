// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/report_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMeasure = "radius ratio: 3 x inscribed / circumscribed radius, 1 is best";

Json json_of(const WorstTetrahedron& worst) {
    return {{"tetrahedron", worst.tetrahedron},
            {"middle_m", worst.middle_m},
            {"radius_ratio", worst.shape.radius_ratio},
            {"mean_ratio", worst.shape.mean_ratio},
            {"dihedral_deg", {worst.shape.min_dihedral_deg, worst.shape.max_dihedral_deg}},
            {"thinness", worst.shape.thinness}};
}

Json json_of(const Conditioning& conditioning) {
    return {{"contrast", conditioning.numerics.contrast},
            {"press_contrast", conditioning.numerics.press_contrast},
            {"max_poissons_ratio", conditioning.numerics.max_poissons_ratio},
            {"node_stiffness_spread", conditioning.node_stiffness_spread},
            {"stiffness_over_mass_per_s2", conditioning.stiffness_over_mass_per_s2},
            {"fastest_crossing_s", conditioning.fastest_crossing_s}};
}

Json json_of(const StepPrediction& step, const Conditioning& conditioning) {
    return {{"prediction", true},
            {"machine", kCalibrationMachine},
            {"dt_s", kPredictedDt_s},
            {"time_us", step.time_us},
            {"low_us", step.low_us},
            {"high_us", step.high_us},
            {"calibrated", step.calibrated},
            {"arithmetic", to_string(conditioning.numerics.arithmetic)},
            {"preconditioner", to_string(step.preconditioner)},
            {"iterations", step.iterations},
            {"max_iterations", step.max_iterations}};
}

}  // namespace

std::vector<std::string> to_lines(const QualityReport& report) {
    const MeshQuality& mesh = report.mesh;
    const Conditioning& conditioning = report.conditioning;
    const StepPrediction& step = report.step;
    std::vector<std::string> lines{
        fmt::format("{}: {:.3f} at least, {:.3f} on average", kMeasure, mesh.min_radius_ratio,
                    mesh.mean_radius_ratio),
        fmt::format("  tetrahedra by tenths of it, worst first: {}",
                    fmt::join(mesh.radius_ratio_histogram, " ")),
        fmt::format(
            "dihedral angles {:.1f} to {:.1f} degrees; tetrahedra by their sharpest, in tens of degrees: "
            "{}",
            mesh.min_dihedral_deg, mesh.max_dihedral_deg, fmt::join(mesh.min_dihedral_histogram, " "))};
    for (const WorstTetrahedron& worst : mesh.worst)
        lines.push_back(fmt::format(
            "  tetrahedron {} at ({:.4g}, {:.4g}, {:.4g}) m: radius ratio {:.3f}, {:.1f} to "
            "{:.1f} degrees",
            worst.tetrahedron, worst.middle_m[0], worst.middle_m[1], worst.middle_m[2],
            worst.shape.radius_ratio, worst.shape.min_dihedral_deg, worst.shape.max_dihedral_deg));
    lines.push_back(
        fmt::format("conditioning: contrast {:.3g}, press contrast {:.3g}, stiffest node {:.3g} times the "
                    "softest, dt^2 stiffness / mass {:.2g} at 1 ms",
                    conditioning.numerics.contrast, conditioning.numerics.press_contrast,
                    conditioning.node_stiffness_spread,
                    kPredictedDt_s * kPredictedDt_s * conditioning.stiffness_over_mass_per_s2));
    lines.push_back(
        fmt::format("predicted, not measured: {:.0f} us for a step of 1 ms ({:.0f} to {:.0f}{}), {}, {}, "
                    "{} to {} iterations, on {}",
                    step.time_us, step.low_us, step.high_us,
                    step.calibrated ? "" : "; a guess, nothing like it was measured",
                    to_string(conditioning.numerics.arithmetic), to_string(step.preconditioner),
                    step.iterations, step.max_iterations, kCalibrationMachine));
    return lines;
}

std::string to_text(const Finding& finding) {
    return fmt::format("[{}] {}; {}", finding.id, finding.text, finding.advice);
}

Json to_json(const MeshQuality& quality) {
    Json json{
        {"measure", kMeasure},
        {"radius_ratio",
         {{"min", quality.min_radius_ratio},
          {"mean", quality.mean_radius_ratio},
          {"histogram", quality.radius_ratio_histogram}}},
        {"mean_ratio", {{"min", quality.min_mean_ratio}, {"mean", quality.mean_mean_ratio}}},
        {"dihedral_deg",
         {{"min", quality.min_dihedral_deg},
          {"max", quality.max_dihedral_deg},
          {"sharpest_histogram", quality.min_dihedral_histogram}}},
        {"edge_m",
         {{"min", quality.shortest_edge_m}, {"mean", quality.mean_edge_m}, {"max", quality.longest_edge_m}}},
        {"slivers", quality.slivers.size()},
        {"nearly_inverted", quality.near_inverted.size()},
        {"worst", Json::array()}};
    for (const WorstTetrahedron& worst : quality.worst)
        json["worst"].push_back(json_of(worst));
    return json;
}

Json to_json(const Findings& findings) {
    Json json = Json::array();
    for (const Finding& finding : findings)
        json.push_back({{"id", finding.id},
                        {"warning", finding.warning},
                        {"number", finding.number},
                        {"unit", finding.unit},
                        {"text", finding.text},
                        {"advice", finding.advice}});
    return json;
}

Json to_json(const QualityReport& report) {
    return {{"mesh", to_json(report.mesh)},
            {"conditioning", json_of(report.conditioning)},
            {"step", json_of(report.step, report.conditioning)},
            {"warnings", report.warning_count()},
            {"findings", to_json(report.findings)}};
}

}  // namespace knead::tools
