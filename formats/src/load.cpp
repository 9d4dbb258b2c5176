// SPDX-License-Identifier: Apache-2.0
#include "load.h"

#include <algorithm>
#include <array>
#include <set>

#include "h5.h"
#include "knead/formats/version.h"
#include "required_features.h"
#include "schema.h"

namespace knead {
namespace {

constexpr int kMaxDepth = 8;
constexpr std::uint64_t kMaxNodesPerName = 16;  ///< a tool is the largest: seven nodes
constexpr std::array<const char*, 6> kKindNames{"tet_mesh", "material", "clustering",
                                                "overlap",  "asset",    "session"};

/// One group of the file with everything below it, first described, then loaded.
class Tree {
  public:
    Tree(std::string file, const ReadLimits& limits) : file_(std::move(file)), limits_(limits) {}

    /// Describes everything below `name`: links, types, extents and storage are checked, no data is read.
    void scan(hid_t root, const std::string& name, Payload& payload) {
        add(h5::open_child(root, name, at("/" + name)), "/" + name, 0, payload);
    }

    /// Reads the data of everything described. First all sizes, so that nothing is allocated for a file that
    /// cannot hold what it declares.
    void load() {
        for (const auto& [path, entry] : datasets_)
            if (entry.node->value.byte_count() > entry.possible_bytes)
                fail(ErrorCode::too_large,
                     "declares " + entry.node->value.shape_text() + ", which the file is too small to hold",
                     at(path));
        for (const auto& [path, entry] : datasets_)
            h5::read_elements(entry.dataset.get(), entry.node->value, at(path));
    }

  private:
    struct Entry {
        h5::Handle dataset;
        Node* node;
        std::uint64_t possible_bytes;
    };

    std::string at(const std::string& path) const { return file_ + "#" + path; }

    void add(h5::Handle object, const std::string& path, int depth, Payload& payload) {
        if (depth > kMaxDepth || payload.nodes.size() >= limits_.max_names * kMaxNodesPerName)
            fail(ErrorCode::too_large, "the file has too many groups and datasets", at(path));
        Node& node = payload.nodes[path];
        const H5I_type_t kind = H5Iget_type(object.get());
        node.is_group = kind == H5I_GROUP;
        if (kind != H5I_GROUP && kind != H5I_DATASET)
            fail(ErrorCode::wrong_type, "is neither a group nor a dataset", at(path));
        const h5::ObjectHeader header = h5::header_of(object.get(), at(path));
        if (!addresses_.insert(header.address).second)
            fail(ErrorCode::forbidden, "is an object that the file has under another name too", at(path));
        node.bytes_on_disk = header.bytes;
        node.attributes = h5::read_attributes(object.get(), limits_, at(path));
        for (const auto& [name, value] : node.attributes)
            claim(value, path + "@" + name);
        if (node.is_group)
            add_children(object.get(), path, depth, payload);
        else
            add_dataset(std::move(object), path, node);
    }

    void add_children(hid_t group, const std::string& path, int depth, Payload& payload) {
        const std::size_t limit = limits_.max_names + kMaxNodesPerName;
        for (const h5::Link& link : h5::links_of(group, limit, at(path))) {
            const std::string child = path + "/" + link.name;
            add(h5::open_child(group, link.name, at(child)), child, depth + 1, payload);
        }
    }

    void add_dataset(h5::Handle dataset, const std::string& path, Node& node) {
        const h5::Handle type(H5Dget_type(dataset.get()), H5Tclose);
        const h5::Handle space(H5Dget_space(dataset.get()), H5Sclose);
        node.value = h5::describe(type, space, limits_.max_string_bytes, at(path));
        claim(node.value, path);
        const std::uint64_t possible = h5::check_storage(dataset.get(), at(path));
        node.bytes_on_disk += node.value.byte_count() == 0 ? 0 : h5::bytes_outside_header(dataset.get());
        datasets_.emplace(path, Entry{std::move(dataset), &node, possible});
    }

    /// Counts what a value needs in memory against the limit of the whole file.
    void claim(const Value& value, const std::string& path) {
        if (value.byte_count() > limits_.max_bytes - total_bytes_)
            fail(ErrorCode::too_large,
                 "declares " + value.shape_text() + ": more than the limit of " +
                     std::to_string(limits_.max_bytes) + " bytes for one file",
                 at(path));
        total_bytes_ += value.byte_count();
    }

