// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "knead/haptics/run_statistics.h"

namespace knead {

/// Counts durations in bins that are a thirty-second of a power of two wide: 3 % from 32 ns on, exact below.
///
/// One thread adds; any thread may look at the same time. Adding is a load and a store: no lock, no
/// allocation.
class DurationHistogram {
  public:
    void add(std::uint64_t ns) noexcept {
        raise(bins_[bin(ns)]);
        if (ns > longest_ns_.load(std::memory_order_relaxed))
            longest_ns_.store(ns, std::memory_order_relaxed);
    }

    void clear() noexcept {
        for (auto& count : bins_)
            count.store(0, std::memory_order_relaxed);
        longest_ns_.store(0, std::memory_order_relaxed);
    }

    [[nodiscard]] DurationStatistics statistics() const noexcept {
        DurationStatistics result;
        std::array<std::uint32_t, kBins> counts{};
        for (std::size_t i = 0; i < kBins; ++i)
            result.count += counts[i] = bins_[i].load(std::memory_order_relaxed);
        result.max_s = 1e-9 * static_cast<double>(longest_ns_.load(std::memory_order_relaxed));
        const auto below = [&](double share) {
            const double wanted = share * static_cast<double>(result.count);
            std::uint64_t seen = 0;
            for (std::size_t i = 0; i < kBins; ++i) {
                seen += counts[i];
                if (static_cast<double>(seen) >= wanted && seen > 0)
                    return std::min(result.max_s, 1e-9 * static_cast<double>(upper_ns(i)));
            }
            return 0.0;
        };
        result.p50_s = below(0.5);
        result.p99_s = below(0.99);
        result.p999_s = below(0.999);
        return result;
    }

  private:
    static constexpr unsigned kFineBits = 5;
    static constexpr std::uint64_t kFine = 1u << kFineBits;
    static constexpr unsigned kLargestBits = 36;  ///< 69 s; what is longer goes to the last bin
    static constexpr std::size_t kBins = (kLargestBits - kFineBits + 1) * kFine;

    static std::size_t bin(std::uint64_t ns) noexcept {
        if (ns < kFine) return static_cast<std::size_t>(ns);
        const unsigned shift = static_cast<unsigned>(std::bit_width(ns)) - 1 - kFineBits;
        return std::min<std::size_t>(kBins - 1, (shift + 1) * kFine + ((ns >> shift) - kFine));
    }
    /// The longest duration of a bin.
    static std::uint64_t upper_ns(std::size_t bin) noexcept {
        if (bin < kFine) return bin;
        const std::size_t shift = bin / kFine - 1;
        return ((bin % kFine + kFine + 1) << shift) - 1;
    }
    static void raise(std::atomic<std::uint32_t>& count) noexcept {
        count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }

    std::array<std::atomic<std::uint32_t>, kBins> bins_{};
    std::atomic<std::uint64_t> longest_ns_{0};
};

}  // namespace knead
