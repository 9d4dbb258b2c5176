// SPDX-License-Identifier: Apache-2.0
#include "encode.h"

namespace knead {

Status write_material(const std::filesystem::path& file, const MaterialObject& object,
                      const Provenance& provenance) {
    return write_kind(file, FileKind::material, provenance, [&](FilePlan& plan) {
        value_or_fail(validate(object.mesh));
        value_or_fail(validate(object.material, object.mesh.tetrahedra.size()));
        encode_mesh(plan, object.mesh);
        encode_material(plan, object.material, "bin");
    });
}

}  // namespace knead
