// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>

namespace knead::tools {

/// Number types of the binary parts of PLY and VTK files.
enum class ScalarType { none, int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] std::size_t size_of(ScalarType type);
/// "float", "uchar", "int32", ... as PLY spells them; none for another word.
[[nodiscard]] ScalarType ply_type(std::string_view name);
/// "float", "unsigned_char", "vtktypeint64", ... as VTK spells them; none for another word.
[[nodiscard]] ScalarType vtk_type(std::string_view name);
/// One number as a double. Precondition: size_of(type) bytes at `bytes`.
[[nodiscard]] double decode(ScalarType type, const char* bytes, bool big_endian);

}  // namespace knead::tools
