// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "../h5.h"
#include "encode.h"
#include "knead/formats/version.h"

namespace knead {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;  ///< as large as HDF5's chunk cache
constexpr unsigned kDeflateLevel = 1;
/// Datasets up to this size stand in their object header, which has a checksum of its own: a chunk with its
/// index and filters would cost more than it saves.
constexpr std::size_t kCompactBytes = 1024;
constexpr unsigned kVtkTetrahedron = 10;

void check(herr_t status, const std::string& what) {
    if (status < 0) fail(ErrorCode::cannot_write, "HDF5 cannot make " + what, "");
}

void check(const h5::Handle& handle, const std::string& what) {
    if (!handle.ok()) fail(ErrorCode::cannot_write, "HDF5 cannot make " + what, "");
}

/// The file is built in memory, so that a full disk is met by our own write(), whose errors we can handle,
/// and not by HDF5's closing of a file. HDF5 hands the finished bytes over through these callbacks.
struct Image {
    std::byte* data = nullptr;
    std::size_t size = 0;
    ~Image() { std::free(data); }

    static void* allocate(std::size_t bytes, H5FD_file_image_op_t, void* self) {
        static_cast<Image*>(self)->size = bytes;
        return std::malloc(bytes);
    }
    static void* reallocate(void* old, std::size_t bytes, H5FD_file_image_op_t, void* self) {
        void* grown = std::realloc(old, bytes);
        if (grown != nullptr) static_cast<Image*>(self)->size = bytes;
        return grown;
    }
    static herr_t release(void* memory, H5FD_file_image_op_t, void* self) {
        static_cast<Image*>(self)->data = static_cast<std::byte*>(memory);
        return 0;
    }
    static void* borrow(void* self) { return self; }
    static herr_t give_back(void*) { return 0; }

    /// The end of the file as its superblock (version 2 or 3: bytes 28 to 35) says; memory is longer.
    [[nodiscard]] std::size_t file_bytes() const {
        std::uint64_t end = 0;
        if (data == nullptr || size < 36) return 0;
        std::memcpy(&end, data + 28, sizeof end);
        return end <= size ? end : 0;
    }
};

h5::Handle in_memory(Image& image, std::size_t payload_bytes) {
    h5::Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    const std::size_t step =
        std::clamp<std::size_t>(payload_bytes / 4, std::size_t{1} << 16, std::size_t{1} << 26);
    check(H5Pset_fapl_core(access.get(), step, false), "a file in memory");
    H5FD_file_image_callbacks_t callbacks{
        Image::allocate, nullptr, Image::reallocate, Image::release, Image::borrow, Image::give_back, &image};
    check(H5Pset_file_image_callbacks(access.get(), &callbacks), "a file in memory");
    check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), "a file of this version");
    check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), "a file in memory");
    check(H5Pset_meta_block_size(access.get(), 1024), "a file in memory");
    return access;
}

/// Writes groups, datasets and attributes in the order of the payload.
class Writer {
  public:
    explicit Writer(hid_t file) : file_(file) {}

    void group(const std::string& path) { check(create_group(path), path); }

    void payload(const Payload& payload) {
        for (const auto& [path, node] : payload.nodes) {
            const h5::Handle object = node.is_group ? create_group(path) : dataset(path, node.value);
            check(object, path);
            for (const auto& [name, value] : node.attributes)
                attribute(object.get(), name, value);
        }
    }

    h5::Handle dataset(const std::string& path, const Value& value) {
        const h5::Handle type = h5::stored_type(value);
        const h5::Handle space = dataspace(value);
        const h5::Handle creation = storage(value);
        h5::Handle dataset(H5Dcreate2(file_, path.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                      creation.get(), H5P_DEFAULT),
                           H5Dclose);
        check(dataset, path);
        if (!value.bytes.empty())
            check(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.bytes.data()),
                  path);
        return dataset;
    }

    void attribute(hid_t object, const std::string& name, const Value& value) {
        const h5::Handle type = h5::stored_type(value);
        attribute(object, name, value, type);
    }

    void attribute(hid_t object, const std::string& name, const Value& value, const h5::Handle& type) {
        const h5::Handle space = dataspace(value);
        const h5::Handle attribute(
            H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        check(attribute, name);
        if (!value.bytes.empty()) check(H5Awrite(attribute.get(), type.get(), value.bytes.data()), name);
    }

    void link(const std::string& target, const std::string& name) {
        check(H5Lcreate_hard(file_, target.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), name);
    }

    h5::Handle create_group(const std::string& path) {
        const h5::Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
        check(H5Pset_obj_track_times(creation.get(), false), path);
        return {H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose};
    }

  private:
    static h5::Handle dataspace(const Value& value) {
        if (value.extents.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
        const std::vector<hsize_t> extents(value.extents.begin(), value.extents.end());
        return {H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose};
    }

    static h5::Handle storage(const Value& value) {
        h5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        check(H5Pset_obj_track_times(creation.get(), false), "a dataset without times");
        if (value.bytes.size() <= kCompactBytes) {
            check(H5Pset_layout(creation.get(), H5D_COMPACT), "a compact dataset");
            return creation;
        }
        std::vector<hsize_t> chunk(value.extents.begin(), value.extents.end());
        const std::size_t row_bytes = value.bytes.size() / value.extents[0];
        chunk[0] = std::clamp<hsize_t>(kChunkBytes / row_bytes, 1, chunk[0]);
        check(H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()),
              "a chunked dataset");
        if (size_of(value.type) > 1) check(H5Pset_shuffle(creation.get()), "a shuffled dataset");
        check(H5Pset_deflate(creation.get(), kDeflateLevel), "a compressed dataset");
        check(H5Pset_fletcher32(creation.get()), "a dataset with checksums");
        return creation;
    }

    hid_t file_;
};

