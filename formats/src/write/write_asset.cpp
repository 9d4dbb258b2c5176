// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "../required_features.h"
#include "encode.h"
#include "knead/formats/tool_names.h"

namespace knead {
namespace {

const std::string kAsset = "/knead/asset";

/// The narrowest unsigned type that counts up to the palette's size.
Value narrow_index(const std::vector<std::uint32_t>& index, std::size_t palette_size) {
    if (palette_size <= 256) {
        const std::vector<std::uint8_t> bytes(index.begin(), index.end());
        return copy_of(std::span<const std::uint8_t>(bytes), {bytes.size()});
    }
    if (palette_size <= 65536) {
        const std::vector<std::uint16_t> words(index.begin(), index.end());
        return copy_of(std::span<const std::uint16_t>(words), {words.size()});
    }
    return view_1d(index);
}

void encode_palette(Payload& payload, const Asset& asset) {
    const std::string group = kAsset + "/material", palette = group + "/palette";
    std::vector<double> moduli, ratios, densities;
    for (const PaletteEntry& entry : asset.palette) {
        moduli.push_back(entry.youngs_modulus_pa);
        ratios.push_back(entry.poissons_ratio);
        densities.push_back(entry.density_kg_per_m3);
    }
    const auto add = [&](const char* name, const std::vector<double>& values, const char* units) {
        payload.add_dataset(palette + "/" + name, copy_of(std::span<const double>(values), {values.size()}),
                            units);
    };
    payload.add_group(group);
    payload.add_group(palette);
    add("youngs_modulus_pa", moduli, "Pa");
    add("poissons_ratio", ratios, "1");
    add("density_kg_per_m3", densities, "kg/m^3");
    payload.add_dataset(group + "/palette_index", narrow_index(asset.palette_index, asset.palette.size()),
                        "1");
}

void encode_tool(Payload& payload, const ToolSet& tool, const std::string& path) {
    Node& node = payload.add_group(path);
    node.attributes["name"] = text_value(tool.name);
    node.attributes["shape"] = text_value(name_of(tool.shape));
    node.attributes["contact"] = text_value(name_of(tool.contact));
    const auto add_number = [&](const char* dataset, double value, const char* units) {
        payload.add_dataset(path + "/" + dataset, copy_1d(std::array<double, 1>{value}), units);
    };
    if (tool.shape == ToolShape::plate)
        payload.add_dataset(path + "/half_extents_m", copy_1d(tool.half_extents_m), "m");
    else
        add_number("radius_m", tool.radius_m, "m");
    if (tool.shape == ToolShape::capsule) add_number("half_length_m", tool.half_length_m, "m");
    if (tool.contact == ToolContact::coulomb)
        add_number("friction_coefficient", tool.friction_coefficient, "1");
    payload.add_dataset(path + "/rest_position_m", copy_1d(tool.rest_position_m), "m");
    payload.add_dataset(path + "/rest_orientation_wxyz", copy_1d(tool.rest_orientation_wxyz), "1");
    payload.add_dataset(path + "/nodes", view_1d(tool.nodes), "1");
}

void encode_embedding(Payload& payload, const SurfaceEmbedding& embedding, const std::string& group) {
    payload.add_group(group);
    payload.add_dataset(group + "/tetrahedron", view_1d(embedding.tetrahedron), "1");
    payload.add_dataset(group + "/weights", view_2d(embedding.weights), "1");
    if (!embedding.still_vertices_m.empty())
        payload.add_dataset(group + "/still_vertices_m", view_2d(embedding.still_vertices_m), "m");
    payload.add_dataset(group + "/triangles", view_2d(embedding.triangles), "1");
}

/// Groups that exist only when they say something.
void encode_optional_groups(Payload& payload, const Asset& asset) {
    if (!asset.tools.empty()) payload.add_group(kAsset + "/tools");
    for (std::size_t i = 0; i < asset.tools.size(); ++i)
        encode_tool(payload, asset.tools[i], kAsset + "/tools/" + list_name(i));
    if (asset.gravity_m_per_s2 != Point{}) {
        payload.add_group(kAsset + "/gravity");
        payload.add_dataset(kAsset + "/gravity/acceleration_m_per_s2", copy_1d(asset.gravity_m_per_s2),
                            "m/s^2");
    }
    if (asset.damping_per_s != 0) {
        payload.add_group(kAsset + "/damping");
        payload.add_dataset(kAsset + "/damping/mass_proportional_per_s",
                            copy_1d(std::array<double, 1>{asset.damping_per_s}), "1/s");
    }
    if (!asset.surface.triangles.empty()) {
        payload.add_group(kAsset + "/surface");
        payload.add_dataset(kAsset + "/surface/triangles", view_2d(asset.surface.triangles), "1");
    }
    if (!asset.embedding.triangles.empty()) encode_embedding(payload, asset.embedding, kAsset + "/embedding");
}

/// Readers of format 1.0 take neither for something they know: they are to refuse by name.
std::vector<std::string> required_features(const Asset& asset) {
    const auto any = [&](auto&& has) { return std::any_of(asset.tools.begin(), asset.tools.end(), has); };
    std::vector<std::string> features;
    if (any([](const ToolSet& tool) { return tool.shape == ToolShape::capsule; }))
        features.emplace_back(kCapsuleFeature);
    if (any([](const ToolSet& tool) { return tool.contact == ToolContact::coulomb; }))
        features.emplace_back(kCoulombFeature);
    return features;
}

/// Requests stand outside the content hash: a comment added to the scene moves its lines, not the asset.
void encode_requests(Payload& provenance, const std::vector<Asset::Request>& requests) {
    if (requests.empty()) return;
    std::vector<std::string> groups, keys;
    std::vector<std::uint32_t> lines;
    for (const Asset::Request& request : requests) {
        groups.push_back(request.group);
        keys.push_back(request.scene_key);
        lines.push_back(request.scene_line);
    }
    const std::string group = "/provenance/requests";
    provenance.add_group(group);
    provenance.add_dataset(group + "/groups", text_array(groups), "none");
    provenance.add_dataset(group + "/scene_keys", text_array(keys), "none");
    provenance.add_dataset(group + "/scene_lines",
                           copy_of(std::span<const std::uint32_t>(lines), {lines.size()}), "1");
}

}  // namespace

Status write_asset(const std::filesystem::path& file, const Asset& asset, const Provenance& provenance) {
    return write_kind(file, FileKind::asset, provenance, [&](FilePlan& plan) {
        value_or_fail(validate(asset));
        const std::string mesh = kAsset + "/mesh";
        Node& node = plan.payload.add_group(kAsset);
        node.attributes["name"] = text_value(asset.name);
        node.attributes["level"] = text_value(asset.level);
        encode_nodes_and_tetrahedra(plan.payload, mesh, asset.nodes_m, asset.tetrahedra);
        plan.payload.nodes[mesh].attributes["free_node_count"] = scalar(asset.free_node_count);
        encode_palette(plan.payload, asset);
        encode_optional_groups(plan.payload, asset);
        plan.required_features = required_features(asset);
        encode_requests(plan.provenance, asset.requests);
        plan.vtk = VtkPart{mesh + "/nodes_m",
                           mesh + "/tetrahedra",
                           {{"material_index", kAsset + "/material/palette_index"}}};
    });
}

}  // namespace knead
