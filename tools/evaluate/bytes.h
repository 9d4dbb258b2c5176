// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <type_traits>
#include <vector>

namespace knead::tools {

/// Appends the bytes of numbers, for hashes and for the cache (which stays on its machine).
template <class T>
void append_bytes(std::string& bytes, const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}
inline void append_bytes(std::string& bytes, const std::vector<bool>& values) {
    for (const bool value : values)
        bytes += value ? '1' : '0';
}

}  // namespace knead::tools
