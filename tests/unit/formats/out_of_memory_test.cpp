// SPDX-License-Identifier: Apache-2.0
// Memory that ends at any one allocation of C++: readers, writers and the runtime give out_of_memory, or do
// without; nothing is thrown at the caller, nothing crashes. A program of its own, because it replaces the
// global operator new.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <new>
#include <optional>

#include "knead/formats/inspect.h"
#include "knead/runtime/embedded_surface.h"
#include "knead/runtime/simulation.h"
#include "samples.h"
#include "session_sample.h"

namespace {

constexpr long kNever = -1;
thread_local long allocations_left = kNever;  ///< until one fails; that one only

void* allocate(std::size_t size, std::size_t alignment) noexcept {
    if (allocations_left == 0) {
        allocations_left = kNever;
        return nullptr;
    }
    if (allocations_left > 0) --allocations_left;
    const std::size_t rounded = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
    return std::aligned_alloc(alignment, rounded);
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
    void* memory = allocate(size, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate_or_throw(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace knead::test {
namespace {

/// What a call came to: nothing when it went well.
using Outcome = std::optional<Error>;

template <class T>
Outcome outcome_of(const Result<T>& result) {
    if (result.ok()) return std::nullopt;
    return result.error();
}

/// Lets allocation 0, 1, 2, ... of the call fail until none is left to fail. Every one of a few hundred; of
/// many, a sample.
void fail_each_allocation(const std::function<Outcome()>& call,
                          const std::function<void(const Outcome&)>& after_each = {}) {
    constexpr long kAll = 300;
    constexpr long kStep = 37;
    int refused = 0;
    for (long k = 0;; k += k < kAll ? 1 : kStep) {
        allocations_left = k;
        const Outcome outcome = call();
        const bool failed = allocations_left == kNever;
        allocations_left = kNever;
        if (after_each) after_each(outcome);
        if (!failed) {
            EXPECT_FALSE(outcome.has_value()) << outcome->text();
            break;
        }
        if (!outcome) continue;  // done without
        ++refused;
        ASSERT_EQ(outcome->code, ErrorCode::out_of_memory) << "allocation " << k << ": " << outcome->text();
        ASSERT_FALSE(outcome->message.empty());
    }
    EXPECT_GT(refused, 0);
}

class Out_of_memory : public testing::Test {
  protected:
    Folder folder_;
    std::filesystem::path file_ = folder_ / "file.hdf";
};

TEST_F(Out_of_memory, Is_told_by_the_readers_of_every_kind) {
    ASSERT_TRUE(write_tet_mesh(file_, sample_mesh(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(read_tet_mesh(file_)); });
    ASSERT_TRUE(write_material(file_, sample_material(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(read_material(file_)); });
    ASSERT_TRUE(write_clustering(file_, sample_clustering(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(read_clustering(file_)); });
    ASSERT_TRUE(write_overlap(file_, sample_overlap(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(read_overlap(file_)); });
    ASSERT_TRUE(write_asset(file_, sample_asset(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(read_asset(file_)); });
    ASSERT_TRUE(write_session_log(file_, sample_session(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(read_session_log(file_)); });
}

TEST_F(Out_of_memory, Is_told_by_the_inspection) {
    ASSERT_TRUE(write_asset(file_, sample_asset(), sample_provenance()).ok());
    fail_each_allocation([&] { return outcome_of(inspect_file(file_)); });
}

TEST_F(Out_of_memory, Is_told_by_a_writer_that_leaves_the_old_file_alone) {
    ASSERT_TRUE(write_asset(file_, sample_asset(2), sample_provenance()).ok());
    const std::vector<char> before = bytes_of(file_);
    const Asset asset = sample_asset();
    const Provenance made = sample_provenance();
    const auto after_each = [&](const Outcome& outcome) {
        EXPECT_EQ(folder_.entries(), 1U) << "something was left behind";
        EXPECT_TRUE(!outcome || bytes_of(file_) == before) << "the old file was touched";
        put_bytes(file_, before);
    };
    fail_each_allocation([&] { return outcome_of(write_asset(file_, asset, made)); }, after_each);
}

TEST_F(Out_of_memory, Is_told_by_the_runtime) {
    const Asset asset = sample_asset();
    const SimulationConfig config;  // here: a default argument is the caller's, and so is its memory
    fail_each_allocation([&] { return outcome_of(Simulation::create(asset, config)); });
    fail_each_allocation([&] { return outcome_of(EmbeddedSurface::create(asset)); });
}

}  // namespace
}  // namespace knead::test
