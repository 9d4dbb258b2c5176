// SPDX-License-Identifier: Apache-2.0
#include "h5.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace knead::h5 {
namespace {

constexpr std::size_t kMaxAttributes = 64;
constexpr int kMaxRank = 4;
/// Deflate never makes more than 1032 bytes of one (RFC 1951: 258 bytes of a 2-bit code); a little is added
/// for the smallest streams.
constexpr std::uint64_t kMaxInflation = 1040;

/// In any other order HDF5 1.10 first makes a table of all names, and when the file is damaged it releases
/// entries of the table that it never filled: a crash.
constexpr H5_iter_order_t kNativeOrder = H5_ITER_NATIVE;

std::mutex& process_lock() {
    static std::mutex lock;
    return lock;
}

/// What iteration callbacks may do without throwing through C frames.
struct Names {
    std::vector<Link> links;
    std::size_t limit;
    bool too_many = false;
    bool no_memory = false;

    herr_t add(const char* name, H5L_type_t type) noexcept {
        if (links.size() >= limit) {
            too_many = true;
            return -1;
        }
        try {
            links.push_back({name, type});
        } catch (...) {
            no_memory = true;
            return -1;
        }
        return 0;
    }
    void check(herr_t status, const char* what, const std::string& where) const {
        if (no_memory) throw std::bad_alloc();
        if (too_many) fail(ErrorCode::too_large, "more than " + std::to_string(limit) + " " + what, where);
        if (status < 0) fail(ErrorCode::corrupt, std::string("cannot list the ") + what, where);
    }
};

herr_t collect_link(hid_t, const char* name, const H5L_info_t* info, void* names) {
    return static_cast<Names*>(names)->add(name, info->type);
}

herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
    return static_cast<Names*>(names)->add(name, H5L_TYPE_HARD);
}

bool starts_like_hdf5(const std::filesystem::path& file) {
    static constexpr std::array<char, 8> kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
    std::array<char, 8> start{};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(ErrorCode::io_error, "cannot open the file", file.string());
    stream.read(start.data(), start.size());
    return stream && start == kSignature;
}

ScalarType numeric_type_of(hid_t type, const std::string& where) {
    for (int i = 0; i < static_cast<int>(ScalarType::text); ++i)
        if (H5Tequal(type, numeric_type(static_cast<ScalarType>(i))) > 0) return static_cast<ScalarType>(i);
    fail(ErrorCode::wrong_type, "the stored type is not one that Knead files have", where);
}

}  // namespace

Session::Session() : lock_(process_lock()) {
    H5open();
    H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLget_loading_state(&plugins_);
    H5PLset_loading_state(0);
}

Session::~Session() {
    H5PLset_loading_state(plugins_);
    H5Eclear2(H5E_DEFAULT);
    H5Eset_auto2(H5E_DEFAULT, print_, print_data_);
}

hid_t numeric_type(ScalarType type) {
    switch (type) {
        case ScalarType::i8:
            return H5T_STD_I8LE;
        case ScalarType::u8:
            return H5T_STD_U8LE;
        case ScalarType::i16:
            return H5T_STD_I16LE;
        case ScalarType::u16:
            return H5T_STD_U16LE;
        case ScalarType::i32:
            return H5T_STD_I32LE;
        case ScalarType::u32:
            return H5T_STD_U32LE;
        case ScalarType::i64:
            return H5T_STD_I64LE;
        case ScalarType::u64:
            return H5T_STD_U64LE;
        case ScalarType::f32:
            return H5T_IEEE_F32LE;
        case ScalarType::f64:
            return H5T_IEEE_F64LE;
        case ScalarType::text:
            break;
    }
    return -1;
}

Handle stored_type(const Value& value) {
    if (value.type != ScalarType::text) return Handle(H5Tcopy(numeric_type(value.type)), H5Tclose);
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), value.element_bytes);
    H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
    H5Tset_cset(type.get(), H5T_CSET_UTF8);
    return type;
}

Handle open_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) fail(ErrorCode::io_error, "there is no such file", file.string());
    if (!std::filesystem::is_regular_file(status)) fail(ErrorCode::io_error, "is not a file", file.string());
    if (!starts_like_hdf5(file)) fail(ErrorCode::not_knead, "is not an HDF5 file", file.string());
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
#if H5_VERSION_GE(1, 10, 7)
    H5Pset_file_locking(access.get(), false, true);  // files are replaced, never changed in place
#endif
    Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (!handle.ok()) fail(ErrorCode::corrupt, "is truncated or damaged: HDF5 cannot open it", file.string());
    return handle;
}

std::vector<Link> links_of(hid_t group, std::size_t limit, const std::string& where) {
    Names names{{}, limit};
    hsize_t index = 0;
    const herr_t status = H5Literate(group, H5_INDEX_NAME, kNativeOrder, &index, collect_link, &names);
    names.check(status, "links", where);
    std::sort(names.links.begin(), names.links.end(),
              [](const Link& a, const Link& b) { return a.name < b.name; });
    return std::move(names.links);
}

