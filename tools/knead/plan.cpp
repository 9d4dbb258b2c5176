// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/plan.h"

#include <fmt/format.h>

#include <algorithm>

namespace knead::tools {
namespace {

using Arguments = std::vector<std::string>;

/// Shortest text that reads back as the same double.
std::string text_of(double value) {
    return fmt::format("{}", value);
}

void append_number(Arguments& arguments, const char* option, double value) {
    if (value != 0) arguments.insert(arguments.end(), {option, text_of(value)});
}

Arguments mesh_arguments(const MeshSource& mesh) {
    Arguments arguments{mesh.kind == "file" ? "import" : mesh.kind};
    if (mesh.kind == "file") arguments.push_back(mesh.file.string());
    if (mesh.kind == "outline") arguments.insert(arguments.end(), {"--points", mesh.file.string()});
    if (!mesh.divisions.empty()) {
        arguments.emplace_back("--divisions");
        for (const std::uint32_t n : mesh.divisions)
            arguments.push_back(std::to_string(n));
    }
    if (!mesh.size_m.empty()) {
        arguments.emplace_back(mesh.kind == "ellipsoid" ? "--radii" : "--size");
        for (const double length : mesh.size_m)
            arguments.push_back(text_of(length));
    }
    append_number(arguments, "--radius", mesh.radius_m);
    append_number(arguments, "--height", mesh.height_m);
    append_number(arguments, "--thickness", mesh.thickness_m);
    append_number(arguments, "--round", mesh.round_m);
    append_number(arguments, "--edge-length", mesh.edge_length_m);
    if (mesh.polygon) arguments.emplace_back("--polygon");
    if (mesh.merge_duplicate_nodes) arguments.emplace_back("--merge-duplicate-nodes");
    if (mesh.repair_orientation) arguments.emplace_back("--repair-orientation");
    if (!mesh.length_unit.empty()) arguments.insert(arguments.end(), {"--length-unit", mesh.length_unit});
    if (mesh.target_tetrahedra > 0)
        arguments.insert(arguments.end(), {"--target-tetrahedra", std::to_string(mesh.target_tetrahedra)});
    return arguments;
}

Arguments material_arguments(const MaterialSource& material) {
    Arguments arguments;
    const auto add = [&](const char* option, const std::string& value) {
        arguments.insert(arguments.end(), {option, value});
    };
    if (material.uniform_pa) add("--uniform", text_of(*material.uniform_pa));
    if (material.scenario) {
        add("--scenario", std::to_string(*material.scenario));
        add("--seed", std::to_string(material.seed));
    }
    if (material.expression_pa) add("--expression", *material.expression_pa);
    if (!material.csv.empty()) add("--csv", material.csv.string());
    if (material.from_mesh) arguments.emplace_back("--from-mesh");
    for (const auto& [name, region] : material.regions)
        add("--region", fmt::format("{}={},{},{}", name, region.youngs_modulus_pa, region.poissons_ratio,
                                    region.density_kg_per_m3));
    if (material.poissons_ratio) add("--poissons-ratio", text_of(*material.poissons_ratio));
    if (material.density_kg_per_m3) add("--density", text_of(*material.density_kg_per_m3));
    if (material.total_mass_kg) add("--total-mass", text_of(*material.total_mass_kg));
    return arguments;
}

/// Collects stages; knows the folder and the scene's name.
class Planner {
  public:
    Planner(const Scene& scene, const std::filesystem::path& folder) : scene_(scene), folder_(folder) {}

    Plan plan(const std::vector<std::string>& levels) {
        const auto mesh = add("knead-mesh", mesh_arguments(scene_.mesh), "mesh");
        const auto material =
            add("knead-material", with_input(mesh, material_arguments(scene_.material)), "material");
        plan_.fine_object = material;
        for (const Level& level : scene_.levels)
            if (levels.empty() || std::find(levels.begin(), levels.end(), level.name) != levels.end())
                plan_level(level, mesh, material);
        return std::move(plan_);
    }

  private:
    static Arguments with_input(const std::filesystem::path& input, Arguments arguments) {
        arguments.insert(arguments.begin(), input.string());
        return arguments;
    }

    std::filesystem::path add(const std::string& tool, Arguments arguments, const std::string& stage,
                              bool threaded = false) {
        const auto output = folder_ / fmt::format("{}.{}.hdf", scene_.name, stage);
        arguments.insert(arguments.end(), {"-o", output.string()});
        plan_.stages.push_back({tool, std::move(arguments), output, threaded});
        return output;
    }

    void plan_level(const Level& level, const std::filesystem::path& fine_mesh,
                    std::filesystem::path object) {
        if (!level.object.empty()) object = level.object;
        if (level.bins > 0) object = simplify(level, object);
        if (level.mesh) object = coarsen(level, fine_mesh, object);
        const auto asset =
            add("knead-bake", {scene_.file.string(), object.string(), "--level", level.name}, level.name);
        plan_.assets.push_back({level.name, asset, object});
    }

    std::filesystem::path simplify(const Level& level, const std::filesystem::path& object) {
        const auto clusters = add("knead-cluster",
                                  {object.string(), "--bins", std::to_string(level.bins), "--clusters",
                                   std::to_string(level.clusters), "--binning", level.binning, "--restarts",
                                   std::to_string(level.restarts), "--seed", std::to_string(level.seed)},
                                  level.name + ".clusters", true);
        return add("knead-aggregate",
                   {clusters.string(), "--order", level.order, "--interest", level.interest,
                    "--direction-weight", text_of(level.direction_weight)},
                   level.name + ".aggregated");
    }

    std::filesystem::path coarsen(const Level& level, const std::filesystem::path& fine_mesh,
                                  const std::filesystem::path& object) {
        auto shared = std::find_if(coarse_.begin(), coarse_.end(),
                                   [&](const Coarse& coarse) { return coarse.source == *level.mesh; });
        if (shared == coarse_.end()) {
            const auto mesh = add("knead-mesh", mesh_arguments(*level.mesh), level.name + ".mesh");
            const auto overlap =
                add("knead-overlap", {fine_mesh.string(), mesh.string()}, level.name + ".overlap", true);
            coarse_.push_back({*level.mesh, mesh, overlap});
            shared = std::prev(coarse_.end());
        }
        return add("knead-coarsen",
                   {object.string(), shared->mesh.string(), shared->overlap.string(), "--rule", level.rule},
                   level.name + ".coarse");
    }

    struct Coarse {
        MeshSource source;
        std::filesystem::path mesh;
        std::filesystem::path overlap;
    };

    const Scene& scene_;
    std::filesystem::path folder_;
    std::vector<Coarse> coarse_;
    Plan plan_;
};

}  // namespace

std::string command_line(const Stage& stage) {
    std::string line = stage.tool;
    for (const std::string& argument : stage.arguments) {
        const bool plain =
            argument.find_first_of(" '\"$*?()&;<>|\\") == std::string::npos && !argument.empty();
        line += plain ? ' ' + argument : " '" + argument + "'";
    }
    return line;
}

Plan plan_build(const Scene& scene, const std::vector<std::string>& levels,
                const std::filesystem::path& folder) {
    for (const std::string& name : levels)
        (void)scene.level(name);  // refuses an unknown one
    return Planner(scene, folder).plan(levels);
}

}  // namespace knead::tools
