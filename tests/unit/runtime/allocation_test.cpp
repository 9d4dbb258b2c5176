// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "unit/runtime/press.h"

namespace {
std::atomic<long> allocations{0};  // NOLINT: counts every allocation of this program
}

// The program's own operator new, counted. The aligned forms matter for Eigen and are counted too.
void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
    return operator new(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto align = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
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

TEST(Step, never_allocates) {
    for (const auto& [shape, contact] : {std::pair{ToolShape::plate, ToolContact::frictionless},
                                         std::pair{ToolShape::plate, ToolContact::coulomb},
                                         std::pair{ToolShape::sphere, ToolContact::sticking},
                                         std::pair{ToolShape::capsule, ToolContact::coulomb}}) {
        for (const double stiffness : {0.0, 800.0}) {
            const Asset asset = cube_asset(4, shape, contact);
            SimulationConfig config;
            config.coupling_stiffness_n_per_m = stiffness;
            Stepper stepper(asset, config);
            const long before = allocations;
            std::uint32_t most_touched = 0;
            for (int i = 0; i < 200; ++i) {
                const double z = 0.002 - 0.02 * std::sin(0.03 * i);
                most_touched = std::max(most_touched,
                                        stepper.step(moved(asset, {0.0002 * i, 0, z}), 1e-3).touched_nodes);
            }
            (void)stepper.step(moved(asset, {std::nan(""), 0, 0}), 1e-3);
            (void)stepper.step(moved(asset, {1e306, 0, 0}), 1e-3);
            stepper.reset();
            EXPECT_EQ(allocations - before, 0);
            EXPECT_GT(most_touched, 0u);
        }
    }
}

}  // namespace
}  // namespace knead::test
