// SPDX-License-Identifier: Apache-2.0
#include "unit/runtime/watched_calls.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations{0};  // NOLINT: what this file is for
std::atomic<long> frees{0};        // NOLINT
std::atomic<long> locks{0};        // NOLINT

}  // namespace

namespace knead::test {

WatchedCalls watched_calls() noexcept {
    return {allocations, frees, locks};
}

}  // namespace knead::test

// ---- operator new: every form ends in the first two
// ----------------------------------------------------------------

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size);
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    ++allocations;
    const auto align = static_cast<std::size_t>(alignment);
    return std::aligned_alloc(align, (size + align - 1) / align * align);
}
void* operator new(std::size_t size) {
    if (void* memory = operator new(size, std::nothrow)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    if (void* memory = operator new(size, alignment, std::nothrow)) return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
    return operator new(size);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return operator new(size, alignment);
}
void* operator new[](std::size_t size, const std::nothrow_t& nothrow) noexcept {
    return operator new(size, nothrow);
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t& nothrow) noexcept {
    return operator new(size, alignment, nothrow);
}
void operator delete(void* memory) noexcept {
    ++frees;
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    operator delete(memory);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// ---- The C library's allocation
// ----------------------------------------------------------------------------

extern "C" {

// glibc's own names for its functions, for programs that replace them.
void* __libc_malloc(std::size_t size);                       // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size);    // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* memory, std::size_t size);        // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t align, std::size_t size);  // NOLINT(bugprone-reserved-identifier)
void __libc_free(void* memory);                              // NOLINT(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
    ++allocations;
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
    ++allocations;
    return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
    ++allocations;
    return __libc_realloc(memory, size);
}
void* memalign(std::size_t align, std::size_t size) noexcept {
    ++allocations;
    return __libc_memalign(align, size);
}
void* aligned_alloc(std::size_t align, std::size_t size) noexcept {
    return memalign(align, size);
}
int posix_memalign(void** memory, std::size_t align, std::size_t size) noexcept {
    *memory = memalign(align, size);
    return *memory != nullptr ? 0 : ENOMEM;
}
void free(void* memory) noexcept {
    ++frees;
    __libc_free(memory);
}

}  // extern "C"

// ---- Locks
// -------------------------------------------------------------------------------------------------

namespace {

/// Counts; then the function of that name that this program hides.
/// @param version of the symbol, where the C library has an older one too
template <class Function>
Function* watched(std::atomic<Function*>& next, const char* name, const char* version) noexcept {
    ++locks;
    if (next == nullptr) {
        void* found = version != nullptr ? dlvsym(RTLD_NEXT, name, version) : nullptr;
        next = reinterpret_cast<Function*>(found != nullptr ? found : dlsym(RTLD_NEXT, name));
    }
    return next;
}

}  // namespace

// NOLINTBEGIN(bugprone-macro-parentheses): lists of parameters and arguments, as they are
#define KNEAD_WATCH(name, version, parameters, arguments)               \
    extern "C" int name parameters {                                    \
        static std::atomic<int(*) parameters> next{nullptr};            \
        return watched<int parameters>(next, #name, version) arguments; \
    }
// NOLINTEND(bugprone-macro-parentheses)

KNEAD_WATCH(pthread_mutex_lock, nullptr, (pthread_mutex_t * m) noexcept, (m))
KNEAD_WATCH(pthread_mutex_trylock, nullptr, (pthread_mutex_t * m) noexcept, (m))
KNEAD_WATCH(pthread_mutex_timedlock, nullptr, (pthread_mutex_t * m, const timespec* t) noexcept, (m, t))
KNEAD_WATCH(pthread_rwlock_rdlock, nullptr, (pthread_rwlock_t * l) noexcept, (l))
KNEAD_WATCH(pthread_rwlock_tryrdlock, nullptr, (pthread_rwlock_t * l) noexcept, (l))
KNEAD_WATCH(pthread_rwlock_wrlock, nullptr, (pthread_rwlock_t * l) noexcept, (l))
KNEAD_WATCH(pthread_rwlock_trywrlock, nullptr, (pthread_rwlock_t * l) noexcept, (l))
KNEAD_WATCH(pthread_spin_lock, nullptr, (pthread_spinlock_t * l) noexcept, (l))
KNEAD_WATCH(pthread_spin_trylock, nullptr, (pthread_spinlock_t * l) noexcept, (l))
KNEAD_WATCH(pthread_cond_wait, "GLIBC_2.3.2", (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
KNEAD_WATCH(pthread_cond_timedwait, "GLIBC_2.3.2",
            (pthread_cond_t * c, pthread_mutex_t* m, const timespec* t), (c, m, t))
KNEAD_WATCH(sem_wait, nullptr, (sem_t * s), (s))
KNEAD_WATCH(sem_trywait, nullptr, (sem_t * s) noexcept, (s))
KNEAD_WATCH(sem_timedwait, nullptr, (sem_t * s, const timespec* t), (s, t))

#endif
