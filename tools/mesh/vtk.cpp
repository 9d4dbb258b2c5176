// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/vtk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "common/error.h"
#include "mesh/scalar_type.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

constexpr int kVtkTetra = 10;
constexpr double kLargestType = 255;

std::string cell_type_name(int type) {
    static const std::map<int, const char*> kNames{{1, "vertices"},
                                                   {2, "polyvertices"},
                                                   {3, "lines"},
                                                   {4, "polylines"},
                                                   {5, "triangles"},
                                                   {6, "strips"},
                                                   {7, "polygons"},
                                                   {8, "pixels"},
                                                   {9, "quadrangles"},
                                                   {11, "voxels"},
                                                   {12, "hexahedra"},
                                                   {13, "prisms"},
                                                   {14, "pyramids"},
                                                   {21, "quadratic edges"},
                                                   {22, "quadratic triangles"},
                                                   {24, "quadratic tetrahedra"},
                                                   {25, "quadratic hexahedra"}};
    const auto found = kNames.find(type);
    return found != kNames.end() ? found->second : fmt::format("cells of VTK type {}", type);
}

/// A number of the file as an index; -1, which no mesh has, for what is none.
std::int64_t index_of(double number) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53: beyond, doubles are no indices
    return number >= 0 && number < kLargest && number == std::floor(number)
               ? static_cast<std::int64_t>(number)
               : -1;
}

/// One file being read: its sections fill the members, assemble() makes the mesh of them.
class VtkReader {
  public:
    explicit VtkReader(std::string_view content) : reader_(content) {}

    RawMesh read() {
        read_header();
        for (std::string_view keyword = reader_.next(); !keyword.empty(); keyword = reader_.next())
            read_section(keyword);
        return assemble();
    }

  private:
    void read_header();
    void read_section(std::string_view keyword);
    void read_cells();
    void read_cells_version_5(std::size_t offset_count, std::size_t corner_count);
    void read_scalars();
    void read_field();
    void keep_array(const std::string& name, std::size_t components, std::vector<double> values);
    std::vector<double> read_values(std::size_t count, ScalarType type, bool keep = true);
    std::vector<double> read_typed_values(std::size_t count, bool keep = true);
    ScalarType read_type();
    std::size_t product(std::size_t a, std::size_t b);
    RawMesh assemble();

    enum class Attributes { none, of_cells, of_points };

    TextReader reader_;
    bool binary_ = false;
    std::vector<double> coordinates_;
    std::vector<std::size_t> offsets_;  ///< [cells + 1] into corners_
    std::vector<double> corners_;
    std::vector<double> types_;
    Attributes attributes_ = Attributes::none;
    std::size_t attribute_count_ = 0;
    std::vector<CellArray> arrays_;      ///< of all cells
    std::vector<std::string> left_out_;  ///< names of arrays not kept
};

void VtkReader::read_header() {
    reader_.rest_of_line();  // "# vtk DataFile Version x.y", recognised already
    reader_.rest_of_line();  // title
    const std::string_view encoding = reader_.word("ASCII or BINARY");
    if (encoding != "ASCII" && encoding != "BINARY")
        reader_.fail("ASCII or BINARY should stand here, not " + in_quotes(encoding));
    binary_ = encoding == "BINARY";
    if (reader_.word("DATASET") != "DATASET") reader_.fail("DATASET should stand here");
    const std::string_view dataset = reader_.word("the kind of data set");
    if (dataset != "UNSTRUCTURED_GRID")
        reader_.fail("holds a data set of the kind " + in_quotes(dataset) + ", not an UNSTRUCTURED_GRID");
}

/// A product that cannot wrap around and cannot pass what is left of the file.
std::size_t VtkReader::product(std::size_t a, std::size_t b) {
    if (b != 0 && a > reader_.bytes_left() / b) reader_.fail("more values announced than the file can hold");
    return a * b;
}

ScalarType VtkReader::read_type() {
    const std::string_view name = reader_.word("a number type");
    const ScalarType type = vtk_type(name);
    if (type == ScalarType::none) reader_.fail(in_quotes(name) + " is not a number type of VTK known here");
    return type;
}

