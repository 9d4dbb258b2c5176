// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/veg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>

#include "common/error.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

constexpr int kMaxIncludeDepth = 8;

/// A line with its content words, and where it stands.
struct VegLine {
    std::vector<std::string> words;  ///< never empty
    std::string place;               ///< "line 3", "shell.txt: line 3"
};

struct VegMaterial {
    std::string name;
    bool is_enu = false;
    double density = 0;
    double youngs_modulus = 0;
    double poissons_ratio = 0;
};

struct VegSet {
    std::string name;
    std::vector<std::int64_t> elements;  ///< positions, from 0
};

std::string upper(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

/// Blanks and commas separate words alike: VegaFEM uses both.
std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> words(1);
    for (const char c : line.substr(0, line.find('#'))) {
        if (c == ' ' || c == '\t' || c == '\r' || c == ',') {
            if (!words.back().empty()) words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

/// Lines of the file with those of its includes in their place, without comments and empty lines.
void collect_lines(std::string_view content, const std::string& name, const IncludeReader& include, int depth,
                   std::vector<VegLine>& lines) {
    TextReader reader(content);
    while (reader.bytes_left() > 0) {
        const std::size_t number = reader.line();
        VegLine line{split(reader.rest_of_line()),
                     fmt::format("{}line {}", name.empty() ? "" : name + ": ", number)};
        if (line.words.empty()) continue;
        if (upper(line.words[0]) != "*INCLUDE") {
            lines.push_back(std::move(line));
            continue;
        }
        if (line.words.size() != 2) fail_input(line.place + ": *INCLUDE needs one file name");
        if (line.words[1].find('\0') != std::string::npos)
            fail_input(line.place + ": *INCLUDE names a file with a zero byte in its name");
        if (depth == kMaxIncludeDepth) fail_input(line.place + ": files include each other too deeply");
        collect_lines(include(line.words[1]), line.words[1], include, depth + 1, lines);
    }
}

class VegReader {
  public:
    explicit VegReader(std::vector<VegLine> lines) : lines_(std::move(lines)) {}

    RawMesh read() {
        while (at_ < lines_.size())
            read_section();
        if (mesh_.nodes.empty()) fail_input("has no *VERTICES");
        if (!has_elements_) fail_input("has no *ELEMENTS");
        resolve_tetrahedra();
        assign_regions();
        return std::move(mesh_);
    }

  private:
    void read_section();
    void read_vertices();
    void read_elements();
    void read_set(const std::string& name);
    void read_material(const std::string& name);
    void read_region();
    void resolve_tetrahedra();
    void assign_regions();
    void make_arrays(const std::vector<std::optional<std::size_t>>& material_of);
    [[nodiscard]] std::vector<std::int64_t> elements_of(const std::string& set,
                                                        const std::string& place) const;

    [[noreturn]] static void fail(const VegLine& line, const std::string& text) {
        fail_input(line.place + ": " + text);
    }
    const VegLine& next(const char* what) {
        if (at_ >= lines_.size()) fail_input(std::string("the file ends where ") + what + " should follow");
        return lines_[at_++];
    }
    [[nodiscard]] bool in_section() const { return at_ < lines_.size() && lines_[at_].words[0][0] != '*'; }
    static std::int64_t integer(const VegLine& line, std::size_t word) {
        std::int64_t value = 0;
        if (word >= line.words.size() || !to_integer(line.words[word], value))
            fail(line, fmt::format("word {} should be an integer", word + 1));
        return value;
    }
    static double number(const VegLine& line, std::size_t word) {
        double value = 0;
        if (word >= line.words.size() || !to_number(line.words[word], value))
            fail(line, fmt::format("word {} should be a number", word + 1));
        return value;
    }

    struct RegionLine {
        std::string set, material, place;
    };

    std::vector<VegLine> lines_;
    std::size_t at_ = 0;
    RawMesh mesh_;
    bool has_elements_ = false;
    std::int64_t first_vertex_ = 1;
    std::int64_t first_element_ = 1;
    std::vector<VegSet> sets_;
    std::vector<VegMaterial> materials_;
    std::vector<RegionLine> regions_;
};

void VegReader::read_section() {
    const VegLine& line = next("a section");
    const std::string keyword = upper(line.words[0]);
    if (keyword == "*VERTICES") return read_vertices();
    if (keyword == "*ELEMENTS") return read_elements();
    if (keyword == "*REGION") return read_region();
    if (keyword == "*SET" || keyword == "*MATERIAL") {
        if (line.words.size() != 2) fail(line, keyword + " needs a name");
        return keyword == "*SET" ? read_set(line.words[1]) : read_material(line.words[1]);
    }
    fail(line, in_quotes(line.words[0]) + " is not a section of a VegaFEM file known here");
}

void VegReader::read_vertices() {
    const VegLine& header = next("the number of vertices");
    const std::int64_t count = integer(header, 0);
    if (header.words.size() > 1 && integer(header, 1) != 3) fail(header, "the mesh is not three-dimensional");
    if (!mesh_.nodes.empty()) fail(header, "a second *VERTICES");
    if (count < 1 || static_cast<std::uint64_t>(count) > lines_.size() - at_)
        fail(header, "the file has fewer lines than vertices");
    for (std::int64_t i = 0; i < count; ++i) {
        const VegLine& line = next("a vertex");
        if (line.words.size() != 4) fail(line, "a vertex is a number and three coordinates");
        const std::int64_t id = integer(line, 0);
        if (i == 0) first_vertex_ = id;
        if (first_vertex_ != 0 && first_vertex_ != 1)
            fail(line, "vertices must be numbered from 0 or from 1");
        if (id != first_vertex_ + i)
            fail(line, fmt::format("vertex {} should stand here", first_vertex_ + i));
        mesh_.nodes.push_back({number(line, 1), number(line, 2), number(line, 3)});
        mesh_.node_numbers.push_back(id);
    }
}

void VegReader::read_elements() {
    const VegLine& type = next("the type of the elements");
    const std::string name = upper(type.words[0]);
    const bool tetrahedra = name == "TET" || name == "TETS";
    const VegLine& header = next("the number of elements");
    const std::int64_t count = integer(header, 0);
    if (has_elements_) fail(header, "a second *ELEMENTS");
    has_elements_ = true;
    if (count < 1 || static_cast<std::uint64_t>(count) > lines_.size() - at_)
        fail(header, "the file has fewer lines than elements");
    if (!tetrahedra)
        mesh_.other_cells.emplace_back(
            name == "CUBIC" ? "cubes" : "elements of type " + in_quotes(type.words[0]), count);
    for (std::int64_t i = 0; i < count; ++i) {
        const VegLine& line = next("an element");
        if (!tetrahedra) continue;
        if (line.words.size() != 5) fail(line, "a tetrahedron is a number and four vertices");
        const std::int64_t id = integer(line, 0);
        if (i == 0) first_element_ = id;
        if (first_element_ != 0 && first_element_ != 1)
            fail(line, "elements must be numbered from 0 or from 1");
        if (id != first_element_ + i)
            fail(line, fmt::format("element {} should stand here", first_element_ + i));
        mesh_.tetrahedra.push_back({integer(line, 1), integer(line, 2), integer(line, 3), integer(line, 4)});
        mesh_.tetrahedron_numbers.push_back(id);
    }
}

void VegReader::read_set(const std::string& name) {
    VegSet set{name, {}};
    while (in_section()) {
        const VegLine& line = next("a set");
        for (std::size_t word = 0; word < line.words.size(); ++word)
            set.elements.push_back(integer(line, word));
    }
    sets_.push_back(std::move(set));
}

void VegReader::read_material(const std::string& name) {
    const VegLine& line = next("a material");
    VegMaterial material{name};
    material.is_enu = upper(line.words[0]) == "ENU";
    if (material.is_enu) {
        if (line.words.size() != 4)
            fail(line, "an ENU material is a density, a Young's modulus and a Poisson's ratio");
        material.density = number(line, 1);
        material.youngs_modulus = number(line, 2);
        material.poissons_ratio = number(line, 3);
    } else {
        mesh_.notes.push_back(
            {true, fmt::format("material {} is of type {}, not ENU: its values are left out", in_quotes(name),
                               in_quotes(line.words[0]))});
    }
    materials_.push_back(material);
}

void VegReader::read_region() {
    const VegLine& line = next("a region");
    if (line.words.size() != 2) fail(line, "a region is the name of a set and that of a material");
    regions_.push_back({line.words[0], line.words[1], line.place});
}

/// Only here, because the numbering of the vertices may come after the elements.
void VegReader::resolve_tetrahedra() {
    mesh_.numbering = fmt::format("numbered from {}", first_element_);
    for (auto& nodes : mesh_.tetrahedra)
        for (std::int64_t& node : nodes)
            node = position_of(node, first_vertex_);
}

std::vector<std::int64_t> VegReader::elements_of(const std::string& set, const std::string& place) const {
    const auto count = static_cast<std::int64_t>(mesh_.tetrahedra.size());
    std::vector<std::int64_t> elements;
    if (set == "allElements") {
        for (std::int64_t i = 0; i < count; ++i)
            elements.push_back(i);
        return elements;
    }
    const auto found =
        std::find_if(sets_.begin(), sets_.end(), [&](const VegSet& s) { return s.name == set; });
    if (found == sets_.end()) fail_input(place + ": there is no set " + in_quotes(set));
    for (const std::int64_t id : found->elements) {
        if (id < first_element_ || id - first_element_ >= count)
            fail_input(fmt::format("set {} names element {}; there are {}, numbered from {}", in_quotes(set),
                                   id, count, first_element_));
        elements.push_back(id - first_element_);
    }
    return elements;
}

void VegReader::assign_regions() {
    if (regions_.empty() || mesh_.tetrahedra.empty()) {
        if (!materials_.empty()) mesh_.notes.push_back({true, "materials without a *REGION are left out"});
        return;
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> region_of(mesh_.tetrahedra.size(), kNone);
    std::vector<std::optional<std::size_t>> material_of(mesh_.tetrahedra.size());
    Regions& regions = mesh_.regions;
    for (const RegionLine& region : regions_) {
        const auto material = std::find_if(materials_.begin(), materials_.end(),
                                           [&](const VegMaterial& m) { return m.name == region.material; });
        if (material == materials_.end())
            fail_input(region.place + ": there is no material " + in_quotes(region.material));
        if (std::find(regions.names.begin(), regions.names.end(), region.set) != regions.names.end())
            fail_input(region.place + ": a second region of set " + in_quotes(region.set));
        for (const std::int64_t element : elements_of(region.set, region.place)) {
            region_of[static_cast<std::size_t>(element)] = static_cast<std::uint32_t>(regions.names.size());
            material_of[static_cast<std::size_t>(element)] =
                static_cast<std::size_t>(material - materials_.begin());
        }
        regions.names.push_back(region.set);
    }
    const auto without = std::count(region_of.begin(), region_of.end(), kNone);
    if (without > 0) {
        const auto first = std::find(region_of.begin(), region_of.end(), kNone) - region_of.begin();
        fail_input(fmt::format("{} of {} elements are in no *REGION, the first is element {}", without,
                               region_of.size(), first + first_element_));
    }
    regions.region_of_tetrahedron = std::move(region_of);
    make_arrays(material_of);
}

void VegReader::make_arrays(const std::vector<std::optional<std::size_t>>& material_of) {
    CellArray youngs_modulus{"youngs_modulus_pa", {}};
    CellArray poissons_ratio{"poissons_ratio", {}};
    CellArray density{"density_kg_per_m3", {}};
    for (const auto& index : material_of) {
        const VegMaterial& material = materials_[*index];
        if (!material.is_enu) return;
        youngs_modulus.values.push_back(material.youngs_modulus);
        poissons_ratio.values.push_back(material.poissons_ratio);
        density.values.push_back(material.density);
    }
    mesh_.cell_arrays = {std::move(youngs_modulus), std::move(poissons_ratio), std::move(density)};
}

}  // namespace

RawMesh read_veg(std::string_view content, const IncludeReader& include) {
    std::vector<VegLine> lines;
    collect_lines(content, "", include, 0, lines);
    return VegReader(std::move(lines)).read();
}

}  // namespace knead::tools
