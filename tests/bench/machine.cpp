// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.h"

#include <sched.h>

#include <stdexcept>

#include "bench/core_speed.h"

namespace knead::bench {
namespace {

void pin(int core) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    if (core < 0 || core >= CPU_SETSIZE) throw std::runtime_error("no such core");
    CPU_SET(static_cast<unsigned>(core), &cores);
    if (sched_setaffinity(0, sizeof cores, &cores) != 0)
        throw std::runtime_error("cannot pin to core " + std::to_string(core));
}

}  // namespace

Machine describe_machine(std::optional<int> core) {
    if (core) pin(*core);
    return {baseline::describe_machine(), instruction_set(), KNEAD_BENCH_FLAGS, core.value_or(-1)};
}

}  // namespace knead::bench
