// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pinned_thread.h"

#include <sched.h>

#include <cstring>

namespace knead::tools {

PinnedThread::PinnedThread() {
    cpu_set_t before;
    if (sched_getaffinity(0, sizeof before, &before) != 0) return;
    const int here = sched_getcpu();
    if (here < 0) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(here), &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0) return;
    core_ = here;
    before_.assign(reinterpret_cast<const char*>(&before), sizeof before);
}

PinnedThread::~PinnedThread() {
    if (core_ < 0) return;
    cpu_set_t before;
    std::memcpy(&before, before_.data(), sizeof before);
    (void)sched_setaffinity(0, sizeof before, &before);
}

}  // namespace knead::tools
