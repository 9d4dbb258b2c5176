// SPDX-License-Identifier: Apache-2.0
// What libFuzzer and replay.cpp call: a target with an eye on its time.
#include <ctime>

#include "fuzz/target.h"

namespace {

/// Of the processor, not of the clock on the wall: a machine shared with others proves nothing.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr double kMostSeconds = 1;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const double start = processor_seconds();
    knead::fuzz::read_hostile_file(data, size);
    knead::fuzz::expect(processor_seconds() - start <= kMostSeconds, "a file is read in a second");
    return 0;
}