std::vector<double> VtkReader::read_values(std::size_t count, ScalarType type, bool keep) {
    std::vector<double> values;
    if (!binary_) {
        for (std::size_t i = 0; i < count; ++i) {
            const double value = reader_.number("a value");
            if (keep) values.push_back(value);
        }
        return values;
    }
    reader_.rest_of_line();
    const std::string_view block = reader_.raw(product(count, size_of(type)), "binary data");
    if (!keep) return values;
    values.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = decode(type, block.data() + i * size_of(type), true);
    return values;
}

std::vector<double> VtkReader::read_typed_values(std::size_t count, bool keep) {
    const ScalarType type = read_type();
    return read_values(count, type, keep);
}

void VtkReader::read_section(std::string_view keyword) {
    if (keyword == "POINTS") {
        if (!coordinates_.empty()) reader_.fail("a second POINTS");
        coordinates_ = read_typed_values(product(reader_.count("the number of points"), 3));
    } else if (keyword == "CELLS") {
        read_cells();
    } else if (keyword == "CELL_TYPES") {
        types_ = read_values(reader_.count("the number of cells"), ScalarType::int32);
    } else if (keyword == "CELL_DATA" || keyword == "POINT_DATA") {
        attributes_ = keyword == "CELL_DATA" ? Attributes::of_cells : Attributes::of_points;
        attribute_count_ = reader_.count("the number of values");
    } else if (keyword == "SCALARS") {
        read_scalars();
    } else if (keyword == "FIELD") {
        read_field();
    } else if (keyword == "VECTORS" || keyword == "NORMALS") {
        left_out_.emplace_back(reader_.word("a name"));
        read_typed_values(product(attribute_count_, 3), false);
    } else if (keyword == "TENSORS") {
        left_out_.emplace_back(reader_.word("a name"));
        read_typed_values(product(attribute_count_, 9), false);
    } else if (keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS") {
        left_out_.emplace_back(reader_.word("a name"));
        read_typed_values(attribute_count_, false);
    } else if (keyword == "LOOKUP_TABLE") {
        reader_.word("a name");
        read_values(product(reader_.count("the size of the table"), 4), ScalarType::uint8, false);
    } else if (keyword == "METADATA") {
        reader_.rest_of_line();
        while (reader_.bytes_left() > 0 && !reader_.rest_of_line().empty()) {
        }
    } else {
        reader_.fail(in_quotes(keyword) + " is not a section of a legacy VTK file known here");
    }
}

void VtkReader::read_cells() {
    const std::size_t first = reader_.count("the number of cells");
    const std::size_t second = reader_.count("the size of the cells");
    if (!offsets_.empty()) reader_.fail("a second CELLS");
    if (reader_.peek() == "OFFSETS") return read_cells_version_5(first, second);
    const std::vector<double> list = read_values(second, ScalarType::int32);
    offsets_.push_back(0);
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < first; ++cell) {
        const double size = at < list.size() ? list[at] : -1;
        if (!(size >= 0 && size <= static_cast<double>(list.size() - at - 1)))
            reader_.fail(fmt::format("cell {} (from 0) is longer than the list of cells", cell));
        const auto corners = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
        corners_.insert(corners_.end(), corners, corners + static_cast<std::ptrdiff_t>(size));
        offsets_.push_back(corners_.size());
        at += 1 + static_cast<std::size_t>(size);
    }
    if (at != list.size()) reader_.fail("the list of cells is longer than its cells");
}

void VtkReader::read_cells_version_5(std::size_t offset_count, std::size_t corner_count) {
    reader_.next();  // OFFSETS
    double previous = 0;
    for (const double offset : read_typed_values(offset_count)) {
        if (!(offset >= previous && offset <= static_cast<double>(corner_count)))
            reader_.fail("the OFFSETS of the cells do not rise");
        previous = offset;
        offsets_.push_back(static_cast<std::size_t>(offset));
    }
    if (reader_.word("CONNECTIVITY") != "CONNECTIVITY") reader_.fail("CONNECTIVITY should stand here");
    corners_ = read_typed_values(corner_count);
}

