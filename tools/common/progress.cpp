// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace knead::tools {

Progress::Progress(bool wanted) : on_terminal_(wanted && isatty(STDERR_FILENO) == 1) {}

void Progress::show(std::size_t done, std::size_t total, std::string_view what) {
    if (!on_terminal_) return;
    constexpr std::size_t kWidth = 24;
    const std::size_t filled = total == 0 ? 0 : std::min(kWidth, kWidth * done / total);
    std::cerr << "\r\033[K[" << std::string(filled, '#') << std::string(kWidth - filled, '.') << "] " << done
              << '/' << total << ' ' << what << std::flush;
    shown_ = true;
}

void Progress::clear() {
    if (!shown_) return;
    std::cerr << "\r\033[K" << std::flush;
    shown_ = false;
}

}  // namespace knead::tools
