// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "layers/source_tree.h"

namespace knead::test {

/// Checks the sources against the arrows of the architecture: tools -> formats_write -> formats <- runtime <-
/// examples, and no others (the rules themselves stand in rules.cpp, one function each).
/// @return one line per offence, "path:line: include: rule"; empty if all is well
[[nodiscard]] std::vector<std::string> layer_violations(const std::vector<SourceFile>& sources);

}  // namespace knead::test
