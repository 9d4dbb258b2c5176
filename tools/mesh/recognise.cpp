// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/recognise.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <utility>

#include "common/error.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

constexpr std::size_t kBinaryStlHeader = 84;
constexpr std::size_t kBinaryStlTriangle = 50;

bool starts_with_line(std::string_view content, std::string_view line) {
    if (!content.starts_with(line)) return false;
    const std::string_view rest = content.substr(line.size());
    return rest.empty() || rest.front() == '\n' || rest.front() == '\r';
}

/// 84 bytes of header that end in the number of triangles, and exactly that many triangles.
bool is_binary_stl(std::string_view content) {
    if (content.size() < kBinaryStlHeader) return false;
    const auto byte = [&](std::size_t i) {
        return std::uint64_t{static_cast<unsigned char>(content[80 + i])};
    };
    const std::uint64_t triangles = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
    return triangles > 0 && content.size() == kBinaryStlHeader + kBinaryStlTriangle * triangles;
}

bool is_brep(std::string_view content) {
    TextReader reader(content.substr(0, 4096));
    if (reader.peek() == "DBRep_DrawableShape") reader.next();
    return reader.next() == "CASCADE" && reader.next() == "Topology" && reader.next().starts_with("V");
}

bool is_veg(std::string_view content) {
    TextReader reader(content, '#');
    const std::string_view first = reader.peek();
    return first == "*VERTICES" || first == "*MATERIAL" || first == "*INCLUDE" || first == "*ELEMENTS" ||
           first == "*SET" || first == "*REGION";
}

/// The text between "$MeshFormat" and its end: version, 0 (text) or 1 (binary), size of a number.
bool is_binary_msh(std::string_view content) {
    const std::size_t start = content.find("$MeshFormat");
    if (start == std::string_view::npos) return false;  // version 1 is always text
    TextReader reader(content.substr(start, 256));
    reader.next();
    const double version = reader.number("the version of the MSH format");
    const std::int64_t type = reader.integer("the type of the MSH file");
    const std::int64_t size = reader.integer("the size of a number in the MSH file");
    if (!(version >= 2 && version < 5) || (type != 0 && type != 1) || size != 8)
        fail_input("MSH format " + std::to_string(version) + ", type " + std::to_string(type) + ", size " +
                   std::to_string(size) + " is not one of versions 1, 2 and 4");
    return type == 1;
}

/// Text MSH: sections one after the other, nothing else. A script appended to a mesh ends here.
void require_only_sections(std::string_view content) {
    TextReader reader(content);
    while (!reader.at_end()) {
        const std::string_view name = reader.next();
        if (name.size() < 2 || name.front() != '$' || name.starts_with("$End") || name.starts_with("$END"))
            reader.fail(in_quotes(name) + " stands outside of the sections of this MSH file");
        // "$NOD" ends in "$ENDNOD", "$Nodes" in "$EndNodes".
        const bool version_1 = name == "$NOD" || name == "$ELM" || name == "$NOE" || name == "$PTS";
        const std::string closing = (version_1 ? "$END" : "$End") + std::string(name.substr(1));
        reader.rest_of_line();
        for (;;) {
            if (reader.bytes_left() == 0) reader.fail("section " + in_quotes(name) + " has no " + closing);
            TextReader words(reader.rest_of_line());
            if (words.peek() == closing) break;
        }
    }
}

void require_sound_msh(std::string_view content) {
    if (!is_binary_msh(content)) require_only_sections(content);
    const bool version_1 = content.find("$NOD") != std::string_view::npos;
    const std::array<const char*, 4> needed =
        version_1 ? std::array<const char*, 4>{"$NOD", "$ENDNOD", "$ELM", "$ENDELM"}
                  : std::array<const char*, 4>{"$Nodes", "$EndNodes", "$Elements", "$EndElements"};
    for (const char* section : needed)
        if (content.find(section) == std::string_view::npos)
            fail_input(std::string("this MSH file has no ") + section + ": it holds no mesh, or was cut off");
}

