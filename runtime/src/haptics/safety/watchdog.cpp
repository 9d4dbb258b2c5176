// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/safety/watchdog.h"

namespace knead {

double Watchdog::share(double age_s) const noexcept {
    if (!(age_s >= 0)) return 0;
    if (age_s <= stale_after_s) return 1;
    if (age_s >= zero_after_s) return 0;
    return (zero_after_s - age_s) / (zero_after_s - stale_after_s);
}

}  // namespace knead
