// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlap/overlap.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "overlap/candidates.h"
#include "overlap/with_threads.h"

namespace knead::tools {
namespace {

struct SharedVolume {
    std::uint32_t fine;
    double volume;
};
using Row = std::vector<SharedVolume>;  // ascending in fine

/// What one thread needs and counts while it works on rows.
struct Worker {
    std::vector<std::uint32_t> candidates;
    Row row;
    OverlapStatistics statistics;
};

void compute_row(const std::vector<PreparedTet>& fine, const BoxTree& tree, const PreparedTet& coarse,
                 double drop_below, Worker& worker) {
    worker.row.clear();
    tree.find(coarse.low, coarse.high, worker.candidates);
    worker.statistics.candidate_pairs += worker.candidates.size();
    for (const std::uint32_t i : worker.candidates) {
        const double volume = shared_volume(fine[i], coarse, worker.statistics.arithmetic);
        if (volume > drop_below * std::min(fine[i].volume, coarse.volume)) worker.row.push_back({i, volume});
    }
}

std::vector<Row> compute_rows(const std::vector<PreparedTet>& fine, const std::vector<PreparedTet>& coarse,
                              const OverlapOptions& options, OverlapStatistics& statistics) {
    const BoxTree tree(fine);
    std::vector<Row> rows(coarse.size());
    tbb::enumerable_thread_specific<Worker> workers;
    with_threads(options.threads, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, coarse.size()), [&](const auto& range) {
            Worker& worker = workers.local();
            for (std::size_t j = range.begin(); j != range.end(); ++j) {
                compute_row(fine, tree, coarse[j], options.drop_below, worker);
                rows[j] = worker.row;  // copied, so that it takes no more memory than it needs
            }
        });
    });
    for (const Worker& worker : workers) {
        statistics.candidate_pairs += worker.statistics.candidate_pairs;
        statistics.arithmetic += worker.statistics.arithmetic;
    }
    return rows;
}

OverlapMatrix compress(std::vector<Row> rows, std::size_t fine_count, double unit_volume) {
    OverlapMatrix overlap;
    overlap.coarse_count = static_cast<std::uint32_t>(rows.size());
    overlap.fine_count = static_cast<std::uint32_t>(fine_count);
    overlap.row_offsets.reserve(rows.size() + 1);
    overlap.row_offsets.push_back(0);
    for (const Row& row : rows)
        overlap.row_offsets.push_back(overlap.row_offsets.back() + row.size());
    overlap.columns.reserve(overlap.row_offsets.back());
    overlap.volumes_m3.reserve(overlap.row_offsets.back());
    for (Row& row : rows) {
        for (const SharedVolume& shared : row) {
            overlap.columns.push_back(shared.fine);
            overlap.volumes_m3.push_back(shared.volume * unit_volume);
        }
        Row().swap(row);
    }
    return overlap;
}

}  // namespace

OverlapMatrix overlap_volumes(const TetMesh& fine, const TetMesh& coarse, const OverlapOptions& options,
                              OverlapStatistics* statistics) {
    if (!(options.drop_below >= 0 && options.drop_below < 1))
        fail_usage("--drop-below must be at least 0 and below 1");
    // A power of two changes no digit, and keeps cubes of very small or large coordinates inside the range.
    const int exponent = std::max(exponent_of(fine), exponent_of(coarse));
    const auto prepared_fine = prepare_all(fine, exponent, options.threads);
    const auto prepared_coarse = prepare_all(coarse, exponent, options.threads);
    OverlapStatistics counted;
    auto rows = compute_rows(prepared_fine, prepared_coarse, options, counted);
    if (statistics != nullptr) *statistics = counted;
    return compress(std::move(rows), fine.tetrahedra.size(), std::ldexp(1.0, 3 * exponent));
}

}  // namespace knead::tools
