// SPDX-License-Identifier: Apache-2.0
#include "bench/core_speed.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>

namespace knead::bench {
namespace {

/// More chains than the latency of a multiply-add times the units that do it.
constexpr int kChains = 12;
/// Floats; a multiple of what every loop reads at once.
constexpr std::size_t kReadUnit = 128;

namespace plain {
constexpr int kLanes = 4;
#include "bench/core_speed.inl"
}  // namespace plain

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
constexpr int kLanes = 8;
#include "bench/core_speed.inl"
}  // namespace avx2
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f,prefer-vector-width=512")
namespace avx512 {
constexpr int kLanes = 16;
#include "bench/core_speed.inl"
}  // namespace avx512
#pragma GCC pop_options
#endif

struct Kernels {
    const char* name;
    double (*multiply_add)(long rounds, float& sink);
    void (*read_all)(const float* data, std::size_t count, float& sink);
};

Kernels widest() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return {"avx512f", avx512::multiply_add, avx512::read_all};
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return {"avx2+fma", avx2::multiply_add, avx2::read_all};
    return {"sse2", plain::multiply_add, plain::read_all};
#else
    return {"portable", plain::multiply_add, plain::read_all};
#endif
}

volatile float keep;  // NOLINT: what is stored here cannot be left out

double seconds_of(const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

constexpr int kRepetitions = 7;
constexpr long kRounds = 400'000;
constexpr std::size_t kBytesPerRepetition = std::size_t{64} << 20;

}  // namespace

double measure_peak_flops() {
    const Kernels kernels = widest();
    double best = 0;
    for (int k = 0; k < kRepetitions; ++k) {
        double operations = 0;
        float sink = 0;
        const double s = seconds_of([&] { operations = kernels.multiply_add(kRounds, sink); });
        keep = sink;
        best = std::max(best, operations / s);
    }
    return best;
}

double measure_read_bytes_per_s(std::size_t working_set_bytes) {
    const Kernels kernels = widest();
    const std::size_t count =
        std::max<std::size_t>(1, working_set_bytes / sizeof(float) / kReadUnit) * kReadUnit;
    const std::size_t bytes = count * sizeof(float);
    const std::unique_ptr<float, void (*)(void*)> data(static_cast<float*>(std::aligned_alloc(64, bytes)),
                                                       std::free);
    std::fill_n(data.get(), count, 1.0F);
    const std::size_t times = std::max<std::size_t>(1, kBytesPerRepetition / bytes);
    double best = 0;
    for (int k = 0; k < kRepetitions; ++k) {
        float sink = 0;
        const double s = seconds_of([&] {
            for (std::size_t i = 0; i < times; ++i)
                kernels.read_all(data.get(), count, sink);
        });
        keep = sink;
        best = std::max(best, static_cast<double>(times * bytes) / s);
    }
    return best;
}

std::string instruction_set() {
    return widest().name;
}

}  // namespace knead::bench
