// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace knead::tools {

/// From now on the first SIGINT or SIGTERM is noted instead of ending the program; the second one ends it.
void catch_interrupts();
/// Whether one came.
[[nodiscard]] bool interrupted();

}  // namespace knead::tools
