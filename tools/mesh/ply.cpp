// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <string>

#include "common/error.h"
#include "mesh/scalar_type.h"
#include "mesh/surface.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

enum class PlyEncoding { text, little_endian, big_endian };

struct PlyProperty {
    std::string name;
    ScalarType type = ScalarType::none;
    ScalarType count_type = ScalarType::none;  ///< none: one value, not a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::text;
    std::vector<PlyElement> elements;
};

ScalarType read_type(TextReader& reader) {
    const std::string_view name = reader.word("a number type");
    const ScalarType type = ply_type(name);
    if (type == ScalarType::none) reader.fail(in_quotes(name) + " is not a number type of PLY");
    return type;
}

PlyEncoding read_encoding(TextReader& reader) {
    const std::string_view name = reader.word("the encoding");
    const std::string_view version = reader.word("the version");
    if (version != "1.0") reader.fail("version " + in_quotes(version) + " of PLY is not known");
    if (name == "ascii") return PlyEncoding::text;
    if (name == "binary_little_endian") return PlyEncoding::little_endian;
    if (name == "binary_big_endian") return PlyEncoding::big_endian;
    reader.fail(in_quotes(name) + " is not an encoding of PLY");
}

void read_property(TextReader& reader, PlyHeader& header) {
    if (header.elements.empty()) reader.fail("a property before the first element");
    PlyProperty property;
    if (reader.peek() == "list") {
        reader.next();
        property.count_type = read_type(reader);
    }
    property.type = read_type(reader);
    property.name = reader.word("a name");
    header.elements.back().properties.push_back(property);
}

PlyHeader read_header(TextReader& reader) {
    PlyHeader header;
    bool encoded = false;
    reader.next();  // "ply"
    for (;;) {
        const std::string_view keyword = reader.word("the header");
        if (keyword == "end_header") break;
        if (keyword == "comment" || keyword == "obj_info") {
            reader.rest_of_line();
        } else if (keyword == "format") {
            header.encoding = read_encoding(reader);
            encoded = true;
        } else if (keyword == "element") {
            PlyElement element;
            element.name = reader.word("a name");
            // A second list of vertices without properties would grow for nothing: a small file, much memory.
            for (const PlyElement& earlier : header.elements)
                if (earlier.name == element.name) reader.fail("a second element " + in_quotes(element.name));
            element.count = reader.count("the number of elements");
            header.elements.push_back(element);
        } else if (keyword == "property") {
            read_property(reader, header);
        } else {
            reader.fail(in_quotes(keyword) + " does not belong in the header of a PLY file");
        }
    }
    if (!encoded) reader.fail("the header of the PLY file has no format line");
    reader.rest_of_line();  // the data begin right after the line end
    return header;
}

double read_value(TextReader& reader, PlyEncoding encoding, ScalarType type) {
    if (encoding == PlyEncoding::text) return reader.number("a value");
    return decode(type, reader.raw(size_of(type), "the data").data(), encoding == PlyEncoding::big_endian);
}

/// The polygon's values; a negative or fractional or absurd count is refused.
std::vector<double> read_list(TextReader& reader, PlyEncoding encoding, const PlyProperty& property) {
    const double count = read_value(reader, encoding, property.count_type);
    if (!(count >= 0 && count <= static_cast<double>(reader.bytes_left())) ||
        count != static_cast<double>(static_cast<std::size_t>(count)))
        reader.fail("a list of an impossible length");
    std::vector<double> values(static_cast<std::size_t>(count));
    for (double& value : values)
        value = read_value(reader, encoding, property.type);
    return values;
}

struct PlyData {
    std::vector<Point> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t split_polygons = 0;
};

/// Cuts a polygon into a fan around its first corner.
void add_polygon(const TextReader& reader, const std::vector<double>& corners, PlyData& data) {
    if (corners.size() < 3) reader.fail("a face with fewer than three corners");
    std::vector<std::uint32_t> indices;
    for (const double corner : corners) {
        if (!(corner >= 0 && corner < static_cast<double>(data.vertices.size())) ||
            corner != static_cast<double>(static_cast<std::uint32_t>(corner)))
            reader.fail(fmt::format("a face names vertex {:g} of {} (from 0)", corner, data.vertices.size()));
        indices.push_back(static_cast<std::uint32_t>(corner));
    }
    for (std::size_t i = 1; i + 1 < indices.size(); ++i)
        data.triangles.push_back({indices[0], indices[i], indices[i + 1]});
    if (indices.size() > 3) ++data.split_polygons;
}

void read_element(TextReader& reader, PlyEncoding encoding, const PlyElement& element, PlyData& data) {
    const bool is_vertex = element.name == "vertex";
    const bool is_face = element.name == "face";
    if (element.name == "tristrips")
        reader.fail("triangle strips are not supported; save the file with faces");
    for (std::size_t i = 0; i < element.count; ++i) {
        Point point{};
        for (const PlyProperty& property : element.properties) {
            if (property.count_type != ScalarType::none) {
                const std::vector<double> values = read_list(reader, encoding, property);
                if (is_face && (property.name == "vertex_indices" || property.name == "vertex_index"))
                    add_polygon(reader, values, data);
                continue;
            }
            const double value = read_value(reader, encoding, property.type);
            if (is_vertex && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
                point[static_cast<std::size_t>(property.name[0] - 'x')] = value;
        }
        if (is_vertex) data.vertices.push_back(point);
    }
}

void require_vertices_with_coordinates(const TextReader& reader, const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
        if (element.name != "vertex") continue;
        int coordinates = 0;
        for (const PlyProperty& property : element.properties)
            if (property.name == "x" || property.name == "y" || property.name == "z") ++coordinates;
        if (coordinates == 3) return;
    }
    reader.fail("the PLY file has no vertices with x, y and z");
}

}  // namespace

TriangleSurface read_ply(std::string_view content) {
    TextReader reader(content);
    const PlyHeader header = read_header(reader);
    require_vertices_with_coordinates(reader, header);
    PlyData data;
    for (const PlyElement& element : header.elements)
        read_element(reader, header.encoding, element, data);
    const bool clean_end = header.encoding == PlyEncoding::text ? reader.at_end() : reader.bytes_left() == 0;
    if (!clean_end) reader.fail("the file goes on after the data that its header announces");
    std::vector<Point> corners;
    corners.reserve(3 * data.triangles.size());
    for (const auto& triangle : data.triangles)
        for (const std::uint32_t index : triangle)
            corners.push_back(data.vertices[index]);
    TriangleSurface surface = join_corners(corners);
    if (data.split_polygons > 0)
        surface.notes.push_back(
            {false,
             fmt::format("{} faces with more than three corners cut into triangles", data.split_polygons)});
    return surface;
}

}  // namespace knead::tools
