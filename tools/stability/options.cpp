// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "common/progress.h"
#include "knead/formats/write/write.h"

namespace knead::tools::stability {

void declare_options(CLI::App& app, StabilityOptions& options) {
    auto* stability =
        app.add_flag("--stability", options.wanted,
                     "run the stability matrix instead (docs/stability.md): no SCENE; with --json, -j");
    app.add_option("--cells", options.cells, "only cells with this in their name")
        ->needs(stability)
        ->type_name("PATTERN");
    app.add_option("--soak", options.soak_steps, "steps of the long soak")
        ->needs(stability)
        ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{1} << 40U))
        ->capture_default_str()
        ->type_name("STEPS");
    app.add_flag("--shortened", options.shortened, "fewer comparisons and smaller meshes, as the tests do")
        ->needs(stability);
}

ExitCode run_stability(ToolContext& context, const StabilityOptions& options,
                       const StabilityProvenance& provenance, const std::filesystem::path& json) {
    const std::vector<std::string> names = stability_cells();
    if (std::none_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name.find(options.cells) != std::string::npos; }))
        fail_usage(fmt::format("--cells \"{}\": no cell has this in its name", options.cells));
    if (!json.empty()) require_writable_folder(json);
    Progress progress(!context.quiet);
    StabilityRequest request;
    request.pattern = options.cells;
    request.soak_steps = options.soak_steps;
    request.shortened = options.shortened;
    request.threads = context.threads;
    request.progress = [&](std::size_t done, std::size_t total, std::string_view cell) {
        progress.show(done, total, cell);
    };
    const std::vector<CellResult> cells = run_stability(request);
    progress.clear();
    const StabilityCounts counts = count_of(cells);
    if (!json.empty())
        value_or_throw(write_text_file(json, stability_json(cells, provenance).dump(1) + "\n"));
    context.write_report(
        nlohmann::ordered_json{{"pass", counts.pass}, {"warn", counts.warn}, {"fail", counts.fail}}.dump(2) +
        "\n");
    std::cout << stability_table(cells);
    return counts.fail > 0 ? ExitCode::answer_is_no : ExitCode::done;
}

}  // namespace knead::tools::stability
