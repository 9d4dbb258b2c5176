// SPDX-License-Identifier: Apache-2.0
#include "encode.h"

namespace knead {

Status write_tet_mesh(const std::filesystem::path& file, const TetMesh& mesh, const Provenance& provenance) {
    return write_kind(file, FileKind::tet_mesh, provenance, [&](FilePlan& plan) {
        value_or_fail(validate(mesh));
        encode_mesh(plan, mesh);
    });
}

}  // namespace knead
