// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset/export_mesh.h"
#include "knead/formats/asset_object.h"

#include <charconv>
#include <set>
#include <utility>

namespace knead::tools {
namespace {

constexpr int kVtkTetrahedron = 10;
constexpr int kGmshTetrahedron = 4;

template <class T>
void append(std::string& text, T value, char end) {
    char buffer[64];
    text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
    text += end;
}

void append_value(std::string& text, const ExportField& field, std::size_t i, char end) {
    if (field.whole_numbers)
        append(text, static_cast<std::uint64_t>(field.values[i]), end);
    else
        append(text, field.values[i], end);
}

ExportField index_field(const std::string& name, const std::vector<std::uint32_t>& index) {
    return {name, {index.begin(), index.end()}, true};
}

void add_material(ExportMesh& mesh, const Material& material) {
    mesh.fields.push_back({"youngs_modulus_pa", material.youngs_modulus_pa});
    mesh.fields.push_back({"poissons_ratio", material.poissons_ratio});
    mesh.fields.push_back({"density_kg_per_m3", material.density_kg_per_m3});
}

/// VTK's reader crashes on two arrays of one name. Arrays that came with the mesh stand first and give way.
ExportMesh with_unique_names(ExportMesh mesh) {
    std::set<std::string> taken;
    for (std::size_t i = mesh.fields.size(); i-- > 0;) {
        const std::string name = mesh.fields[i].name;
        for (int k = 2; !taken.insert(mesh.fields[i].name).second; ++k)
            mesh.fields[i].name = name + "_" + std::to_string(k);
    }
    return mesh;
}

ExportMesh raw_mesh(const TetMesh& mesh) {
    ExportMesh out{mesh.nodes_m, mesh.tetrahedra, mesh.regions.names, mesh.regions.region_of_tetrahedron, {}};
    for (const CellArray& array : mesh.cell_arrays)
        out.fields.push_back({array.name, array.values});
    if (!out.region_of_tetrahedron.empty())
        out.fields.push_back(index_field("region", out.region_of_tetrahedron));
    return out;
}

std::string xml_escaped(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return escaped;
}

/// A name between quotes in a line of a .msh file: neither quotes nor line ends fit there.
std::string msh_name(const std::string& text) {
    std::string name;
    for (const char c : text)
        name += (c == '"' || static_cast<unsigned char>(c) < 0x20) ? '_' : c;
    return name;
}

void append_vtu_fields(std::string& text, const ExportMesh& mesh) {
    text += "<CellData>\n";
    for (const ExportField& field : mesh.fields) {
        text += std::string("<DataArray type=\"") + (field.whole_numbers ? "UInt32" : "Float64") +
                "\" Name=\"" + xml_escaped(field.name) + "\" format=\"ascii\">\n";
        for (std::size_t i = 0; i < field.values.size(); ++i)
            append_value(text, field, i, '\n');
        text += "</DataArray>\n";
    }
    text += "</CellData>\n";
}

void append_msh_elements(std::string& text, const ExportMesh& mesh) {
    text += "$Elements\n";
    append(text, mesh.tetrahedra.size(), '\n');
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
        const std::uint64_t tag =
            mesh.region_of_tetrahedron.empty() ? 1 : mesh.region_of_tetrahedron[i] + 1ULL;
        append(text, i + 1, ' ');
        append(text, kGmshTetrahedron, ' ');
        text += "2 ";
        append(text, tag, ' ');
        append(text, tag, ' ');
        for (int k = 0; k < 4; ++k)
            append(text, mesh.tetrahedra[i][k] + 1ULL, k == 3 ? '\n' : ' ');
    }
    text += "$EndElements\n";
}

void append_msh_field(std::string& text, const ExportField& field) {
    text += "$ElementData\n1\n\"" + msh_name(field.name) + "\"\n1\n0\n3\n0\n1\n";
    append(text, field.values.size(), '\n');
    for (std::size_t i = 0; i < field.values.size(); ++i) {
        append(text, i + 1, ' ');
        append_value(text, field, i, '\n');
    }
    text += "$EndElementData\n";
}

}  // namespace

ExportMesh export_mesh(const TetMesh& mesh) {
    return with_unique_names(raw_mesh(mesh));
}

ExportMesh export_mesh(const MaterialObject& object) {
    ExportMesh out = raw_mesh(object.mesh);
    add_material(out, object.material);
    const auto& bin = object.material.bin_of_tetrahedron;
    if (!bin.empty()) out.fields.push_back(index_field("bin", bin));
    return with_unique_names(std::move(out));
}

ExportMesh export_mesh(const ClusteredObject& object) {
    ExportMesh out = raw_mesh(object.mesh);
    add_material(out, object.material);
    out.fields.push_back(index_field("bin", object.clustering.bin_of_tetrahedron));
    out.fields.push_back(index_field("cluster", object.clustering.cluster_of_tetrahedron));
    return with_unique_names(std::move(out));
}

ExportMesh export_mesh(const Asset& asset) {
    ExportMesh out{asset.nodes_m, asset.tetrahedra, {}, {}, {}};
    add_material(out, object_of(asset).material);
    out.fields.push_back(index_field("material_index", asset.palette_index));
    return out;
}

std::string vtu_text(const ExportMesh& mesh) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n"
        "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
        std::to_string(mesh.nodes_m.size()) + "\" NumberOfCells=\"" + std::to_string(mesh.tetrahedra.size()) +
        "\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
    for (const Point& p : mesh.nodes_m)
        for (int axis = 0; axis < 3; ++axis)
            append(text, p[axis], axis == 2 ? '\n' : ' ');
    text +=
        "</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" "
        "format=\"ascii\">\n";
    for (const Tetrahedron& t : mesh.tetrahedra)
        for (int k = 0; k < 4; ++k)
            append(text, t[k], k == 3 ? '\n' : ' ');
    text += "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    for (std::size_t i = 1; i <= mesh.tetrahedra.size(); ++i)
        append(text, 4 * i, '\n');
    text += "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n";
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
        append(text, kVtkTetrahedron, '\n');
    text += "</DataArray>\n</Cells>\n";
    append_vtu_fields(text, mesh);
    return text + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string msh_text(const ExportMesh& mesh) {
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    if (!mesh.region_names.empty()) {
        text += "$PhysicalNames\n" + std::to_string(mesh.region_names.size()) + "\n";
        for (std::size_t i = 0; i < mesh.region_names.size(); ++i)
            text += "3 " + std::to_string(i + 1) + " \"" + msh_name(mesh.region_names[i]) + "\"\n";
        text += "$EndPhysicalNames\n";
    }
    text += "$Nodes\n";
    append(text, mesh.nodes_m.size(), '\n');
    for (std::size_t i = 0; i < mesh.nodes_m.size(); ++i) {
        append(text, i + 1, ' ');
        for (int axis = 0; axis < 3; ++axis)
            append(text, mesh.nodes_m[i][axis], axis == 2 ? '\n' : ' ');
    }
    text += "$EndNodes\n";
    append_msh_elements(text, mesh);
    for (const ExportField& field : mesh.fields)
        append_msh_field(text, field);
    return text;
}

}  // namespace knead::tools
