// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "names.h"
#include "read_kind.h"

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

void check_material_palette_shape(Schema& schema, std::uint64_t tetrahedra) {
    schema.group(kAsset + "/material");
    schema.group(kPalette);
    const std::uint64_t entries =
        schema.dataset(kPalette + "/youngs_modulus_pa", ScalarType::f64, {kAnyExtent}, "Pa");
    schema.dataset(kPalette + "/poissons_ratio", ScalarType::f64, {entries}, "1");
    schema.dataset(kPalette + "/density_kg_per_m3", ScalarType::f64, {entries}, "kg/m^3");
    schema.index_dataset(kPaletteIndex, {tetrahedra});
}

void check_tool_set_shape(Schema& schema, const std::string& tool) {
    schema.group(tool);
    for (const char* name : {"name", "shape", "contact"})
        schema.text_attribute(tool, name);
    schema.dataset(tool + "/rest_position_m", ScalarType::f64, {3}, "m");
    schema.dataset(tool + "/rest_orientation_wxyz", ScalarType::f64, {4}, "1");
    schema.dataset(tool + "/nodes", ScalarType::u32, {kAnyExtent}, "1");
    // Which of the two belongs to the shape is known only from the data: at least one of them must be there.
    const bool has_radius = schema.has(tool + "/radius_m");
    if (has_radius) schema.dataset(tool + "/radius_m", ScalarType::f64, {1}, "m");
    if (!has_radius || schema.has(tool + "/half_extents_m"))
        schema.dataset(tool + "/half_extents_m", ScalarType::f64, {2}, "m");
}

template <class Enum, std::size_t N>
Enum enumerator(Schema& schema, const std::string& tool, const char* attribute,
                const std::array<const char*, N>& names) {
    const std::string text = schema.text_of(tool, attribute);
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        fail(ErrorCode::invalid_data, "\"" + text + "\" is not a " + attribute, tool + "@" + attribute);
    return static_cast<Enum>(found - names.begin());
}

ToolSet take_tool_set(Schema& schema, const std::string& tool) {
    ToolSet set;
    set.name = schema.text_of(tool, "name");
    set.shape = enumerator<ToolShape>(schema, tool, "shape", kToolShapes);
    set.contact = enumerator<ToolContact>(schema, tool, "contact", kToolContacts);
    const bool sphere = set.shape == ToolShape::sphere;
    const std::string size = tool + (sphere ? "/radius_m" : "/half_extents_m");
    if (!schema.has(size)) fail(ErrorCode::missing, "is not in the file", size);
    if (sphere)
        set.radius_m = schema.take_one<double>(size);
    else
        set.half_extents_m = schema.take_one<std::array<double, 2>>(size);
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
    return asset;
}

Result<Asset> read_asset(const std::filesystem::path& file, const ReadLimits& limits) {
    return read_kind(file, limits, {FileKind::asset}, [&](Schema& schema, LoadedFile& loaded) {
        Asset asset = take_asset(schema);
        Schema provenance(loaded.provenance, file.string(), limits);
        asset.requests = take_requests(provenance);
        value_or_fail(validate(asset));
        return asset;
    });
}

}  // namespace knead
