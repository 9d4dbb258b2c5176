// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace knead::tools {

/// Random numbers that are the same on every platform: the raw bits of std::mt19937_64 are laid down by the
/// standard, the standard's distributions and std::shuffle are not, so the mapping is ours.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Uniform in [low, high): 53 random bits scaled to the range.
    double uniform(double low, double high) {
        const double unit = static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
        return low + (high - low) * unit;
    }

    /// Uniform in [0, count), without bias. Precondition: count > 0.
    std::uint64_t below(std::uint64_t count) {
        const std::uint64_t unbiased_end = UINT64_MAX - UINT64_MAX % count;
        std::uint64_t bits = engine_();
        while (bits >= unbiased_end)
            bits = engine_();
        return bits % count;
    }

    /// Fisher-Yates.
    template <class T>
    void shuffle(std::vector<T>& values) {
        for (std::size_t left = values.size(); left > 1; --left)
            std::swap(values[left - 1], values[below(left)]);
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace knead::tools