/// What ParaView's VTKHDF reader wants, exactly as it wants it (docs/format.md).
void write_vtk_part(Writer& writer, const Payload& payload, const VtkPart& vtk) {
    const std::uint64_t points = payload.nodes.at(vtk.nodes).value.extents[0];
    const std::uint64_t cells = payload.nodes.at(vtk.tetrahedra).value.extents[0] / 4;
    const h5::Handle group = writer.create_group("/VTKHDF");
    check(group, "/VTKHDF");
    const Value type = text_value("UnstructuredGrid");
    const h5::Handle ascii = h5::stored_type(type);
    check(H5Tset_cset(ascii.get(), H5T_CSET_ASCII), "/VTKHDF@Type");
    writer.attribute(group.get(), "Type", type, ascii);
    writer.attribute(group.get(), "Version", copy_1d(std::array<std::int64_t, 2>{1, 0}));
    const auto add = [&](const char* name, const Value& value) {
        const h5::Handle dataset = writer.dataset(name, value);
        writer.attribute(dataset.get(), "units", text_value("1"));
    };
    const auto count = [](std::uint64_t n) {
        return copy_1d(std::array<std::int64_t, 1>{static_cast<std::int64_t>(n)});
    };
    add("/VTKHDF/NumberOfPoints", count(points));
    add("/VTKHDF/NumberOfCells", count(cells));
    add("/VTKHDF/NumberOfConnectivityIds", count(4 * cells));
    writer.link(vtk.nodes, "/VTKHDF/Points");
    writer.link(vtk.tetrahedra, "/VTKHDF/Connectivity");
    std::vector<std::int32_t> offsets(cells + 1);
    for (std::size_t i = 0; i <= cells; ++i)
        offsets[i] = static_cast<std::int32_t>(4 * i);
    const std::vector<std::uint8_t> types(cells, kVtkTetrahedron);
    add("/VTKHDF/Offsets", view_1d(offsets));
    add("/VTKHDF/Types", view_1d(types));
    writer.group("/VTKHDF/PointData");
    writer.group("/VTKHDF/CellData");
    for (const CellDataLink& link : vtk.cell_data)
        writer.link(link.target, "/VTKHDF/CellData/" + link.name);
}

void write_root(Writer& writer, hid_t root, const FilePlan& plan) {
    writer.attribute(root, "format", text_value("knead"));
    writer.attribute(root, "format_version", copy_1d(kFormatVersion));
    writer.attribute(root, "kind", text_value(to_string(plan.kind)));
    writer.attribute(root, "required_features", text_array(plan.required_features));
    writer.attribute(root, "content_hash", text_value(content_hash(plan.kind, plan.payload)));
}

std::size_t total_bytes(const Payload& payload) {
    std::size_t total = 0;
    for (const auto& [path, node] : payload.nodes)
        total += node.value.bytes.size();
    return total;
}

void write_image(const FilePlan& plan, Image& image) {
    const h5::Session session;
    const h5::Handle access = in_memory(image, total_bytes(plan.payload));
    const h5::Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    check(H5Pset_obj_track_times(creation.get(), false), "a file without times");
    h5::Handle file(H5Fcreate("knead", H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
    check(file, "a file in memory");
    Writer writer(file.get());
    write_root(writer, file.get(), plan);
    writer.payload(plan.provenance);
    writer.payload(plan.payload);
    if (plan.vtk) write_vtk_part(writer, plan.payload, *plan.vtk);
    if (!file.close()) fail(ErrorCode::cannot_write, "HDF5 cannot finish the file", "");
}

}  // namespace

FileImage build_image(const FilePlan& plan, const std::string& where) {
    Image image;
    try {
        write_image(plan, image);
    } catch (Failure& failure) {
        failure.error.where = where;
        throw;
    }
    const std::size_t bytes = image.file_bytes();
    if (bytes == 0) fail(ErrorCode::cannot_write, "HDF5 did not finish the file", where);
    return {std::exchange(image.data, nullptr), bytes};
}

}  // namespace knead
