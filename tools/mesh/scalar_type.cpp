// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/scalar_type.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

namespace knead::tools {
namespace {

template <class T>
double decode_as(const char* bytes, bool big_endian) {
    char buffer[sizeof(T)];
    std::memcpy(buffer, bytes, sizeof(T));
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(buffer, buffer + sizeof(T));
    T value;
    std::memcpy(&value, buffer, sizeof(T));
    return static_cast<double>(value);
}

template <std::size_t N>
ScalarType find(const std::pair<const char*, ScalarType> (&names)[N], std::string_view wanted) {
    for (const auto& [name, type] : names)
        if (wanted == name) return type;
    return ScalarType::none;
}

}  // namespace

std::size_t size_of(ScalarType type) {
    switch (type) {
        case ScalarType::none:
            return 0;
        case ScalarType::int8:
        case ScalarType::uint8:
            return 1;
        case ScalarType::int16:
        case ScalarType::uint16:
            return 2;
        case ScalarType::int32:
        case ScalarType::uint32:
        case ScalarType::float32:
            return 4;
        case ScalarType::int64:
        case ScalarType::uint64:
        case ScalarType::float64:
            return 8;
    }
    return 0;
}

ScalarType ply_type(std::string_view name) {
    static constexpr std::pair<const char*, ScalarType> kNames[] = {
        {"char", ScalarType::int8},      {"int8", ScalarType::int8},       {"uchar", ScalarType::uint8},
        {"uint8", ScalarType::uint8},    {"short", ScalarType::int16},     {"int16", ScalarType::int16},
        {"ushort", ScalarType::uint16},  {"uint16", ScalarType::uint16},   {"int", ScalarType::int32},
        {"int32", ScalarType::int32},    {"uint", ScalarType::uint32},     {"uint32", ScalarType::uint32},
        {"float", ScalarType::float32},  {"float32", ScalarType::float32}, {"double", ScalarType::float64},
        {"float64", ScalarType::float64}};
    return find(kNames, name);
}

ScalarType vtk_type(std::string_view name) {
    static constexpr std::pair<const char*, ScalarType> kNames[] = {{"char", ScalarType::int8},
                                                                    {"signed_char", ScalarType::int8},
                                                                    {"vtktypeint8", ScalarType::int8},
                                                                    {"unsigned_char", ScalarType::uint8},
                                                                    {"vtktypeuint8", ScalarType::uint8},
                                                                    {"short", ScalarType::int16},
                                                                    {"vtktypeint16", ScalarType::int16},
                                                                    {"unsigned_short", ScalarType::uint16},
                                                                    {"vtktypeuint16", ScalarType::uint16},
                                                                    {"int", ScalarType::int32},
                                                                    {"vtktypeint32", ScalarType::int32},
                                                                    {"vtkIdType", ScalarType::int32},
                                                                    {"vtkidtype", ScalarType::int32},
                                                                    {"unsigned_int", ScalarType::uint32},
                                                                    {"vtktypeuint32", ScalarType::uint32},
                                                                    {"long", ScalarType::int64},
                                                                    {"vtktypeint64", ScalarType::int64},
                                                                    {"unsigned_long", ScalarType::uint64},
                                                                    {"vtktypeuint64", ScalarType::uint64},
                                                                    {"float", ScalarType::float32},
                                                                    {"vtktypefloat32", ScalarType::float32},
                                                                    {"double", ScalarType::float64},
                                                                    {"vtktypefloat64", ScalarType::float64}};
    return find(kNames, name);
}

double decode(ScalarType type, const char* bytes, bool big_endian) {
    switch (type) {
        case ScalarType::none:
            return 0;
        case ScalarType::int8:
            return decode_as<std::int8_t>(bytes, big_endian);
        case ScalarType::uint8:
            return decode_as<std::uint8_t>(bytes, big_endian);
        case ScalarType::int16:
            return decode_as<std::int16_t>(bytes, big_endian);
        case ScalarType::uint16:
            return decode_as<std::uint16_t>(bytes, big_endian);
        case ScalarType::int32:
            return decode_as<std::int32_t>(bytes, big_endian);
        case ScalarType::uint32:
            return decode_as<std::uint32_t>(bytes, big_endian);
        case ScalarType::int64:
            return decode_as<std::int64_t>(bytes, big_endian);
        case ScalarType::uint64:
            return decode_as<std::uint64_t>(bytes, big_endian);
        case ScalarType::float32:
            return decode_as<float>(bytes, big_endian);
        case ScalarType::float64:
            return decode_as<double>(bytes, big_endian);
    }
    return 0;
}

}  // namespace knead::tools
