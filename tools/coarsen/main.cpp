// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "coarsen/coarsen.h"
#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

constexpr std::size_t kIdsShown = 5;

const std::map<std::string, CoarsenRule> kRules{{"dominant", CoarsenRule::dominant},
                                                {"volume-average", CoarsenRule::volume_average}};

struct Arguments {
    std::filesystem::path fine;
    std::filesystem::path coarse;
    std::filesystem::path overlap;
    std::filesystem::path output;
    std::string rule = "dominant";
};

void declare(CLI::App& app, Arguments& arguments) {
    app.add_option("FINE", arguments.fine, "fine mesh with material")->required()->group("Inputs");
    app.add_option("COARSE", arguments.coarse, "coarse mesh")->required()->group("Inputs");
    app.add_option("OVERLAP", arguments.overlap, "overlap of the two, from knead-overlap")
        ->required()
        ->group("Inputs");
    app.add_option("-o,--output", arguments.output, "coarse mesh with material; replaced only once complete")
        ->required()
        ->type_name("FILE");
    app.add_option("--rule", arguments.rule, "how a coarse tetrahedron gets its values from the fine ones")
        ->capture_default_str()
        ->check(CLI::IsMember(kRules))
        ->type_name("RULE");
}

nlohmann::ordered_json to_json(const std::vector<std::uint32_t>& ids) {
    const std::span<const std::uint32_t> first(ids.data(), std::min(ids.size(), kIdsShown));
    return {{"count", ids.size()}, {"first_ids", std::vector<std::uint32_t>(first.begin(), first.end())}};
}

void tell_about(const ToolContext& context, const std::filesystem::path& mesh,
                const std::vector<std::uint32_t>& ids, const char* what) {
    if (ids.empty()) return;
    const std::span<const std::uint32_t> first(ids.data(), std::min(ids.size(), kIdsShown));
    context.tell(fmt::format("{}: {} tetrahedra {} (counted from 0: {}{})", mesh.string(), ids.size(), what,
                             fmt::join(first, ", "), ids.size() > kIdsShown ? ", ..." : ""));
}

void report(const ToolContext& context, const Arguments& arguments, const CoarsenResult& result,
            double coarsen_s, double total_s) {
    const CoveredShares& coverage = result.coverage;
    context.tell(
        fmt::format("{}: {} tetrahedra; {:.4f} % of the coarse and {:.4f} % of the fine volume covered",
                    arguments.output.string(), result.material.youngs_modulus_pa.size(),
                    100 * coverage.coarse_share, 100 * coverage.fine_share));
    tell_about(context, arguments.coarse, coverage.coarse_missing, "miss more than 1 % of their volume");
    tell_about(context, arguments.fine, coverage.fine_missing, "miss more than 1 % of their volume");
    tell_about(context, arguments.coarse, coverage.coarse_uncovered,
               "are not covered at all and take the nearest fine tetrahedron's values");
    const nlohmann::ordered_json report{
        {"tetrahedra", result.material.youngs_modulus_pa.size()},
        {"coarse_covered_share", coverage.coarse_share},
        {"fine_covered_share", coverage.fine_share},
        {"coarse_missing_more_than_1_percent", to_json(coverage.coarse_missing)},
        {"fine_missing_more_than_1_percent", to_json(coverage.fine_missing)},
        {"coarse_uncovered", to_json(coverage.coarse_uncovered)},
        {"seconds", {{"coarsen", coarsen_s}, {"total", total_s}}}};
    context.write_report(report.dump(2) + "\n");
}

ExitCode run(ToolContext& context, const Arguments& arguments) {
    const Stopwatch total;
    require_writable_folder(arguments.output);
    context.set_output(arguments.output);
    Provenance provenance = context.provenance({"--rule", arguments.rule});
    const Input<MaterialObject> fine = read_input<MaterialObject>(context, arguments.fine);
    Input<TetMesh> coarse = read_input<TetMesh>(context, arguments.coarse);
    const Input<OverlapMatrix> overlap = read_input<OverlapMatrix>(context, arguments.overlap);
    provenance.inputs = {
        {"fine", fine.content_hash}, {"coarse", coarse.content_hash}, {"overlap", overlap.content_hash}};

    const Stopwatch coarsen_watch;
    CoarsenResult result = about(arguments.overlap, [&] {
        return coarsen(fine.value, coarse.value, overlap.value, kRules.at(arguments.rule));
    });
    const double coarsen_s = coarsen_watch.seconds();
    // The names of regions and arrays speak of the original's materials; the coarse values come from the fine
    // mesh.
    coarse.value.regions = {};
    coarse.value.cell_arrays.clear();
    value_or_throw(write_material(arguments.output, {std::move(coarse.value), result.material}, provenance));
    report(context, arguments, result, coarsen_s, total.seconds());
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    Arguments arguments;
    const ToolInfo info{
        .name = "knead-coarsen",
        .purpose = "give each coarse tetrahedron its elasticity from the fine ones it overlaps.",
        .example = "knead-coarsen fine.hdf coarse.hdf overlap.hdf -o coarse.material.hdf",
        .libraries = {}};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, arguments); },
        [&](ToolContext& context) { return run(context, arguments); });
}
