// SPDX-License-Identifier: Apache-2.0
#include "payload.h"

#include <algorithm>
#include <array>
#include <limits>

#include "sha256.h"

namespace knead {
namespace {

constexpr std::uint64_t kSaturated = std::numeric_limits<std::uint64_t>::max();

std::uint64_t saturating_product(std::uint64_t a, std::uint64_t b) {
    std::uint64_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? kSaturated : product;
}

void hash_number(Sha256& hash, std::uint64_t number) {
    hash.update(&number, sizeof number);
}

void hash_text(Sha256& hash, const std::string& text) {
    hash_number(hash, text.size());
    hash.update(text.data(), text.size());
}

void hash_value(Sha256& hash, const Value& value) {
    hash_text(hash, to_string(value.type));
    hash_number(hash, value.element_bytes);
    hash_number(hash, value.extents.size());
    for (const std::uint64_t extent : value.extents)
        hash_number(hash, extent);
    hash.update(value.bytes.data(), value.bytes.size());
}

}  // namespace

const char* to_string(ScalarType type) {
    static constexpr std::array<const char*, 11> kNames{"int8",    "uint8",   "int16", "uint16",
                                                        "int32",   "uint32",  "int64", "uint64",
                                                        "float32", "float64", "text"};
    return kNames[static_cast<std::size_t>(type)];
}

std::size_t size_of(ScalarType type) {
    static constexpr std::array<std::size_t, 11> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8, 1};
    return kSizes[static_cast<std::size_t>(type)];
}

std::uint64_t Value::count() const {
    std::uint64_t product = 1;
    for (const std::uint64_t extent : extents)
        product = saturating_product(product, extent);
    return product;
}

std::uint64_t Value::byte_count() const {
    return saturating_product(count(), element_bytes);
}

std::string Value::shape_text() const {
    std::string text = to_string(type);
    if (extents.empty()) return text + " scalar";
    for (std::size_t i = 0; i < extents.size(); ++i)
        text += (i == 0 ? " [" : ", ") + std::to_string(extents[i]);
    return text + "]";
}

std::string Value::text(std::size_t index) const {
    const char* begin = reinterpret_cast<const char*>(bytes.data()) + index * element_bytes;
    return {begin, std::find(begin, begin + element_bytes, '\0')};
}

Value text_value(const std::string& text) {
    Value value = text_array({text});
    value.extents.clear();
    return value;
}

Value text_array(const std::vector<std::string>& texts) {
    Value value;
    value.type = ScalarType::text;
    for (const std::string& text : texts)
        value.element_bytes = std::max(value.element_bytes, text.size());
    value.extents = {texts.size()};
    value.storage.resize(texts.size() * value.element_bytes);
    for (std::size_t i = 0; i < texts.size(); ++i)
        std::memcpy(value.storage.data() + i * value.element_bytes, texts[i].data(), texts[i].size());
    value.bytes = value.storage;
    return value;
}

Node& Payload::add_group(const std::string& path) {
    return nodes[path];
}

Node& Payload::add_dataset(const std::string& path, Value value, const std::string& units) {
    Node& node = nodes[path];
    node.is_group = false;
    node.value = std::move(value);
    node.attributes["units"] = text_value(units);
    return node;
}

std::string content_hash(FileKind kind, const Payload& payload) {
    Sha256 hash;
    hash_text(hash, "knead content 1");
    hash_text(hash, to_string(kind));
    for (const auto& [path, node] : payload.nodes) {
        hash_text(hash, node.is_group ? "group" : "dataset");
        hash_text(hash, path);
        hash_number(hash, node.attributes.size());
        for (const auto& [name, value] : node.attributes) {
            hash_text(hash, name);
            hash_value(hash, value);
        }
        if (!node.is_group) hash_value(hash, node.value);
    }
    return hash.hex_digest();
}

}  // namespace knead
