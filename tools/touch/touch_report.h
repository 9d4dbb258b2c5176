// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "touch/touch_run.h"

namespace knead::tools {

/// The summary of a run for a person: a few lines.
[[nodiscard]] std::string touch_summary_text(const TouchSetup& setup, const TouchOutcome& outcome);

/// The summary for programs, schema "knead-touch/1" (docs/touch.md). Of a run in virtual time: the same bytes
/// each time, for nothing that a clock says is in it.
[[nodiscard]] std::string touch_summary_json(const Asset& asset, const std::string& asset_content_hash,
                                             const TouchSetup& setup, const TouchOutcome& outcome);

}  // namespace knead::tools
