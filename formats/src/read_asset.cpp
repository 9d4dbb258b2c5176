// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "knead/formats/tool_names.h"
#include "read_kind.h"
#include "required_features.h"

namespace knead {
namespace {

const std::string kAsset = "/knead/asset";
const std::string kMesh = kAsset + "/mesh";
const std::string kPalette = kAsset + "/material/palette";
const std::string kPaletteIndex = kAsset + "/material/palette_index";
const std::string kTools = kAsset + "/tools";
const std::string kGravity = kAsset + "/gravity";
const std::string kDamping = kAsset + "/damping";
const std::string kSurface = kAsset + "/surface";
const std::string kEmbedding = kAsset + "/embedding";
const std::string kStill = kEmbedding + "/still_vertices_m";

void check_material_palette_shape(Schema& schema, std::uint64_t tetrahedra) {
    schema.group(kAsset + "/material");
    schema.group(kPalette);
    const std::uint64_t entries =
        schema.dataset(kPalette + "/youngs_modulus_pa", ScalarType::f64, {kAnyExtent}, "Pa");
    schema.dataset(kPalette + "/poissons_ratio", ScalarType::f64, {entries}, "1");
    schema.dataset(kPalette + "/density_kg_per_m3", ScalarType::f64, {entries}, "kg/m^3");
    schema.index_dataset(kPaletteIndex, {tetrahedra});
}

/// An enumerator of a tool; attributes are there before the data.
template <class Enum, std::size_t N>
Enum enumerator(Schema& schema, const std::string& tool, const char* attribute,
                const std::array<const char*, N>& names) {
    const std::string text = schema.text_of(tool, attribute);
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        schema.refuse(ErrorCode::invalid_data, "\"" + text + "\" is not a " + attribute,
                      tool + "@" + attribute);
    return static_cast<Enum>(found - names.begin());
}

void check_tool_set_shape(Schema& schema, const std::string& tool) {
    schema.group(tool);
    for (const char* name : {"name", "shape", "contact"})
        schema.text_attribute(tool, name);
    schema.dataset(tool + "/rest_position_m", ScalarType::f64, {3}, "m");
    schema.dataset(tool + "/rest_orientation_wxyz", ScalarType::f64, {4}, "1");
    schema.dataset(tool + "/nodes", ScalarType::u32, {kAnyExtent}, "1");
    const auto shape = enumerator<ToolShape>(schema, tool, "shape", kToolShapes);
    const auto contact = enumerator<ToolContact>(schema, tool, "contact", kToolContacts);
    if (shape == ToolShape::plate)
        schema.dataset(tool + "/half_extents_m", ScalarType::f64, {2}, "m");
    else
        schema.dataset(tool + "/radius_m", ScalarType::f64, {1}, "m");
    if (shape == ToolShape::capsule) schema.dataset(tool + "/half_length_m", ScalarType::f64, {1}, "m");
    if (contact == ToolContact::coulomb)
        schema.dataset(tool + "/friction_coefficient", ScalarType::f64, {1}, "1");
}

ToolSet take_tool_set(Schema& schema, const std::string& tool) {
    ToolSet set;
    set.name = schema.text_of(tool, "name");
    set.shape = enumerator<ToolShape>(schema, tool, "shape", kToolShapes);
    set.contact = enumerator<ToolContact>(schema, tool, "contact", kToolContacts);
    if (set.shape == ToolShape::plate)
        set.half_extents_m = schema.take_one<std::array<double, 2>>(tool + "/half_extents_m");
    else
        set.radius_m = schema.take_one<double>(tool + "/radius_m");
    if (set.shape == ToolShape::capsule) set.half_length_m = schema.take_one<double>(tool + "/half_length_m");
    if (set.contact == ToolContact::coulomb)
        set.friction_coefficient = schema.take_one<double>(tool + "/friction_coefficient");
    set.rest_position_m = schema.take_one<Point>(tool + "/rest_position_m");
    set.rest_orientation_wxyz = schema.take_one<std::array<double, 4>>(tool + "/rest_orientation_wxyz");
    set.nodes = schema.take<std::uint32_t>(tool + "/nodes");
    return set;
}

void take_palette(Schema& schema, Asset& asset) {
    const auto moduli = schema.take<double>(kPalette + "/youngs_modulus_pa");
    const auto ratios = schema.take<double>(kPalette + "/poissons_ratio");
    const auto densities = schema.take<double>(kPalette + "/density_kg_per_m3");
    for (std::size_t i = 0; i < moduli.size(); ++i)
        asset.palette.push_back({moduli[i], ratios[i], densities[i]});
    asset.palette_index = schema.take_index(kPaletteIndex);
}

void check_embedding_shape(Schema& schema) {
    schema.group(kEmbedding);
    const ReadLimits& limits = schema.limits();
    const std::uint64_t vertices =
        schema.dataset(kEmbedding + "/tetrahedron", ScalarType::u32, {kAnyExtent}, "1");
    schema.dataset(kEmbedding + "/weights", ScalarType::f32, {vertices, 4}, "1");
    schema.limit(vertices, limits.max_nodes, "vertices", kEmbedding + "/tetrahedron");
    if (schema.has(kStill)) {
        const std::uint64_t still = schema.dataset(kStill, ScalarType::f64, {kAnyExtent, 3}, "m");
        schema.limit(still, limits.max_nodes - vertices, "still vertices beside the moving ones", kStill);
    }
    const std::uint64_t triangles =
        schema.dataset(kEmbedding + "/triangles", ScalarType::u32, {kAnyExtent, 3}, "1");
    schema.limit(triangles, limits.max_tetrahedra, "triangles", kEmbedding + "/triangles");
}

SurfaceEmbedding take_embedding(Schema& schema) {
    SurfaceEmbedding embedding;
    embedding.tetrahedron = schema.take<std::uint32_t>(kEmbedding + "/tetrahedron");
    embedding.weights = schema.take<std::array<float, 4>>(kEmbedding + "/weights");
    if (schema.has(kStill)) embedding.still_vertices_m = schema.take<Point>(kStill);
    embedding.triangles = schema.take<std::array<std::uint32_t, 3>>(kEmbedding + "/triangles");
    return embedding;
}

}  // namespace

void check_asset_shape(Schema& schema) {
    schema.group(kAsset);
    schema.text_attribute(kAsset, "name");
    schema.text_attribute(kAsset, "level");
    const std::uint64_t tetrahedra = check_mesh_shape(schema, kMesh);
    schema.number_attribute(kMesh, "free_node_count", ScalarType::u32);
    check_material_palette_shape(schema, tetrahedra);
    if (schema.has(kTools)) {
        schema.group(kTools);
        const auto tools = schema.children(kTools);
        schema.limit(tools.size(), schema.limits().max_names, "tools", kTools);
        for (const std::string& tool : tools)
            check_tool_set_shape(schema, kTools + "/" + tool);
    }
    if (schema.has(kGravity)) {
        schema.group(kGravity);
        schema.dataset(kGravity + "/acceleration_m_per_s2", ScalarType::f64, {3}, "m/s^2");
    }
    if (schema.has(kDamping)) {
        schema.group(kDamping);
        schema.dataset(kDamping + "/mass_proportional_per_s", ScalarType::f64, {1}, "1/s");
    }
    if (schema.has(kSurface)) {
        schema.group(kSurface);
        const std::uint64_t triangles =
            schema.dataset(kSurface + "/triangles", ScalarType::u32, {kAnyExtent, 3}, "1");
        schema.limit(triangles, schema.limits().max_tetrahedra, "triangles", kSurface + "/triangles");
    }
    if (schema.has(kEmbedding)) check_embedding_shape(schema);
}

Asset take_asset(Schema& schema) {
    Asset asset;
    asset.name = schema.text_of(kAsset, "name");
    asset.level = schema.text_of(kAsset, "level");
    asset.nodes_m = schema.take<Point>(kMesh + "/nodes_m");
    asset.free_node_count = schema.number_of<std::uint32_t>(kMesh, "free_node_count");
    asset.tetrahedra = schema.take<Tetrahedron>(kMesh + "/tetrahedra");
    take_palette(schema, asset);
    if (schema.has(kTools))
        for (const std::string& tool : schema.children(kTools))
            asset.tools.push_back(take_tool_set(schema, kTools + "/" + tool));
    if (schema.has(kGravity))
        asset.gravity_m_per_s2 = schema.take_one<Point>(kGravity + "/acceleration_m_per_s2");
    if (schema.has(kDamping))
        asset.damping_per_s = schema.take_one<double>(kDamping + "/mass_proportional_per_s");
    if (schema.has(kSurface))
        asset.surface.triangles = schema.take<std::array<std::uint32_t, 3>>(kSurface + "/triangles");
    if (schema.has(kEmbedding)) asset.embedding = take_embedding(schema);
    return asset;
}

template <>
Result<Stored<Asset>> read_stored<Asset>(const std::filesystem::path& file, const ReadLimits& limits) {
    return read_kind<Asset>(file, limits, {FileKind::asset}, [&](Schema& schema, LoadedFile& loaded) {
        Asset asset = take_asset(schema);
        Schema provenance(loaded.provenance, file.string(), limits);
        asset.requests = take_requests(provenance);
        value_or_fail(validate(asset));
        return asset;
    });
}

Result<Asset> read_asset(const std::filesystem::path& file, const ReadLimits& limits) {
    return value_of(read_stored<Asset>(file, limits));
}

}  // namespace knead