    std::string file_;
    const ReadLimits& limits_;
    std::uint64_t total_bytes_ = 0;
    std::set<std::uint64_t> addresses_;  ///< so that hard links cannot multiply what a small file holds
    std::map<std::string, Entry> datasets_;
};

const Value& root_attribute(const std::map<std::string, Value>& attributes, const std::string& name,
                            ScalarType type, std::size_t rank, const std::string& file) {
    const auto found = attributes.find(name);
    const std::string where = file + "#/@" + name;
    if (found == attributes.end()) fail(ErrorCode::missing, "the attribute is not in the file", where);
    if (found->second.type != type)
        fail(ErrorCode::wrong_type, "is " + found->second.shape_text() + ", not " + to_string(type), where);
    if (found->second.extents.size() != rank)
        fail(ErrorCode::wrong_extent, "is " + found->second.shape_text() + ", which has the wrong rank",
             where);
    return found->second;
}

void check_version(const std::array<std::int32_t, 2>& version, const std::string& file) {
    if (version[0] == kFormatVersion[0] && version[1] >= 0) return;
    fail(ErrorCode::version_unsupported,
         "has format version " + std::to_string(version[0]) + "." + std::to_string(version[1]) +
             "; this version of Knead reads " + std::to_string(kFormatVersion[0]) + ".x",
         file + "#/@format_version");
}

FileKind kind_of(const std::string& name, const std::string& file) {
    const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
    if (found == kKindNames.end())
        fail(ErrorCode::wrong_kind, "\"" + name + "\" is not a kind that this version of Knead knows",
             file + "#/@kind");
    return static_cast<FileKind>(found - kKindNames.begin());
}

bool is_hash(const std::string& text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

bool has_magic(hid_t root, const ReadLimits& limits, const std::string& file) {
    const htri_t exists = H5Aexists(root, "format");
    if (exists < 0) fail(ErrorCode::corrupt, "its attributes cannot be read", file + "#/");
    if (exists == 0) return false;
    try {
        const Value format = h5::read_attribute(root, "format", limits, file + "#/@format");
        return format.type == ScalarType::text && format.extents.empty() && format.text() == "knead";
    } catch (const Failure& failure) {
        if (failure.error.code == ErrorCode::corrupt) throw;
        return false;  // another program's attribute of this name
    }
}

/// Magic, version, features, kind: in this order.
FileHeader read_root(hid_t root, const std::string& file, const ReadLimits& limits) {
    if (!has_magic(root, limits, file))
        fail(ErrorCode::not_knead, "is an HDF5 file, but not one of Knead", file);
    const auto attributes = h5::read_attributes(root, limits, file + "#/");
    FileHeader header;
    const Value& version = root_attribute(attributes, "format_version", ScalarType::i32, 1, file);
    if (version.extents[0] != 2)
        fail(ErrorCode::wrong_extent, "is " + version.shape_text() + ", not int32 [2]",
             file + "#/@format_version");
    std::memcpy(header.format_version.data(), version.bytes.data(), sizeof header.format_version);
    check_version(header.format_version, file);
    const Value& features = root_attribute(attributes, "required_features", ScalarType::text, 1, file);
    for (std::size_t i = 0; i < features.count(); ++i)
        header.required_features.push_back(features.text(i));
    for (const std::string& feature : header.required_features)
        if (std::find(kKnownFeatures.begin(), kKnownFeatures.end(), feature) == kKnownFeatures.end())
            fail(ErrorCode::feature_unsupported,
                 "needs the feature \"" + feature + "\", which this version of Knead lacks",
                 file + "#/@required_features");
    header.kind = kind_of(root_attribute(attributes, "kind", ScalarType::text, 0, file).text(), file);
    header.content_hash = root_attribute(attributes, "content_hash", ScalarType::text, 0, file).text();
    if (!is_hash(header.content_hash))
        fail(ErrorCode::corrupt, "is not a SHA-256 in lowercase hexadecimal digits",
             file + "#/@content_hash");
    return header;
}

void check_kind(FileKind kind, std::initializer_list<FileKind> accepted, const std::string& file) {
    if (std::find(accepted.begin(), accepted.end(), kind) != accepted.end()) return;
    std::string wanted;
    for (const FileKind a : accepted)
        wanted += (wanted.empty() ? "" : " or ") + std::string(to_string(a));
    fail(ErrorCode::wrong_kind,
         std::string("holds kind ") + to_string(kind) + " where " + wanted + " is wanted", file + "#/@kind");
}

/// A newer minor version may add what this one does not know; the same version may not.
bool is_newer(const FileHeader& header) {
    return header.format_version[1] > kFormatVersion[1];
}

void load_provenance(hid_t root, LoadedFile& loaded, const std::string& file, const ReadLimits& limits) {
    Tree tree(file, limits);
    tree.scan(root, "provenance", loaded.provenance);
    Schema schema(loaded.provenance, file, limits);
    check_provenance(schema);
    if (!is_newer(loaded.header)) schema.refuse_unknown();
    tree.load();
    loaded.header.provenance = take_provenance(schema);
}

}  // namespace

const char* to_string(FileKind kind) {
    return kKindNames[static_cast<std::size_t>(kind)];
}

LoadedFile load_header(const std::filesystem::path& file, const ReadLimits& limits) {
    const h5::Session session;
    const h5::Handle handle = h5::open_file(file);
    LoadedFile loaded;
    loaded.header = read_root(handle.get(), file.string(), limits);
    load_provenance(handle.get(), loaded, file.string(), limits);
    return loaded;
}

LoadedFile load_file(const std::filesystem::path& file, const ReadLimits& limits,
                     std::initializer_list<FileKind> accepted) {
    const std::string name = file.string();
    const h5::Session session;
    const h5::Handle handle = h5::open_file(file);
    LoadedFile loaded;
    loaded.file_bytes = std::filesystem::file_size(file);
    loaded.header = read_root(handle.get(), name, limits);
    check_kind(loaded.header.kind, accepted, name);
    load_provenance(handle.get(), loaded, name, limits);
    Tree tree(name, limits);
    tree.scan(handle.get(), "knead", loaded.payload);
    Schema schema(loaded.payload, name, limits);
    check_shape(loaded.header.kind, schema);
    if (!is_newer(loaded.header)) schema.refuse_unknown();
    tree.load();
    const std::string found = content_hash(loaded.header.kind, loaded.payload);
    if (found != loaded.header.content_hash)
        fail(ErrorCode::corrupt, "the content does not match its hash: the file was damaged or edited", name);
    return loaded;
}

}  // namespace knead
