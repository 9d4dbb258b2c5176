// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/version.h>

#include <map>
#include <nlohmann/json.hpp>

#include "cluster/cluster.h"
#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

const std::map<std::string, Binning> kBinnings{{"equal-width", Binning::equal_width},
                                               {"equal-population", Binning::equal_population},
                                               {"equal-width-log", Binning::equal_width_log},
                                               {"kmeans", Binning::kmeans}};

struct Arguments {
    std::filesystem::path material;
    std::filesystem::path output;
    std::string binning = "equal-width";
    ClusterOptions options;
};

void declare(CLI::App& app, Arguments& arguments) {
    ClusterOptions& options = arguments.options;
    app.add_option("MATERIAL", arguments.material, "mesh with material")->required()->group("Inputs");
    app.add_option("-o,--output", arguments.output, "clustering to write; replaced only once complete")
        ->required()
        ->type_name("FILE");
    app.add_option("--bins", options.bins, "elasticity bins")
        ->capture_default_str()
        ->type_name("N")
        ->check(CLI::Range(1U, UINT32_MAX));
    app.add_option("--clusters", options.clusters, "clusters in each bin")
        ->capture_default_str()
        ->type_name("K")
        ->check(CLI::Range(1U, UINT32_MAX));
    app.add_option("--binning", arguments.binning, "how the range of Young's moduli is cut into bins")
        ->capture_default_str()
        ->check(CLI::IsMember(kBinnings))
        ->type_name("HOW");
    app.add_option("--restarts", options.restarts, "k-means runs in each bin, of which the best counts")
        ->capture_default_str()
        ->type_name("N")
        ->check(CLI::Range(1U, 10000U));
}

void report(const ToolContext& context, const ClusterResult& result, double cluster_s, double total_s) {
    nlohmann::ordered_json bins = nlohmann::json::array();
    for (std::size_t bin = 0; bin < result.bins.size(); ++bin) {
        const BinReport& b = result.bins[bin];
        const double modulus = result.clustering.bin_youngs_modulus_pa[bin];
        context.tell(fmt::format("bin {}: {} tetrahedra, {} clusters, E {:.6g} Pa (from {:.6g} to {:.6g})",
                                 bin, b.tetrahedra, b.clusters, modulus, b.lowest_youngs_modulus_pa,
                                 b.highest_youngs_modulus_pa));
        if (!b.converged)
            context.warn(fmt::format("bin {}: k-means stopped after {} iterations before it stood still", bin,
                                     b.iterations));
        bins.push_back({{"tetrahedra", b.tetrahedra},
                        {"clusters", b.clusters},
                        {"youngs_modulus_pa", modulus},
                        {"lowest_youngs_modulus_pa", b.lowest_youngs_modulus_pa},
                        {"highest_youngs_modulus_pa", b.highest_youngs_modulus_pa},
                        {"volume_m3", b.volume_m3},
                        {"inertia_m2", b.inertia_m2},
                        {"iterations", b.iterations},
                        {"converged", b.converged}});
    }
    const nlohmann::ordered_json report{{"tetrahedra", result.clustering.bin_of_tetrahedron.size()},
                                        {"bins", bins},
                                        {"threads", context.threads},
                                        {"seconds", {{"cluster", cluster_s}, {"total", total_s}}}};
    context.write_report(report.dump(2) + "\n");
}

ExitCode run(ToolContext& context, Arguments& arguments) {
    const Stopwatch total;
    require_writable_folder(arguments.output);
    context.set_output(arguments.output);
    ClusterOptions& options = arguments.options;
    options.binning = kBinnings.at(arguments.binning);
    options.seed = context.seed;
    Provenance provenance = context.provenance(
        {"--bins", fmt::format("{}", options.bins), "--clusters", fmt::format("{}", options.clusters),
         "--binning", arguments.binning, "--restarts", fmt::format("{}", options.restarts)});
    auto [object, hash] = read_input<MaterialObject>(context, arguments.material);
    provenance.inputs = {{"material", hash}};

    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, context.threads);
    const Stopwatch cluster_watch;
    const ClusterResult result = cluster_object(object.mesh, object.material, options);
    const double cluster_s = cluster_watch.seconds();
    value_or_throw(write_clustering(arguments.output,
                                    {std::move(object.mesh), std::move(object.material), result.clustering},
                                    provenance));
    report(context, result, cluster_s, total.seconds());
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    Arguments arguments;
    const ToolInfo info{
        .name = "knead-cluster",
        .purpose = "sort tetrahedra into elasticity bins and cluster each bin in space.",
        .example = "knead-cluster cube.material.hdf --bins 2 --clusters 3 -o cube.clusters.hdf",
        .libraries = {std::string("oneTBB ") + TBB_VERSION_STRING},
        .uses_threads = true,
        .uses_seed = true};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, arguments); },
        [&](ToolContext& context) { return run(context, arguments); });
}
