// SPDX-License-Identifier: Apache-2.0
#include "haptics/triple_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "haptics/duration_histogram.h"

namespace knead::test {
namespace {

TEST(TripleBuffer, gives_the_newest_value_once) {
    TripleBuffer<int> buffer;
    int value = -1;
    EXPECT_FALSE(buffer.read(value));
    EXPECT_EQ(value, -1);
    for (int i = 0; i < 5; ++i)
        buffer.write(i);
    EXPECT_TRUE(buffer.read(value));
    EXPECT_EQ(value, 4);
    EXPECT_FALSE(buffer.read(value));
    buffer.write(7);
    EXPECT_TRUE(buffer.read(value));
    EXPECT_EQ(value, 7);
}

TEST(TripleBuffer, between_two_threads_never_tears_a_value_nor_goes_back) {
    struct Wide {
        std::array<std::uint64_t, 64> copies{};
    };
    constexpr std::uint64_t kLast = 20'000;
    TripleBuffer<Wide> buffer;
    std::thread writer([&] {
        for (std::uint64_t i = 1; i <= kLast; ++i) {
            Wide wide;
            wide.copies.fill(i);
            buffer.write(wide);
        }
    });
    std::uint64_t seen = 0;
    bool whole = true, forward = true;
    while (seen < kLast) {
        Wide wide;
        if (!buffer.read(wide)) {
            std::this_thread::yield();
            continue;
        }
        for (const std::uint64_t copy : wide.copies)
            whole = whole && copy == wide.copies[0];
        forward = forward && wide.copies[0] > seen;
        seen = wide.copies[0];
    }
    writer.join();
    EXPECT_TRUE(whole);
    EXPECT_TRUE(forward);
    EXPECT_EQ(seen, kLast);
}

TEST(DurationHistogram, finds_shares_to_three_percent_and_the_longest_exactly) {
    DurationHistogram histogram;
    for (std::uint64_t ns = 1; ns <= 10'000; ++ns)
        histogram.add(100 * ns);
    const DurationStatistics s = histogram.statistics();
    EXPECT_EQ(s.count, 10'000u);
    EXPECT_NEAR(s.p50_s, 5e-4, 0.032 * 5e-4);
    EXPECT_NEAR(s.p99_s, 9.9e-4, 0.032 * 9.9e-4);
    EXPECT_NEAR(s.p999_s, 9.99e-4, 0.032 * 9.99e-4);
    EXPECT_DOUBLE_EQ(s.max_s, 1e-3);
    histogram.clear();
    EXPECT_EQ(histogram.statistics().count, 0u);
    EXPECT_EQ(histogram.statistics().max_s, 0);
    histogram.add(std::uint64_t{1} << 60);  // longer than the last bin
    EXPECT_EQ(histogram.statistics().count, 1u);
}

}  // namespace
}  // namespace knead::test
