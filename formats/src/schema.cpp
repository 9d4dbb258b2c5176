// SPDX-License-Identifier: Apache-2.0
#include "schema.h"

namespace knead {

void Schema::refuse(ErrorCode code, const std::string& message, const std::string& path) const {
    fail(code, message, file_ + "#" + path);
}

Node& Schema::find(const std::string& path) {
    const auto found = payload_.nodes.find(path);
    if (found == payload_.nodes.end()) refuse(ErrorCode::missing, "is not in the file", path);
    found->second.known = true;
    return found->second;
}

void Schema::group(const std::string& path) {
    if (!find(path).is_group) refuse(ErrorCode::wrong_type, "is a dataset, not a group", path);
}

void Schema::check_units(const Node& node, const std::string& units, const std::string& path) const {
    const auto found = node.attributes.find("units");
    const std::string where = path + "@units";
    if (found == node.attributes.end()) refuse(ErrorCode::missing, "the attribute is not in the file", where);
    const Value& value = found->second;
    if (value.type != ScalarType::text)
        refuse(ErrorCode::wrong_type, "is " + value.shape_text() + ", not text", where);
    if (!value.extents.empty())
        refuse(ErrorCode::wrong_extent, "is " + value.shape_text() + ", not one text", where);
    if (value.text() != units)
        refuse(ErrorCode::invalid_data, "is \"" + value.text() + "\" instead of \"" + units + "\"", where);
}

std::uint64_t Schema::dataset(const std::string& path, ScalarType type,
                              const std::vector<std::uint64_t>& extents, const std::string& units) {
    Node& node = find(path);
    if (node.is_group) refuse(ErrorCode::wrong_type, "is a group, not a dataset", path);
    const Value& value = node.value;
    if (value.type != type)
        refuse(ErrorCode::wrong_type, "is " + value.shape_text() + ", not " + to_string(type), path);
    bool fits = value.extents.size() == extents.size();
    for (std::size_t i = 0; fits && i < extents.size(); ++i)
        fits = extents[i] == kAnyExtent || extents[i] == value.extents[i];
    if (!fits) {
        std::string wanted;
        for (const std::uint64_t e : extents)
            wanted +=
                (wanted.empty() ? "[" : ", ") + (e == kAnyExtent ? std::string("any") : std::to_string(e));
        refuse(ErrorCode::wrong_extent, "is " + value.shape_text() + ", not " + wanted + "]", path);
    }
    check_units(node, units, path);
    return value.extents[0];
}

std::uint64_t Schema::index_dataset(const std::string& path, const std::vector<std::uint64_t>& extents) {
    const ScalarType type = find(path).value.type;
    const bool small = type == ScalarType::u8 || type == ScalarType::u16;
    return dataset(path, small ? type : ScalarType::u32, extents, "1");
}

std::uint64_t Schema::text_dataset(const std::string& path) {
    const std::uint64_t count = dataset(path, ScalarType::text, {kAnyExtent}, "none");
    limit(count, limits_.max_names, "texts", path);
    return count;
}

const Value& Schema::attribute(const std::string& path, const std::string& name, ScalarType type) {
    const Node& node = find(path);
    const auto found = node.attributes.find(name);
    const std::string where = path + "@" + name;
    if (found == node.attributes.end()) refuse(ErrorCode::missing, "the attribute is not in the file", where);
    const Value& value = found->second;
    if (value.type != type)
        refuse(ErrorCode::wrong_type, "is " + value.shape_text() + ", not " + to_string(type), where);
    if (!value.extents.empty())
        refuse(ErrorCode::wrong_extent, "is " + value.shape_text() + ", not a scalar", where);
    return value;
}

void Schema::text_attribute(const std::string& path, const std::string& name) {
    attribute(path, name, ScalarType::text);
}

void Schema::number_attribute(const std::string& path, const std::string& name, ScalarType type) {
    attribute(path, name, type);
}

std::vector<std::string> Schema::children(const std::string& group) const {
    std::vector<std::string> names;
    const std::string prefix = group + "/";
    for (auto i = payload_.nodes.lower_bound(prefix); i != payload_.nodes.end(); ++i) {
        if (i->first.compare(0, prefix.size(), prefix) != 0) break;
        if (i->first.find('/', prefix.size()) == std::string::npos)
            names.push_back(i->first.substr(prefix.size()));
    }
    return names;
}

void Schema::limit(std::uint64_t found, std::uint64_t most, const char* what, const std::string& path) const {
    if (found > most)
        refuse(ErrorCode::too_large,
               std::to_string(found) + " " + what + " pass the limit of " + std::to_string(most), path);
}

void Schema::refuse_unknown() const {
    for (const auto& [path, node] : payload_.nodes)
        if (!node.known)
            refuse(ErrorCode::invalid_data, "does not belong in a file of this kind and version", path);
}

std::vector<std::uint32_t> Schema::take_index(const std::string& path) {
    const ScalarType type = payload_.nodes.at(path).value.type;
    if (type == ScalarType::u32) return take<std::uint32_t>(path);
    if (type == ScalarType::u16) {
        const auto narrow = take<std::uint16_t>(path);
        return {narrow.begin(), narrow.end()};
    }
    const auto narrow = take<std::uint8_t>(path);
    return {narrow.begin(), narrow.end()};
}

std::vector<std::string> Schema::take_texts(const std::string& path) {
    const Value& value = payload_.nodes.at(path).value;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < value.count(); ++i)
        texts.push_back(value.text(i));
    return texts;
}

std::string Schema::text_of(const std::string& path, const std::string& name) const {
    return payload_.nodes.at(path).attributes.at(name).text();
}

void check_shape(FileKind kind, Schema& schema) {
    schema.group("/knead");
    if (kind == FileKind::overlap) return check_overlap_shape(schema);
    if (kind == FileKind::asset) return check_asset_shape(schema);
    if (kind == FileKind::session) return check_session_shape(schema);
    const std::uint64_t tetrahedra = check_tet_mesh_shape(schema);
    if (kind != FileKind::tet_mesh) check_material_shape(schema, tetrahedra);
    if (kind == FileKind::clustering) check_clustering_shape(schema, tetrahedra);
}

}  // namespace knead
