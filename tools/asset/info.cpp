// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset/info.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "asset/json.h"
#include "knead/formats/numerics.h"
#include "knead/formats/tool_names.h"

namespace knead::tools {
namespace {

std::string number(double value) {
    char buffer[64];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// "capsule of radius 0.005 m and half length 0.02 m, coulomb with friction 0.3"
std::string tool_text(const ToolSet& tool) {
    std::string text = name_of(tool.shape);
    const auto& half = tool.half_extents_m;
    if (tool.shape != ToolShape::plate) text += " of radius " + number(tool.radius_m) + " m";
    if (tool.shape == ToolShape::capsule) text += " and half length " + number(tool.half_length_m) + " m";
    if (half[0] > 0) text += " of half extents " + number(half[0]) + " m, " + number(half[1]) + " m";
    text += std::string(", ") + name_of(tool.contact);
    if (tool.contact == ToolContact::coulomb) text += " with friction " + number(tool.friction_coefficient);
    return text;
}

void write_tool(JsonWriter& json, const ToolSet& tool) {
    json.open_object().text("name", tool.name).text("shape", name_of(tool.shape));
    const auto& half = tool.half_extents_m;
    if (tool.shape != ToolShape::plate) json.number("radius_m", tool.radius_m);
    if (tool.shape == ToolShape::capsule) json.number("half_length_m", tool.half_length_m);
    if (half[0] > 0) json.open_array("half_extents_m").number("", half[0]).number("", half[1]).close_array();
    json.text("contact", name_of(tool.contact));
    if (tool.contact == ToolContact::coulomb) json.number("friction_coefficient", tool.friction_coefficient);
    json.number("nodes", std::uint64_t{tool.nodes.size()}).close_object();
}

std::string padded_left(const std::string& text, std::size_t width) {
    return std::string(width > text.size() ? width - text.size() : 0, ' ') + text;
}

std::string padded_right(const std::string& text, std::size_t width) {
    return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

std::string shape_of(const NodeInfo& node) {
    std::string text = node.type;
    for (std::size_t i = 0; i < node.extents.size(); ++i)
        text += (i == 0 ? " [" : ", ") + std::to_string(node.extents[i]);
    return node.extents.empty() ? text : text + "]";
}

std::string header_text(const FileInfo& file) {
    const FileHeader& header = file.header;
    const Provenance& made = header.provenance;
    std::string text = "kind            " + std::string(to_string(header.kind)) + ", format " +
                       std::to_string(header.format_version[0]) + "." +
                       std::to_string(header.format_version[1]) + "\n";
    for (const std::string& feature : header.required_features)
        text += "needs           " + feature + "\n";
    text += "content hash    " + header.content_hash + "\n";
    text += "made by         " + made.tool + " " + made.tool_version + ", seed " + std::to_string(made.seed) +
            "\n";
    for (const std::string& argument : made.arguments)
        text += "  argument      " + argument + "\n";
    for (const auto& [role, hash] : made.inputs)
        text += "  input         " + role + " " + hash + "\n";
    return text + "bytes           " + std::to_string(file.file_bytes) + "\n";
}

std::string asset_text(const Asset& asset) {
    std::string text = "scene           " + asset.name + ", level " + asset.level + "\n";
    text += "tetrahedra      " + std::to_string(asset.tetrahedra.size()) + "\n";
    text += "nodes           " + std::to_string(asset.nodes_m.size()) + ", " +
            std::to_string(asset.free_node_count) + " of them free\n";
    for (std::size_t i = 0; i < asset.palette.size(); ++i) {
        const PaletteEntry& entry = asset.palette[i];
        const auto users = std::count(asset.palette_index.begin(), asset.palette_index.end(), i);
        text += "material " + padded_right(std::to_string(i), 7) + "E " + number(entry.youngs_modulus_pa) +
                " Pa, nu " + number(entry.poissons_ratio) + ", density " + number(entry.density_kg_per_m3) +
                " kg/m^3, " + std::to_string(users) + " tetrahedra\n";
    }
    text += "numerics        " + to_text(choose_numerics(asset)) + "\n";
    for (const ToolSet& tool : asset.tools)
        text += "tool            " + tool.name + ": " + tool_text(tool) + ", " +
                std::to_string(tool.nodes.size()) + " nodes\n";
    const SurfaceEmbedding& embedding = asset.embedding;
    if (!embedding.triangles.empty())
        text += "embedding       " + std::to_string(embedding.vertex_count()) + " vertices, " +
                std::to_string(embedding.still_vertices_m.size()) + " of them still, " +
                std::to_string(embedding.triangles.size()) + " triangles\n";
    return text;
}

std::string node_lines(const Description& description) {
    std::string text = "\n     bytes  group or dataset\n";
    for (const NodeInfo& node : description.file.nodes) {
        std::string line = padded_left(std::to_string(node.bytes_on_disk), 10) + "  ";
        const auto depth = static_cast<std::size_t>(std::count(node.path.begin(), node.path.end(), '/')) - 1;
        line += std::string(2 * depth, ' ') + node.path.substr(node.path.rfind('/') + 1);
        if (node.is_group) line += "/";
        if (!node.is_group) line = padded_right(line, 48) + "  " + shape_of(node) + "  " + node.units;
        for (const auto& [name, value] : node.attributes)
            line += "  " + name + "=" + value;
        if (description.asset && node.is_group)
            if (const Asset::Request* request = request_for(*description.asset, node.path))
                line = padded_right(line, 48) + "  asked for by " + request->scene_key + " (line " +
                       std::to_string(request->scene_line) + ")";
        text += line + "\n";
    }
    return text + padded_left(std::to_string(description.file.other_bytes), 10) +
           "  the rest: HDF5's own, provenance, what ParaView needs\n";
}

void write_provenance(JsonWriter& json, const Provenance& made) {
    json.open_object("provenance").text("tool", made.tool).text("tool_version", made.tool_version);
    json.number("seed", made.seed).open_array("arguments");
    for (const std::string& argument : made.arguments)
        json.text("", argument);
    json.close_array().open_array("inputs");
    for (const auto& [role, hash] : made.inputs)
        json.open_object().text("role", role).text("content_hash", hash).close_object();
    json.close_array().close_object();
}

void write_numerics(JsonWriter& json, const Numerics& numerics) {
    json.open_object("numerics")
        .text("arithmetic", to_string(numerics.arithmetic))
        .text("arithmetic_reason", to_string(numerics.arithmetic_reason))
        .text("preconditioner", to_string(numerics.preconditioner))
        .text("preconditioner_reason", to_string(numerics.preconditioner_reason))
        .text("factor_storage", to_string(numerics.factor_storage))
        .text("storage_reason", to_string(numerics.storage_reason))
        .number("contrast", numerics.contrast)
        .number("press_contrast", numerics.press_contrast)
        .number("max_poissons_ratio", numerics.max_poissons_ratio)
        .close_object();
}

void write_asset(JsonWriter& json, const Asset& asset) {
    json.open_object("asset").text("name", asset.name).text("level", asset.level);
    json.number("tetrahedra", std::uint64_t{asset.tetrahedra.size()});
    json.number("nodes", std::uint64_t{asset.nodes_m.size()});
    json.number("free_nodes", std::uint64_t{asset.free_node_count}).open_array("palette");
    for (const PaletteEntry& entry : asset.palette)
        json.open_object()
            .number("youngs_modulus_pa", entry.youngs_modulus_pa)
            .number("poissons_ratio", entry.poissons_ratio)
            .number("density_kg_per_m3", entry.density_kg_per_m3)
            .close_object();
    json.close_array();
    write_numerics(json, choose_numerics(asset));
    json.open_array("tools");
    for (const ToolSet& tool : asset.tools)
        write_tool(json, tool);
    json.close_array();
    if (const SurfaceEmbedding& embedding = asset.embedding; !embedding.triangles.empty())
        json.open_object("embedding")
            .number("vertices", std::uint64_t{embedding.vertex_count()})
            .number("still_vertices", std::uint64_t{embedding.still_vertices_m.size()})
            .number("triangles", std::uint64_t{embedding.triangles.size()})
            .close_object();
    json.close_object();
}

void write_node(JsonWriter& json, const Description& description, const NodeInfo& node) {
    json.open_object().text("path", node.path).text("is", node.is_group ? "group" : "dataset");
    json.number("bytes_on_disk", node.bytes_on_disk);
    if (!node.is_group) {
        json.text("type", node.type).text("units", node.units).open_array("extents");
        for (const std::uint64_t extent : node.extents)
            json.number("", extent);
        json.close_array();
    }
    json.open_object("attributes");
    for (const auto& [name, value] : node.attributes)
        json.text(name, value);
    json.close_object();
    if (description.asset && node.is_group)
        if (const Asset::Request* request = request_for(*description.asset, node.path))
            json.text("scene_key", request->scene_key)
                .number("scene_line", std::uint64_t{request->scene_line});
    json.close_object();
}

}  // namespace

const Asset::Request* request_for(const Asset& asset, const std::string& path) {
    for (std::string at = path; !at.empty(); at.resize(at.rfind('/')))
        for (const Asset::Request& request : asset.requests)
            if (request.group == at) return &request;
    return nullptr;
}

std::string info_text(const Description& description) {
    std::string text = header_text(description.file);
    if (description.asset) text += asset_text(*description.asset);
    return text + node_lines(description);
}

std::string info_json(const Description& description) {
    const FileHeader& header = description.file.header;
    JsonWriter json;
    json.open_object().text("kind", to_string(header.kind));
    json.text("format_version",
              std::to_string(header.format_version[0]) + "." + std::to_string(header.format_version[1]));
    json.open_array("required_features");
    for (const std::string& feature : header.required_features)
        json.text("", feature);
    json.close_array();
    json.text("content_hash", header.content_hash).number("bytes", description.file.file_bytes);
    write_provenance(json, header.provenance);
    if (description.asset) write_asset(json, *description.asset);
    json.open_array("nodes");
    for (const NodeInfo& node : description.file.nodes)
        write_node(json, description, node);
    json.close_array().number("other_bytes", description.file.other_bytes).close_object();
    return json.take();
}

}  // namespace knead::tools
