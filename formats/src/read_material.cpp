// SPDX-License-Identifier: Apache-2.0
#include "read_kind.h"

namespace knead {
namespace {

const std::string kMaterial = "/knead/material";
const std::string kBin = kMaterial + "/bin_of_tetrahedron";

}  // namespace

void check_material_shape(Schema& schema, std::uint64_t tetrahedra) {
    schema.group(kMaterial);
    schema.dataset(kMaterial + "/youngs_modulus_pa", ScalarType::f64, {tetrahedra}, "Pa");
    schema.dataset(kMaterial + "/poissons_ratio", ScalarType::f64, {tetrahedra}, "1");
    schema.dataset(kMaterial + "/density_kg_per_m3", ScalarType::f64, {tetrahedra}, "kg/m^3");
    if (schema.has(kBin)) schema.dataset(kBin, ScalarType::u32, {tetrahedra}, "1");
}

Material take_material(Schema& schema) {
    Material material;
    material.youngs_modulus_pa = schema.take<double>(kMaterial + "/youngs_modulus_pa");
    material.poissons_ratio = schema.take<double>(kMaterial + "/poissons_ratio");
    material.density_kg_per_m3 = schema.take<double>(kMaterial + "/density_kg_per_m3");
    if (schema.has(kBin)) material.bin_of_tetrahedron = schema.take<std::uint32_t>(kBin);
    return material;
}

template <>
Result<Stored<MaterialObject>> read_stored<MaterialObject>(const std::filesystem::path& file,
                                                           const ReadLimits& limits) {
    return read_kind<MaterialObject>(
        file, limits, {FileKind::material, FileKind::clustering}, [](Schema& schema) {
            MaterialObject object{take_tet_mesh(schema), take_material(schema)};
            value_or_fail(validate(object.mesh));
            value_or_fail(validate(object.material, object.mesh.tetrahedra.size()));
            return object;
        });
}

Result<MaterialObject> read_material(const std::filesystem::path& file, const ReadLimits& limits) {
    return value_of(read_stored<MaterialObject>(file, limits));
}

}  // namespace knead
