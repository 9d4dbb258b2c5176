// SPDX-License-Identifier: Apache-2.0
// The two loops for one instruction set; included by core_speed.cpp once for each, with kLanes set.

using Vector = float __attribute__((vector_size(4 * kLanes)));

/// @return operations done
inline double multiply_add(long rounds, float& sink) {
    Vector chain[kChains];
    for (int k = 0; k < kChains; ++k)
        chain[k] = Vector{} + static_cast<float>(k);
    const Vector factor = Vector{} + 0.999F;
    const Vector term = Vector{} + 0.001F;
    for (long round = 0; round < rounds; ++round) {
#pragma GCC unroll 16
        for (int k = 0; k < kChains; ++k)
            chain[k] = chain[k] * factor + term;
    }
    Vector sum{};
    for (int k = 0; k < kChains; ++k)
        sum += chain[k];
    for (int lane = 0; lane < kLanes; ++lane)
        sink += sum[lane];
    return 2.0 * kChains * kLanes * static_cast<double>(rounds);
}

/// @param data aligned to a vector  @param count a multiple of kReadUnit
inline void read_all(const float* data, std::size_t count, float& sink) {
    constexpr int kSums = 8;
    Vector sum[kSums] = {};
    for (std::size_t i = 0; i < count; i += kSums * kLanes) {
#pragma GCC unroll 8
        for (int k = 0; k < kSums; ++k)
            sum[k] += *reinterpret_cast<const Vector*>(data + i + static_cast<std::size_t>(k * kLanes));
    }
    for (int k = 0; k < kSums; ++k)
        for (int lane = 0; lane < kLanes; ++lane)
            sink += sum[k][lane];
}
