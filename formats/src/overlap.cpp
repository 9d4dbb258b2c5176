// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/overlap.h"

#include <string>

#include "failure.h"
#include "mesh_checks.h"
#include "offenders.h"

namespace knead {
namespace {

const std::string kGroup = "/knead/overlap";

void check_row_offsets(const OverlapMatrix& m) {
    const std::string where = kGroup + "/row_offsets";
    const auto& offsets = m.row_offsets;
    if (offsets.size() != std::size_t{m.coarse_count} + 1)
        fail(ErrorCode::invalid_data,
             std::to_string(offsets.size()) + " entries for " + std::to_string(m.coarse_count) +
                 " coarse tetrahedra, which need one more than there are",
             where);
    if (offsets.front() != 0 || offsets.back() != m.columns.size())
        fail(ErrorCode::invalid_data,
             "runs from " + std::to_string(offsets.front()) + " to " + std::to_string(offsets.back()) +
                 " instead of from 0 to the " + std::to_string(m.columns.size()) + " entries",
             where);
    Offenders bad;
    for (std::size_t j = 0; j + 1 < offsets.size(); ++j)
        if (offsets[j + 1] < offsets[j]) bad.add(j);
    if (bad.any())
        fail(ErrorCode::invalid_data, bad.text(m.coarse_count, "rows end before they start", "rows"), where);
}

void check_entries(const OverlapMatrix& m) {
    Offenders outside, unordered, volumes;
    for (std::size_t j = 0; j < m.coarse_count; ++j)
        for (std::uint64_t k = m.row_offsets[j]; k < m.row_offsets[j + 1]; ++k) {
            if (m.columns[k] >= m.fine_count) outside.add(k);
            if (k > m.row_offsets[j] && m.columns[k] <= m.columns[k - 1]) unordered.add(k);
            if (!is_positive(m.volumes_m3[k])) volumes.add(k);
        }
    if (outside.any())
        fail(ErrorCode::invalid_data,
             outside.text(m.columns.size(),
                          "columns are not below the " + std::to_string(m.fine_count) + " fine tetrahedra",
                          "entries"),
             kGroup + "/columns");
    if (unordered.any())
        fail(ErrorCode::invalid_data,
             unordered.text(m.columns.size(), "columns do not increase inside their row", "entries"),
             kGroup + "/columns");
    if (volumes.any())
        fail(ErrorCode::invalid_data, volumes.text(m.volumes_m3.size(), kNotPositive, "entries"),
             kGroup + "/volumes_m3");
}

}  // namespace

Status validate(const OverlapMatrix& overlap) {
    return guarded(kGroup, [&] {
        if (overlap.volumes_m3.size() != overlap.columns.size())
            fail(ErrorCode::invalid_data,
                 std::to_string(overlap.volumes_m3.size()) + " volumes for " +
                     std::to_string(overlap.columns.size()) + " columns",
                 kGroup + "/volumes_m3");
        check_row_offsets(overlap);
        check_entries(overlap);
        return Unit{};
    });
}

}  // namespace knead