void require_sound_step(std::string_view content) {
    if (content.find("END-ISO-10303-21;") == std::string_view::npos)
        fail_input("this STEP file has no END-ISO-10303-21: it was cut off");
}

[[noreturn]] void fail_unknown(std::string_view content) {
    constexpr const char* kKnown = "STEP, BREP, STL, PLY, MSH, Medit .mesh, VTK legacy, VegaFEM .veg";
    if (content.empty()) fail_input("the file is empty");
    if (content.starts_with("\x89HDF\r\n")) fail_input("is an HDF5 file; a mesh of Knead needs no import");
    const bool text =
        std::none_of(content.begin(), content.begin() + std::min<std::size_t>(content.size(), 512),
                     [](char c) { return c == 0; });
    const std::string start = text
                                  ? "a text that starts with " + in_quotes(TextReader(content).rest_of_line())
                                  : std::string("a binary file of an unknown kind");
    fail_input("is " + start + ", none of the formats knead-mesh imports (" + kKnown +
               "). Scripts of gmsh (.geo) are never run");
}

}  // namespace

const char* description(FileFormat format) {
    switch (format) {
        case FileFormat::step:
            return "a STEP file";
        case FileFormat::brep:
            return "a BREP file";
        case FileFormat::stl_text:
            return "a text STL file";
        case FileFormat::stl_binary:
            return "a binary STL file";
        case FileFormat::ply:
            return "a PLY file";
        case FileFormat::msh:
            return "a gmsh MSH file";
        case FileFormat::medit:
            return "a Medit mesh";
        case FileFormat::vtk:
            return "a legacy VTK file";
        case FileFormat::veg:
            return "a VegaFEM file";
    }
    return "a file";
}

bool needs_length_unit(FileFormat format) {
    return format != FileFormat::step;
}

FileFormat recognise(std::string_view content) {
    if (starts_with_line(content, "$MeshFormat") || starts_with_line(content, "$NOD") ||
        starts_with_line(content, "$Comments")) {
        require_sound_msh(content);
        return FileFormat::msh;
    }
    if (content.starts_with("ISO-10303-21;")) {
        require_sound_step(content);
        return FileFormat::step;
    }
    if (content.starts_with("# vtk DataFile Version ")) return FileFormat::vtk;
    if (starts_with_line(content, "ply")) return FileFormat::ply;
    // Before the text form: the header of a binary STL may well begin with "solid".
    if (is_binary_stl(content)) return FileFormat::stl_binary;
    if (TextReader(content).peek() == "solid") return FileFormat::stl_text;
    if (is_brep(content)) return FileFormat::brep;
    if (TextReader(content, '#').peek() == "MeshVersionFormatted") return FileFormat::medit;
    if (is_veg(content)) return FileFormat::veg;
    fail_unknown(content);
}

void require_matching_extension(FileFormat format, const std::string& extension) {
    using Promise = std::pair<const char*, std::array<FileFormat, 2>>;
    static constexpr Promise kPromises[] = {
        {".step", {FileFormat::step, FileFormat::step}},
        {".stp", {FileFormat::step, FileFormat::step}},
        {".brep", {FileFormat::brep, FileFormat::brep}},
        {".brp", {FileFormat::brep, FileFormat::brep}},
        {".stl", {FileFormat::stl_text, FileFormat::stl_binary}},
        {".ply", {FileFormat::ply, FileFormat::ply}},
        {".msh", {FileFormat::msh, FileFormat::msh}},
        {".mesh", {FileFormat::medit, FileFormat::medit}},
        {".vtk", {FileFormat::vtk, FileFormat::vtk}},
        {".veg", {FileFormat::veg, FileFormat::veg}},
    };
    std::string lower = extension;
    for (char& c : lower)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [promised, formats] : kPromises)
        if (lower == promised && format != formats[0] && format != formats[1])
            fail_input(std::string("holds ") + description(format) + ", but its name ends in " + extension +
                       ": rename it if the content is right");
}

}  // namespace knead::tools
