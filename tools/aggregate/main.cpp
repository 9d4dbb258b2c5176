// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "aggregate/aggregate.h"
#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

const std::map<std::string, BinOrder> kOrders{{"stiff-first", BinOrder::stiff_first},
                                              {"soft-first", BinOrder::soft_first}};
const std::map<std::string, InterestKind> kInterests{{"combined", InterestKind::combined},
                                                     {"distance", InterestKind::distance},
                                                     {"direction", InterestKind::direction},
                                                     {"membership", InterestKind::membership},
                                                     {"mahalanobis", InterestKind::mahalanobis}};

struct Arguments {
    std::filesystem::path clustered;
    std::filesystem::path output;
    std::string order = "stiff-first";
    std::string interest = "combined";
    double direction_weight = AggregateOptions{}.direction_weight;
};

void declare(CLI::App& app, Arguments& arguments) {
    app.add_option("CLUSTERED", arguments.clustered, "mesh with material and clustering")
        ->required()
        ->group("Inputs");
    app.add_option("-o,--output", arguments.output,
                   "mesh with aggregated material; replaced only once complete")
        ->required()
        ->type_name("FILE");
    app.add_option("--order", arguments.order, "which bin grows first; the last one takes the rest")
        ->capture_default_str()
        ->check(CLI::IsMember(kOrders))
        ->type_name("ORDER");
    app.add_option("--interest", arguments.interest, "what draws the growth of a cluster")
        ->capture_default_str()
        ->check(CLI::IsMember(kInterests))
        ->type_name("KIND");
    app.add_option("--direction-weight", arguments.direction_weight,
                   "weight of the direction (combined) or membership term against the distance")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber)
        ->type_name("W");
}

void report(const ToolContext& context, const ClusteredObject& object, const AggregateResult& result,
            double aggregate_s, double total_s) {
    nlohmann::ordered_json bins = nlohmann::json::array();
    for (std::size_t bin = 0; bin < result.bins.size(); ++bin) {
        const BinVolume& volume = result.bins[bin];
        const double difference = (volume.after_m3 - volume.before_m3) / volume.before_m3;
        const double modulus = object.clustering.bin_youngs_modulus_pa[bin];
        context.tell(fmt::format("bin {}: E {:.6g} Pa, {:.6g} m^3 before, {:.6g} m^3 after ({:+.3f} %)", bin,
                                 modulus, volume.before_m3, volume.after_m3, 100 * difference));
        bins.push_back({{"youngs_modulus_pa", modulus},
                        {"volume_before_m3", volume.before_m3},
                        {"volume_after_m3", volume.after_m3},
                        {"relative_difference", difference}});
    }
    const nlohmann::ordered_json report{{"tetrahedra", object.mesh.tetrahedra.size()},
                                        {"clusters", object.clustering.bin_of_cluster.size()},
                                        {"bins", bins},
                                        {"jumps", result.jumps},
                                        {"seconds", {{"aggregate", aggregate_s}, {"total", total_s}}}};
    context.write_report(report.dump(2) + "\n");
}

ExitCode run(ToolContext& context, const Arguments& arguments) {
    const Stopwatch total;
    require_writable_folder(arguments.output);
    context.set_output(arguments.output);
    Provenance provenance =
        context.provenance({"--order", arguments.order, "--interest", arguments.interest,
                            "--direction-weight", fmt::format("{}", arguments.direction_weight)});
    const auto [object, hash] = read_input<ClusteredObject>(context, arguments.clustered);
    provenance.inputs = {{"clustered", hash}};

    const Stopwatch aggregate_watch;
    const AggregateResult result = aggregate(
        object, {kOrders.at(arguments.order), kInterests.at(arguments.interest), arguments.direction_weight});
    const double aggregate_s = aggregate_watch.seconds();
    value_or_throw(write_material(arguments.output, {object.mesh, result.material}, provenance));
    report(context, object, result, aggregate_s, total.seconds());
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    Arguments arguments;
    const ToolInfo info{
        .name = "knead-aggregate",
        .purpose = "gather the elasticity of each bin around the barycentres of its clusters.",
        .example = "knead-aggregate cube.clusters.hdf -o cube.aggregated.hdf",
        .libraries = {}};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, arguments); },
        [&](ToolContext& context) { return run(context, arguments); });
}
