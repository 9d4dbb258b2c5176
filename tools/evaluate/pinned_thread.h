// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace knead::tools {

/// Keeps the calling thread on one core for as long as it lives, if the system allows.
class PinnedThread {
  public:
    PinnedThread();
    ~PinnedThread();
    PinnedThread(const PinnedThread&) = delete;
    PinnedThread& operator=(const PinnedThread&) = delete;
    [[nodiscard]] int core() const { return core_; }  ///< -1: not pinned

  private:
    int core_ = -1;
    std::string before_;  // the affinity mask that was there
};

}  // namespace knead::tools