Handle open_child(hid_t group, const std::string& name, const std::string& where) {
    const htri_t exists = H5Lexists(group, name.c_str(), H5P_DEFAULT);
    if (exists == 0) fail(ErrorCode::missing, "is not in the file", where);
    H5L_info_t info{};
    if (exists < 0 || H5Lget_info(group, name.c_str(), &info, H5P_DEFAULT) < 0)
        fail(ErrorCode::corrupt, "cannot be looked up", where);
    if (info.type != H5L_TYPE_HARD)
        fail(ErrorCode::forbidden, "is a soft or external link, which Knead files never have", where);
    Handle child(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (!child.ok()) fail(ErrorCode::corrupt, "cannot be opened", where);
    return child;
}

Value describe(const Handle& type, const Handle& space, std::uint64_t max_text_bytes,
               const std::string& where) {
    if (!type.ok() || !space.ok()) fail(ErrorCode::corrupt, "type or extents cannot be read", where);
    Value value;
    if (H5Tget_class(type.get()) == H5T_STRING) {
        if (H5Tis_variable_str(type.get()) != 0)
            fail(ErrorCode::wrong_type, "is text of variable length", where);
        if (H5Tget_strpad(type.get()) == H5T_STR_SPACEPAD)
            fail(ErrorCode::wrong_type, "is text padded with blanks", where);
        value.type = ScalarType::text;
        value.element_bytes = H5Tget_size(type.get());
        if (value.element_bytes > max_text_bytes)
            fail(ErrorCode::too_large, "declares texts of " + std::to_string(value.element_bytes) + " bytes",
                 where);
    } else {
        value.type = numeric_type_of(type.get(), where);
        value.element_bytes = size_of(value.type);
    }
    const H5S_class_t kind = H5Sget_simple_extent_type(space.get());
    if (kind == H5S_SCALAR) return value;
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (kind != H5S_SIMPLE || rank < 1 || rank > kMaxRank)
        fail(ErrorCode::wrong_extent, "has no extents, or too many of them", where);
    std::array<hsize_t, kMaxRank> extents{}, maxima{};
    H5Sget_simple_extent_dims(space.get(), extents.data(), maxima.data());
    if (!std::equal(extents.begin(), extents.begin() + rank, maxima.begin()))
        fail(ErrorCode::wrong_extent, "can grow, which Knead's datasets cannot", where);
    value.extents.assign(extents.begin(), extents.begin() + rank);
    return value;
}

Value read_attribute(hid_t object, const std::string& name, const ReadLimits& limits,
                     const std::string& where) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
    if (!attribute.ok()) fail(ErrorCode::corrupt, "cannot open the attribute", where);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose);
    const Handle space(H5Aget_space(attribute.get()), H5Sclose);
    Value value = describe(type, space, limits.max_string_bytes, where);
    if (value.byte_count() > limits.max_string_bytes)
        fail(ErrorCode::too_large, "the attribute has " + std::to_string(value.byte_count()) + " bytes",
             where);
    value.storage.resize(value.byte_count());
    value.bytes = value.storage;
    if (value.storage.empty()) return value;
    // describe() accepted the stored type, so that nothing is left to convert: ASCII and UTF-8 alike.
    if (H5Aread(attribute.get(), type.get(), value.storage.data()) < 0)
        fail(ErrorCode::corrupt, "cannot read the attribute", where);
    return value;
}

std::map<std::string, Value> read_attributes(hid_t object, const ReadLimits& limits,
                                             const std::string& where) {
    Names names{{}, kMaxAttributes};
    hsize_t index = 0;
    const herr_t status = H5Aiterate2(object, H5_INDEX_NAME, kNativeOrder, &index, collect_attribute, &names);
    names.check(status, "attributes", where);
    std::map<std::string, Value> attributes;
    for (const Link& link : names.links)
        attributes[link.name] = read_attribute(object, link.name, limits, where + "@" + link.name);
    return attributes;
}

std::uint64_t check_storage(hid_t dataset, const std::string& where) {
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
    if (!creation.ok()) fail(ErrorCode::corrupt, "its layout cannot be read", where);
    const H5D_layout_t layout = H5Pget_layout(creation.get());
    if (layout == H5D_VIRTUAL) fail(ErrorCode::forbidden, "is a virtual dataset, made of other files", where);
    if (H5Pget_external_count(creation.get()) != 0)
        fail(ErrorCode::forbidden, "keeps its data in another file", where);
    if (layout != H5D_COMPACT && layout != H5D_CHUNKED && layout != H5D_CONTIGUOUS)
        fail(ErrorCode::corrupt, "its layout cannot be read", where);
    const int filters = H5Pget_nfilters(creation.get());
    bool inflates = false;
    for (int i = 0; i < filters; ++i) {
        unsigned flags = 0, config = 0;
        std::size_t parameters = 0;
        const H5Z_filter_t filter = H5Pget_filter2(creation.get(), static_cast<unsigned>(i), &flags,
                                                   &parameters, nullptr, 0, nullptr, &config);
        inflates = inflates || filter == H5Z_FILTER_DEFLATE;
        if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32)
            fail(ErrorCode::forbidden,
                 "uses HDF5 filter " + std::to_string(filter) + ", which Knead files never have", where);
    }
    const std::uint64_t stored = H5Dget_storage_size(dataset);
    if (!inflates) return stored;
    return stored > (~std::uint64_t{0}) / kMaxInflation ? ~std::uint64_t{0} : stored * kMaxInflation;
}

std::uint64_t bytes_outside_header(hid_t dataset) {
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
    return H5Pget_layout(creation.get()) == H5D_COMPACT ? 0 : H5Dget_storage_size(dataset);
}

void read_elements(hid_t dataset, Value& value, const std::string& where) {
    value.storage.resize(value.byte_count());
    value.bytes = value.storage;
    if (value.storage.empty()) return;
    const Handle type(H5Dget_type(dataset), H5Tclose);  // no conversion: describe() accepted it
    if (H5Dread(dataset, type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.storage.data()) < 0)
        fail(ErrorCode::corrupt, "its data cannot be read: the file is truncated or damaged", where);
}

ObjectHeader header_of(hid_t object, const std::string& where) {
    H5O_info_t info{};
    if (H5Oget_info2(object, &info, H5O_INFO_BASIC | H5O_INFO_HDR) < 0)
        fail(ErrorCode::corrupt, "its header cannot be read", where);
    return {info.addr, info.hdr.space.total};
}

}  // namespace knead::h5
