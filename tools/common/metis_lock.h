// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mutex>

namespace knead::tools {

/// Held around every call that may end in METIS, CHOLMOD's analysis too: METIS draws from one random generator
/// of the process, so that two calls at a time would give orders that no run repeats.
[[nodiscard]] inline std::unique_lock<std::mutex> lock_metis() {
    static std::mutex mutex;
    return std::unique_lock(mutex);
}

}  // namespace knead::tools
