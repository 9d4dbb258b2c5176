// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <string>

#include "payload.h"

namespace knead {

/// Calls `use` with element `index` of a loaded numeric value, in its stored type.
template <class Use>
auto with_element(const Value& value, std::size_t index, Use&& use) {
    const auto read = [&](auto element) {
        std::memcpy(&element, value.bytes.data() + index * sizeof element, sizeof element);
        return use(element);
    };
    switch (value.type) {
        case ScalarType::i8:
            return read(std::int8_t{});
        case ScalarType::u8:
            return read(std::uint8_t{});
        case ScalarType::i16:
            return read(std::int16_t{});
        case ScalarType::u16:
            return read(std::uint16_t{});
        case ScalarType::i32:
            return read(std::int32_t{});
        case ScalarType::u32:
            return read(std::uint32_t{});
        case ScalarType::i64:
            return read(std::int64_t{});
        case ScalarType::u64:
            return read(std::uint64_t{});
        case ScalarType::f32:
            return read(float{});
        default:
            return read(double{});
    }
}

/// Shortest text that reads back as the same number; independent of the locale.
template <class T>
std::string number_text(T number) {
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
    return {buffer, end};
}

/// Element `index` of a loaded value as text.
inline std::string element_text(const Value& value, std::size_t index) {
    if (value.type == ScalarType::text) return value.text(index);
    return with_element(value, index, [](auto element) { return number_text(element); });
}

}  // namespace knead