void VtkReader::keep_array(const std::string& name, std::size_t components, std::vector<double> values) {
    if (attributes_ == Attributes::of_cells && components == 1)
        arrays_.push_back({name, std::move(values)});
    else
        left_out_.push_back(name);
}

void VtkReader::read_scalars() {
    const std::string name(reader_.word("a name"));
    const ScalarType type = read_type();
    std::size_t components = 1;
    if (reader_.peek() != "LOOKUP_TABLE") components = reader_.count("the number of components");
    if (reader_.word("LOOKUP_TABLE") != "LOOKUP_TABLE") reader_.fail("LOOKUP_TABLE should stand here");
    reader_.word("a name");
    if (attributes_ == Attributes::none) reader_.fail("SCALARS before CELL_DATA or POINT_DATA");
    keep_array(name, components, read_values(product(attribute_count_, components), type));
}

void VtkReader::read_field() {
    reader_.word("a name");
    const std::size_t arrays = reader_.count("the number of arrays");
    for (std::size_t i = 0; i < arrays; ++i) {
        const std::string name(reader_.word("a name"));
        if (name == "METADATA") {  // stands between the arrays of a field, and is not one of them
            read_section(name);
            --i;
            continue;
        }
        const std::size_t components = reader_.count("the number of components");
        const std::size_t tuples = reader_.count("the number of values");
        if (attributes_ != Attributes::none && tuples != attribute_count_)
            reader_.fail(
                fmt::format("array {} has {} values, not {}", in_quotes(name), tuples, attribute_count_));
        keep_array(name, components, read_typed_values(product(components, tuples)));
    }
}

RawMesh VtkReader::assemble() {
    const std::size_t cells = offsets_.empty() ? 0 : offsets_.size() - 1;
    if (types_.size() != cells)
        fail_input(fmt::format("has {} cells, but {} cell types", cells, types_.size()));
    RawMesh mesh;
    mesh.numbering = "numbered from 0";
    for (std::size_t i = 0; i + 2 < coordinates_.size(); i += 3) {
        mesh.nodes.push_back({coordinates_[i], coordinates_[i + 1], coordinates_[i + 2]});
        mesh.node_numbers.push_back(static_cast<std::int64_t>(i / 3));
    }
    std::map<int, std::size_t> others;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        if (types_[cell] != kVtkTetra) {
            if (index_of(types_[cell]) < 0 || types_[cell] > kLargestType)
                fail_input(fmt::format("cell {} (from 0) has {:g} for its type", cell, types_[cell]));
            ++others[static_cast<int>(types_[cell])];
            continue;
        }
        if (offsets_[cell + 1] - offsets_[cell] != 4)
            fail_input(fmt::format("cell {} (from 0) is a tetrahedron without four nodes", cell));
        std::array<std::int64_t, 4> nodes{};
        for (int i = 0; i < 4; ++i)
            nodes[i] = index_of(corners_[offsets_[cell] + i]);
        mesh.tetrahedra.push_back(nodes);
        mesh.tetrahedron_numbers.push_back(static_cast<std::int64_t>(cell));
    }
    for (const auto& [type, count] : others)
        mesh.other_cells.emplace_back(cell_type_name(type), count);
    for (const CellArray& array : arrays_) {
        if (array.values.size() != cells)
            fail_input(fmt::format("cell array {} has {} values for {} cells", in_quotes(array.name),
                                   array.values.size(), cells));
        CellArray kept{array.name, {}};
        for (const std::int64_t cell : mesh.tetrahedron_numbers)
            kept.values.push_back(array.values[static_cast<std::size_t>(cell)]);
        mesh.cell_arrays.push_back(std::move(kept));
    }
    for (const std::string& name : left_out_)
        mesh.notes.push_back({false, "array " + in_quotes(name) + " left out: not one number per cell"});
    return mesh;
}

}  // namespace

RawMesh read_vtk(std::string_view content) {
    return VtkReader(content).read();
}

}  // namespace knead::tools
