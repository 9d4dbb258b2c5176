// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "failure.h"
#include "knead/formats/read.h"

namespace knead {

static_assert(std::endian::native == std::endian::little, "the payload's bytes are little-endian");

/// The only element types that a Knead file holds. `text` is fixed-length and padded with zeros.
enum class ScalarType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, text };

[[nodiscard]] const char* to_string(ScalarType type);
[[nodiscard]] std::size_t size_of(ScalarType type);  ///< bytes; 1 for text

template <class T>
constexpr ScalarType scalar_type_of() {
    if constexpr (std::is_same_v<T, std::uint8_t>) return ScalarType::u8;
    if constexpr (std::is_same_v<T, std::uint16_t>) return ScalarType::u16;
    if constexpr (std::is_same_v<T, std::int32_t>) return ScalarType::i32;
    if constexpr (std::is_same_v<T, std::uint32_t>) return ScalarType::u32;
    if constexpr (std::is_same_v<T, std::int64_t>) return ScalarType::i64;
    if constexpr (std::is_same_v<T, std::uint64_t>) return ScalarType::u64;
    if constexpr (std::is_same_v<T, float>) return ScalarType::f32;
    if constexpr (std::is_same_v<T, double>) return ScalarType::f64;
}

/// An array of one element type: a dataset's or an attribute's content. `bytes` looks at `storage` or, while
/// writing, at the caller's arrays. Not copied, because `bytes` would keep looking at the original.
struct Value {
    ScalarType type = ScalarType::u8;
    std::size_t element_bytes = 1;       ///< text: its fixed length
    std::vector<std::uint64_t> extents;  ///< empty: a scalar
    std::span<const std::byte> bytes;    ///< empty until loaded
    std::vector<std::byte> storage;

    Value() = default;
    Value(Value&&) = default;
    Value& operator=(Value&&) = default;
    Value(const Value&) = delete;
    Value& operator=(const Value&) = delete;

    [[nodiscard]] std::uint64_t count() const;                    ///< product of the extents; saturates
    [[nodiscard]] std::uint64_t byte_count() const;               ///< saturates
    [[nodiscard]] std::string shape_text() const;                 ///< "float64 [8, 3]"
    [[nodiscard]] std::string text(std::size_t index = 0) const;  ///< precondition: text, loaded
};

/// A value that looks at `elements`, which must outlive it.
template <class T>
Value view_of(std::span<const T> elements, std::vector<std::uint64_t> extents) {
    Value value;
    value.type = scalar_type_of<T>();
    value.element_bytes = sizeof(T);
    value.extents = std::move(extents);
    value.bytes = std::as_bytes(elements);
    return value;
}
/// A value that owns a copy of `elements`.
template <class T>
Value copy_of(std::span<const T> elements, std::vector<std::uint64_t> extents) {
    Value value = view_of(elements, std::move(extents));
    value.storage.assign(value.bytes.begin(), value.bytes.end());
    value.bytes = value.storage;
    return value;
}
[[nodiscard]] Value text_value(const std::string& text);
[[nodiscard]] Value text_array(const std::vector<std::string>& texts);

/// A group or a dataset.
struct Node {
    bool is_group = true;
    Value value;  ///< datasets only
    std::map<std::string, Value> attributes;
    std::uint64_t bytes_on_disk = 0;  ///< header and stored data; set by the reader
    bool known = false;               ///< the format's description of this kind names it
};

/// What lies under /knead or /provenance, by absolute path. The order of the map is the order on disk and in
/// the content hash: parents stand before their children.
struct Payload {
    std::map<std::string, Node> nodes;

    Node& add_group(const std::string& path);
    Node& add_dataset(const std::string& path, Value value, const std::string& units);
};

/// SHA-256 of kind, paths, types, extents, attributes and bytes (docs/format.md, "Content hash").
/// Precondition: every value is loaded.
[[nodiscard]] std::string content_hash(FileKind kind, const Payload& payload);

}  // namespace knead
