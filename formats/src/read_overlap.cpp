// SPDX-License-Identifier: Apache-2.0
#include "read_kind.h"

namespace knead {
namespace {

const std::string kOverlap = "/knead/overlap";

}  // namespace

void check_overlap_shape(Schema& schema) {
    const ReadLimits& limits = schema.limits();
    schema.group(kOverlap);
    schema.number_attribute(kOverlap, "fine_count", ScalarType::u32);
    schema.number_attribute(kOverlap, "coarse_count", ScalarType::u32);
    const std::uint64_t rows = schema.dataset(kOverlap + "/row_offsets", ScalarType::u64, {kAnyExtent}, "1");
    schema.limit(rows == 0 ? 0 : rows - 1, limits.max_tetrahedra, "coarse tetrahedra",
                 kOverlap + "/row_offsets");
    const std::uint64_t entries = schema.dataset(kOverlap + "/columns", ScalarType::u32, {kAnyExtent}, "1");
    schema.limit(entries, limits.max_overlap_entries, "entries", kOverlap + "/columns");
    schema.dataset(kOverlap + "/volumes_m3", ScalarType::f64, {entries}, "m^3");
}

OverlapMatrix take_overlap(Schema& schema) {
    OverlapMatrix matrix;
    matrix.coarse_count = schema.number_of<std::uint32_t>(kOverlap, "coarse_count");
    matrix.fine_count = schema.number_of<std::uint32_t>(kOverlap, "fine_count");
    matrix.row_offsets = schema.take<std::uint64_t>(kOverlap + "/row_offsets");
    matrix.columns = schema.take<std::uint32_t>(kOverlap + "/columns");
    matrix.volumes_m3 = schema.take<double>(kOverlap + "/volumes_m3");
    return matrix;
}

template <>
Result<Stored<OverlapMatrix>> read_stored<OverlapMatrix>(const std::filesystem::path& file,
                                                         const ReadLimits& limits) {
    return read_kind<OverlapMatrix>(file, limits, {FileKind::overlap}, [](Schema& schema) {
        OverlapMatrix matrix = take_overlap(schema);
        value_or_fail(validate(matrix));
        return matrix;
    });
}

Result<OverlapMatrix> read_overlap(const std::filesystem::path& file, const ReadLimits& limits) {
    return value_of(read_stored<OverlapMatrix>(file, limits));
}

}  // namespace knead
