// SPDX-License-Identifier: Apache-2.0
#include "encode.h"

namespace knead {

Status write_overlap(const std::filesystem::path& file, const OverlapMatrix& overlap,
                     const Provenance& provenance) {
    return write_kind(file, FileKind::overlap, provenance, [&](FilePlan& plan) {
        value_or_fail(validate(overlap));
        const std::string group = "/knead/overlap";
        Node& node = plan.payload.add_group(group);
        node.attributes["coarse_count"] = scalar(overlap.coarse_count);
        node.attributes["fine_count"] = scalar(overlap.fine_count);
        plan.payload.add_dataset(group + "/row_offsets", view_1d(overlap.row_offsets), "1");
        plan.payload.add_dataset(group + "/columns", view_1d(overlap.columns), "1");
        plan.payload.add_dataset(group + "/volumes_m3", view_1d(overlap.volumes_m3), "m^3");
    });
}

}  // namespace knead
