// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/inspect.h"

#include <map>

#include "load.h"
#include "number_text.h"

namespace knead {
namespace {

NodeInfo describe(const std::string& path, const Node& node) {
    NodeInfo info;
    info.path = path;
    info.is_group = node.is_group;
    info.bytes_on_disk = node.bytes_on_disk;
    if (!node.is_group) {
        info.type = to_string(node.value.type);
        info.extents = node.value.extents;
    }
    for (const auto& [name, value] : node.attributes) {
        const std::string text = value.count() == 0 ? std::string() : element_text(value, 0);
        if (name == "units" && !node.is_group)
            info.units = text;
        else
            info.attributes.emplace_back(name, text);
    }
    return info;
}

/// Adds what lies below each group to the group's own header. Children stand behind their parents.
void sum_groups(std::vector<NodeInfo>& nodes) {
    std::map<std::string, std::size_t> index_of;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        index_of[nodes[i].path] = i;
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const auto parent = index_of.find(nodes[i].path.substr(0, nodes[i].path.rfind('/')));
        if (parent != index_of.end()) nodes[parent->second].bytes_on_disk += nodes[i].bytes_on_disk;
    }
}

/// Through all checks; throws what they find.
void read_whole(FileKind kind, const std::filesystem::path& file, const ReadLimits& limits) {
    switch (kind) {
        case FileKind::tet_mesh:
            return (void)value_or_fail(read_tet_mesh(file, limits));
        case FileKind::material:
            return (void)value_or_fail(read_material(file, limits));
        case FileKind::clustering:
            return (void)value_or_fail(read_clustering(file, limits));
        case FileKind::overlap:
            return (void)value_or_fail(read_overlap(file, limits));
        case FileKind::session:
            return (void)value_or_fail(read_session_log(file, limits));
        case FileKind::asset:
            break;
    }
    return (void)value_or_fail(read_asset(file, limits));
}

}  // namespace

Result<FileInfo> inspect_file(const std::filesystem::path& file, const ReadLimits& limits) {
    return guarded(file, [&] {
        LoadedFile loaded = load_file(file, limits, kEveryKind);
        FileInfo info;
        info.header = loaded.header;
        info.file_bytes = loaded.file_bytes;
        std::uint64_t payload_bytes = 0;
        for (const auto& [path, node] : loaded.payload.nodes) {
            info.nodes.push_back(describe(path, node));
            payload_bytes += node.bytes_on_disk;
        }
        info.other_bytes = info.file_bytes > payload_bytes ? info.file_bytes - payload_bytes : 0;
        sum_groups(info.nodes);
        return info;
    });
}

Result<FileKind> validate_file(const std::filesystem::path& file, const ReadLimits& limits) {
    return guarded(file, [&] {
        const FileKind kind = value_or_fail(read_header(file, limits)).kind;
        read_whole(kind, file, limits);
        return kind;
    });
}

}  // namespace knead
