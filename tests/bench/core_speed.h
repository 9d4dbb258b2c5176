// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace knead::bench {

/// Single-precision multiply-adds that this core does in a second, in the widest registers that it has, from
/// twelve independent chains; a multiply-add counts as two operations.
[[nodiscard]] double measure_peak_flops();

/// Bytes in a second that this core reads from a block of `working_set_bytes` it goes through again and
/// again: the bandwidth of the cache that the block fits, or of memory.
[[nodiscard]] double measure_read_bytes_per_s(std::size_t working_set_bytes);

/// The widest instruction set of this core that the measurements above know: "avx512f", "avx2+fma", ...
[[nodiscard]] std::string instruction_set();

}  // namespace knead::bench
