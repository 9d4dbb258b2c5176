// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace knead::tools {

// A report of headings, sentences and tables that can be shown on a terminal and in Markdown.

enum class Verdict { none, within, outside };

struct DocumentCell {
    std::string text;
    Verdict verdict = Verdict::none;
};

/// Every row as long as `columns`; the first column is flush left, the others right.
struct DocumentTable {
    std::vector<std::string> columns;
    std::vector<std::vector<DocumentCell>> rows;
};

struct DocumentPart {
    std::string heading;
    std::vector<std::string> before;  ///< sentences above the table
    DocumentTable table;              ///< may be empty
    std::vector<std::string> after;
};

/// Lines for a terminal. A verdict is a mark (" x" for outside) and, with `colour`, green or red.
[[nodiscard]] std::string as_text(const std::vector<DocumentPart>& parts, bool colour);

/// The same as Markdown, without colour.
[[nodiscard]] std::string as_markdown(const std::vector<DocumentPart>& parts);

}  // namespace knead::tools
