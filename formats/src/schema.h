// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "knead/formats/session_log.h"
#include "payload.h"

namespace knead {

/// Any extent, in Schema::dataset().
inline constexpr std::uint64_t kAnyExtent = ~std::uint64_t{0};

/// A payload seen through the description of the format: each call names something that belongs there, and
/// refuse_unknown() then refuses what nobody named. Errors are thrown as Failure with file and path.
class Schema {
  public:
    Schema(Payload& payload, std::string file, const ReadLimits& limits)
        : payload_(payload), file_(std::move(file)), limits_(limits) {}

    // Before the data is loaded -------------------------------------------------------------------------
    [[nodiscard]] bool has(const std::string& path) const { return payload_.nodes.count(path) != 0; }
    void group(const std::string& path);
    /// Presence, type, extents (kAnyExtent: free) and units. @return the first extent
    std::uint64_t dataset(const std::string& path, ScalarType type, const std::vector<std::uint64_t>& extents,
                          const std::string& units);
    /// As dataset(), of one of the unsigned types up to 32 bits.
    std::uint64_t index_dataset(const std::string& path, const std::vector<std::uint64_t>& extents);
    /// A list of texts, at most max_names of them.
    std::uint64_t text_dataset(const std::string& path);
    /// A text attribute of a group or dataset named before.
    void text_attribute(const std::string& path, const std::string& name);
    void number_attribute(const std::string& path, const std::string& name, ScalarType type);
    /// Names of the children of a group, in order.
    [[nodiscard]] std::vector<std::string> children(const std::string& group) const;
    void limit(std::uint64_t found, std::uint64_t most, const char* what, const std::string& path) const;
    void refuse_unknown() const;
    [[noreturn]] void refuse(ErrorCode code, const std::string& message, const std::string& path) const;

    // After the data is loaded ---------------------------------------------------------------------------
    /// The elements of a dataset; frees its bytes. T may be an array of the stored type.
    template <class T>
    [[nodiscard]] std::vector<T> take(const std::string& path) {
        Value& value = payload_.nodes.at(path).value;
        std::vector<T> elements(value.bytes.size() / sizeof(T));
        if (!elements.empty()) std::memcpy(elements.data(), value.bytes.data(), elements.size() * sizeof(T));
        value.bytes = {};
        value.storage = {};
        return elements;
    }
    [[nodiscard]] std::vector<std::uint32_t> take_index(const std::string& path);
    [[nodiscard]] std::vector<std::string> take_texts(const std::string& path);
    /// The value of a dataset of one element; T may be an array of the stored type.
    template <class T>
    [[nodiscard]] T take_one(const std::string& path) {
        return take<T>(path).at(0);
    }
    [[nodiscard]] std::string text_of(const std::string& path, const std::string& name) const;
    template <class T>
    [[nodiscard]] T number_of(const std::string& path, const std::string& name) const {
        T number;
        std::memcpy(&number, payload_.nodes.at(path).attributes.at(name).bytes.data(), sizeof number);
        return number;
    }

    [[nodiscard]] const ReadLimits& limits() const noexcept { return limits_; }

  private:
    Node& find(const std::string& path);
    void check_units(const Node& node, const std::string& units, const std::string& path) const;
    const Value& attribute(const std::string& path, const std::string& name, ScalarType type);

    Payload& payload_;
    std::string file_;
    const ReadLimits& limits_;
};

// One description per part of the format: check_*() before the data is loaded, take_*() after. `group` is the
// path of the part. The writers' side of the same is in write/encode.h.

void check_shape(FileKind kind, Schema& schema);  ///< all of /knead

/// Nodes and tetrahedra below `group`. @return the number of tetrahedra
std::uint64_t check_mesh_shape(Schema& schema, const std::string& group);
std::uint64_t check_tet_mesh_shape(Schema& schema);  ///< @return the number of tetrahedra
[[nodiscard]] TetMesh take_tet_mesh(Schema& schema);
void check_material_shape(Schema& schema, std::uint64_t tetrahedra);
[[nodiscard]] Material take_material(Schema& schema);
void check_clustering_shape(Schema& schema, std::uint64_t tetrahedra);
[[nodiscard]] Clustering take_clustering(Schema& schema);
void check_overlap_shape(Schema& schema);
[[nodiscard]] OverlapMatrix take_overlap(Schema& schema);
void check_asset_shape(Schema& schema);
[[nodiscard]] Asset take_asset(Schema& schema);
void check_session_shape(Schema& schema);
[[nodiscard]] SessionLog take_session(Schema& schema);
void check_provenance(Schema& schema);
[[nodiscard]] Provenance take_provenance(Schema& schema);
[[nodiscard]] std::vector<Asset::Request> take_requests(Schema& schema);

}  // namespace knead
