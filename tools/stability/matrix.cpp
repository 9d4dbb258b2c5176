// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <mutex>

#include "stability/cells.h"

namespace knead::tools::stability {
namespace {

std::string full_name(const Cell& cell) {
    return cell.family + "/" + cell.name;
}

CellResult run_cell(const Cell& cell, const StabilityRequest& request) {
    CellResult result;
    result.name = full_name(cell);
    result.family = cell.family;
    try {
        cell.run(request, result);
    } catch (const std::exception& error) {
        result.checks = {must_be("runs", false, error.what())};
    }
    if (result.checks.empty()) result.checks = {must_be("runs", false, "nothing was checked")};
    return result;
}

}  // namespace

CellStatus CellResult::status() const {
    return decisive().status;
}

const Check& CellResult::decisive() const {
    return *std::max_element(checks.begin(), checks.end(),
                             [](const Check& a, const Check& b) { return a.status < b.status; });
}

std::vector<Warning> CellResult::warnings() const {
    std::vector<Warning> found;
    for (const Check& check : checks)
        if (check.warning != Warning::none &&
            std::find(found.begin(), found.end(), check.warning) == found.end())
            found.push_back(check.warning);
    return found;
}

std::vector<std::string> stability_cells() {
    std::vector<std::string> names;
    for (const Cell& cell : all_cells())
        names.push_back(full_name(cell));
    return names;
}

std::vector<CellResult> run_stability(const StabilityRequest& request) {
    Cells cells = all_cells();
    std::erase_if(
        cells, [&](const Cell& cell) { return full_name(cell).find(request.pattern) == std::string::npos; });
    std::vector<CellResult> results(cells.size());
    std::mutex mutex;
    std::size_t done = 0;
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, request.threads);
    tbb::task_arena(static_cast<int>(request.threads)).execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, cells.size(), 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t k = range.begin(); k < range.end(); ++k) {
                    results[k] = run_cell(cells[k], request);
                    const std::lock_guard<std::mutex> lock(mutex);
                    if (request.progress) request.progress(++done, cells.size(), results[k].name);
                }
            },
            tbb::simple_partitioner());
    });
    return results;
}

}  // namespace knead::tools::stability
