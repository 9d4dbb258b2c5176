// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "knead/formats/write/write.h"
#include "payload.h"

namespace knead {

/// A dataset under /VTKHDF/CellData: a hard link to one of ours.
struct CellDataLink {
    std::string name;
    std::string target;
};

/// What the /VTKHDF group links to.
struct VtkPart {
    std::string nodes;       ///< float64 [nodes, 3]
    std::string tetrahedra;  ///< int32 [4 * tetrahedra]
    std::vector<CellDataLink> cell_data;
};

/// Everything that goes into one file.
struct FilePlan {
    FileKind kind = FileKind::tet_mesh;
    std::vector<std::string> required_features;
    Payload payload;
    Payload provenance;
    std::optional<VtkPart> vtk;
};

// One encoder per part; the views in the payload look at the arguments, which must outlive it.
void encode_nodes_and_tetrahedra(Payload& payload, const std::string& group,
                                 const std::vector<Point>& nodes_m,
                                 const std::vector<Tetrahedron>& tetrahedra);
void encode_mesh(FilePlan& plan, const TetMesh& mesh);
void encode_material(FilePlan& plan, const Material& material, const std::string& bin_name);
void encode_provenance(Payload& payload, const Provenance& provenance);

/// "000007": children of a list group sort like their numbers.
[[nodiscard]] std::string list_name(std::size_t index);

template <class T>
Value view_1d(const std::vector<T>& elements) {
    return view_of(std::span<const T>(elements), {elements.size()});
}
template <class T, std::size_t N>
Value view_2d(const std::vector<std::array<T, N>>& rows) {
    return view_of(std::span<const T>(rows.empty() ? nullptr : rows[0].data(), rows.size() * N),
                   {rows.size(), N});
}
template <class T, std::size_t N>
Value copy_1d(const std::array<T, N>& elements) {
    return copy_of(std::span<const T>(elements), {N});
}
/// A scalar, for attributes.
template <class T>
Value scalar(T number) {
    return copy_of(std::span<const T>(&number, 1), {});
}

/// The bytes of a finished HDF5 file, as malloc() gave them.
class FileImage {
  public:
    FileImage(std::byte* data, std::size_t size) : data_(data, &std::free), size_(size) {}
    [[nodiscard]] std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  private:
    std::unique_ptr<std::byte, void (*)(void*)> data_;
    std::size_t size_;
};

/// Builds the file in memory. Throws Failure (cannot_write).
[[nodiscard]] FileImage build_image(const FilePlan& plan, const std::string& where);

/// Writes `bytes` beside `file`, flushes them to the disk and renames. Throws Failure (cannot_write); leaves
/// nothing behind then.
void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// The frame of every public writer: `encode` validates and fills the plan.
template <class Encode>
Status write_kind(const std::filesystem::path& file, FileKind kind, const Provenance& provenance,
                  Encode&& encode) {
    return guarded(file, [&] {
        try {
            FilePlan plan;
            plan.kind = kind;
            plan.payload.add_group("/knead");
            encode(plan);
            encode_provenance(plan.provenance, provenance);
            replace_file(file, build_image(plan, file.string()).bytes());
        } catch (Failure& failure) {
            if (failure.error.code == ErrorCode::invalid_data)
                failure.error.where = file.string() + "#" + failure.error.where;
            throw;
        }
        return Unit{};
    });
}

}  // namespace knead
