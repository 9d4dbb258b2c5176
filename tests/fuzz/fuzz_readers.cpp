// SPDX-License-Identifier: Apache-2.0
// libFuzzer target over all readers. Build with clang and -DKNEAD_BUILD_FUZZERS=ON; run with a folder of
// valid files as the corpus (tests/golden/files holds one of each kind):
// fuzz_readers CORPUS -max_len=65536 -rss_limit_mb=4096 -detect_leaks=0
// (HDF5 1.10 leaks a little when it refuses a damaged file).
#include <fcntl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "knead/formats/inspect.h"

namespace {

/// What a mutant may claim before the reader refuses: keeps the fuzzer's memory and time small.
knead::ReadLimits small_limits() {
    knead::ReadLimits limits;
    limits.max_nodes = limits.max_tetrahedra = limits.max_overlap_entries = 100'000;
    limits.max_names = 64;
    limits.max_bytes = std::uint64_t{64} << 20;
    return limits;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string path = "/dev/shm/knead-mutant-" + std::to_string(::getpid()) + ".hdf";
    static const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0 || ::ftruncate(file, 0) != 0) return 0;
    if (::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) return 0;
    (void)knead::validate_file(path, small_limits()).ok();
    (void)knead::inspect_file(path, small_limits()).ok();
    return 0;
}
