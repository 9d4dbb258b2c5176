// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "common/error.h"
#include "mesh/surface.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

void expect(TextReader& reader, const char* wanted) {
    const std::string_view found = reader.word(wanted);
    if (found != wanted)
        reader.fail(fmt::format("\"{}\" should stand here, not {}", wanted, in_quotes(found)));
}

Point read_point(TextReader& reader) {
    const double x = reader.number("a coordinate");
    const double y = reader.number("a coordinate");
    return {x, y, reader.number("a coordinate")};
}

/// After "facet": normal (unused, often wrong in practice), three corners.
void read_facet(TextReader& reader, std::vector<Point>& corners) {
    expect(reader, "normal");
    for (int i = 0; i < 3; ++i)
        reader.word("a normal");
    expect(reader, "outer");
    expect(reader, "loop");
    for (int i = 0; i < 3; ++i) {
        expect(reader, "vertex");
        corners.push_back(read_point(reader));
    }
    expect(reader, "endloop");
    expect(reader, "endfacet");
}

}  // namespace

TriangleSurface read_stl_text(std::string_view content) {
    TextReader reader(content);
    std::vector<Point> corners;
    while (!reader.at_end()) {
        expect(reader, "solid");
        reader.rest_of_line();  // the solid's name
        while (reader.peek() == "facet") {
            reader.next();
            read_facet(reader, corners);
        }
        expect(reader, "endsolid");
        reader.rest_of_line();
    }
    return join_corners(corners);
}

TriangleSurface read_stl_binary(std::string_view content) {
    static_assert(std::endian::native == std::endian::little, "STL numbers are little-endian");
    constexpr std::size_t kHeader = 84;
    constexpr std::size_t kTriangle = 50;  // normal and three corners of three floats, two bytes unused
    if (content.size() < kHeader || (content.size() - kHeader) % kTriangle != 0)
        fail_input("the binary STL file was cut off");
    std::vector<Point> corners;
    corners.reserve((content.size() - kHeader) / kTriangle * 3);
    for (std::size_t at = kHeader; at < content.size(); at += kTriangle) {
        float values[12];
        std::memcpy(values, content.data() + at, sizeof(values));
        for (int corner = 1; corner <= 3; ++corner)
            corners.push_back({values[3 * corner], values[3 * corner + 1], values[3 * corner + 2]});
    }
    return join_corners(corners);
}

}  // namespace knead::tools
