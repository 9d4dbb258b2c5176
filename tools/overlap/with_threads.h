// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace knead::tools {

/// Runs a function whose parallel loops use exactly so many threads, also more than there are cores (TBB
/// alone would complain on stderr).
template <class Function>
void with_threads(unsigned threads, const Function& function) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena(static_cast<int>(threads)).execute(function);
}

}  // namespace knead::tools
