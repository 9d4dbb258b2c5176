// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/inspect.h"

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
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const std::string parent = nodes[i].path.substr(0, nodes[i].path.rfind('/'));
        for (std::size_t k = i; k-- > 0;)
            if (nodes[k].path == parent) nodes[k].bytes_on_disk += nodes[i].bytes_on_disk;
    }
}

}  // namespace

Result<FileInfo> inspect_file(const std::filesystem::path& file, const ReadLimits& limits) {
    return guarded(file.string(), [&] {
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
    const Result<FileHeader> header = read_header(file, limits);
    if (!header.ok()) return header.error();
    const FileKind kind = header.value().kind;
    const auto kind_or_error = [&](const auto& result) -> Result<FileKind> {
        if (!result.ok()) return result.error();
        return kind;
    };
    switch (kind) {
        case FileKind::tet_mesh:
            return kind_or_error(read_tet_mesh(file, limits));
        case FileKind::material:
            return kind_or_error(read_material(file, limits));
        case FileKind::clustering:
            return kind_or_error(read_clustering(file, limits));
        case FileKind::overlap:
            return kind_or_error(read_overlap(file, limits));
        case FileKind::session:
            return kind_or_error(read_session_log(file, limits));
        case FileKind::asset:
            break;
    }
    return kind_or_error(read_asset(file, limits));
}

}  // namespace knead
