// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/write/write.h"
#include "overlap/coverage.h"
#include "overlap/exact.h"
#include "overlap/overlap.h"

namespace knead::tools {
namespace {

struct Arguments {
    std::filesystem::path fine;
    std::filesystem::path coarse;
    std::filesystem::path output;
    OverlapOptions options;
};

void declare(CLI::App& app, Arguments& arguments) {
    app.add_option("FINE", arguments.fine, "fine mesh that carries elasticities")
        ->required()
        ->type_name("FILE");
    app.add_option("COARSE", arguments.coarse, "coarse mesh to be simulated")->required()->type_name("FILE");
    app.add_option("-o,--output", arguments.output, "overlap matrix to write; replaced only once complete")
        ->required()
        ->type_name("FILE");
    app.add_option("--drop-below", arguments.options.drop_below,
                   "ignore shared volume below this share of the smaller element")
        ->capture_default_str()
        ->type_name("RATIO");
}

void warn_about(const ToolContext& context, const std::string& mesh, const ElementSample& sample,
                const char* what) {
    if (sample.count > 0)
        context.warn(fmt::format("{}: {} tetrahedra {} (first ids {})", mesh, sample.count, what,
                                 fmt::join(sample.first, ", ")));
}

void tell_coverage(const ToolContext& context, const std::filesystem::path& mesh, const char* other,
                   const MeshCoverage& coverage) {
    context.tell(fmt::format("{}: {:.4f} % of the volume is covered by the {} mesh", mesh.string(),
                             100 * coverage.covered_share, other));
    warn_about(context, mesh.string(), coverage.incomplete, "miss more than 1 % of their volume");
    warn_about(context, mesh.string(), coverage.overlapped, "are covered more than once");
}

nlohmann::ordered_json to_json(const ElementSample& sample) {
    return {{"count", sample.count}, {"first_ids", sample.first}};
}

nlohmann::ordered_json to_json(const MeshCoverage& coverage, std::uint32_t count) {
    return {{"tetrahedra", count},
            {"covered_share", coverage.covered_share},
            {"fully_covered", coverage.full},
            {"largest_error_of_fully_covered", coverage.largest_full_error},
            {"missing_more_than_1_percent", to_json(coverage.incomplete)},
            {"uncovered", to_json(coverage.uncovered)},
            {"covered_more_than_once", to_json(coverage.overlapped)}};
}

void write_report(const ToolContext& context, const OverlapMatrix& overlap, const Coverage& coverage,
                  const OverlapStatistics& statistics, double compute_s, double total_s) {
    const nlohmann::ordered_json report{{"stored_pairs", overlap.columns.size()},
                                        {"candidate_pairs", statistics.candidate_pairs},
                                        {"pairs_in_long_double", statistics.arithmetic.in_long_double},
                                        {"pairs_in_exact_arithmetic", statistics.arithmetic.exact},
                                        {"fine", to_json(coverage.fine, overlap.fine_count)},
                                        {"coarse", to_json(coverage.coarse, overlap.coarse_count)},
                                        {"threads", context.threads},
                                        {"seconds", {{"overlap", compute_s}, {"total", total_s}}}};
    context.write_report(report.dump(2) + "\n");
}

ExitCode run(ToolContext& context, Arguments& arguments) {
    const Stopwatch total;
    require_writable_folder(arguments.output);
    context.set_output(arguments.output);
    Provenance provenance =
        context.provenance({"--drop-below", fmt::format("{}", arguments.options.drop_below)});
    const auto [fine, fine_hash] = read_input<TetMesh>(context, arguments.fine);
    const auto [coarse, coarse_hash] = read_input<TetMesh>(context, arguments.coarse);
    provenance.inputs = {{"fine", fine_hash}, {"coarse", coarse_hash}};

    arguments.options.threads = context.threads;
    const Stopwatch compute;
    OverlapStatistics statistics;
    const OverlapMatrix overlap = overlap_volumes(fine, coarse, arguments.options, &statistics);
    const double compute_s = compute.seconds();
    if (overlap.columns.empty())
        fail_result(arguments.fine.string() + " and " + arguments.coarse.string() +
                    " share no volume: are they the same object, in the same place and unit?");

    const Coverage coverage = coverage_of(overlap, fine, coarse, context.threads);
    tell_coverage(context, arguments.fine, "coarse", coverage.fine);
    tell_coverage(context, arguments.coarse, "fine", coverage.coarse);
    value_or_throw(write_overlap(arguments.output, overlap, provenance));
    context.tell(fmt::format("{}: {} fine x {} coarse tetrahedra, {} shared volumes",
                             arguments.output.string(), overlap.fine_count, overlap.coarse_count,
                             overlap.columns.size()));
    write_report(context, overlap, coverage, statistics, compute_s, total.seconds());
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    Arguments arguments;
    const ToolInfo info{
        .name = "knead-overlap",
        .purpose = "compute how much volume each coarse tetrahedron shares with each fine one.",
        .example = "knead-overlap liver.fine.hdf liver.coarse.hdf -o liver.overlap.hdf",
        .libraries = {exact_library_version()},
        .uses_threads = true};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, arguments); },
        [&](ToolContext& context) { return run(context, arguments); });
}
