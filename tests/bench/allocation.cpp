// SPDX-License-Identifier: Apache-2.0
#include "bench/allocation.h"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define KNEAD_HOOK extern "C" __attribute__((visibility("default")))

// The allocator behind the names that this file takes over.
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT
void* __libc_realloc(void* block, std::size_t size);             // NOLINT
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT
void __libc_free(void* block);                                   // NOLINT
}

namespace {

std::atomic<std::uint64_t> calls{0};      // NOLINT: counts for the whole process
std::atomic<std::int64_t> live_bytes{0};  // NOLINT

std::int64_t usable(void* block) {
    return block == nullptr ? 0 : static_cast<std::int64_t>(malloc_usable_size(block));
}

void* counted(void* block) {
    calls.fetch_add(1, std::memory_order_relaxed);
    live_bytes.fetch_add(usable(block), std::memory_order_relaxed);
    return block;
}

}  // namespace

KNEAD_HOOK void* malloc(std::size_t size) {
    return counted(__libc_malloc(size));
}
KNEAD_HOOK void* calloc(std::size_t count, std::size_t size) {
    return counted(__libc_calloc(count, size));
}
KNEAD_HOOK void* realloc(void* block, std::size_t size) {
    const std::int64_t before = usable(block);
    void* const moved = __libc_realloc(block, size);
    if (moved != nullptr || size == 0) live_bytes.fetch_sub(before, std::memory_order_relaxed);
    return counted(moved);
}
KNEAD_HOOK void* memalign(std::size_t alignment, std::size_t size) {
    return counted(__libc_memalign(alignment, size));
}
KNEAD_HOOK void* aligned_alloc(std::size_t alignment, std::size_t size) {
    return counted(__libc_memalign(alignment, size));
}
KNEAD_HOOK int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
    void* const block = counted(__libc_memalign(alignment, size));
    if (block == nullptr && size > 0) return ENOMEM;
    *out = block;
    return 0;
}
KNEAD_HOOK void free(void* block) {
    live_bytes.fetch_sub(usable(block), std::memory_order_relaxed);
    __libc_free(block);
}

namespace knead::bench {

AllocationCount allocation_count() {
    return {calls.load(std::memory_order_relaxed), live_bytes.load(std::memory_order_relaxed)};
}

}  // namespace knead::bench
#else
knead::bench::AllocationCount knead::bench::allocation_count() {
    return {};
}
#endif
