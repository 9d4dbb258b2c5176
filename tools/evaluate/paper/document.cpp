// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/paper/document.h"

#include <algorithm>

namespace knead::tools {
namespace {

constexpr const char* kGreen = "\x1b[32m";
constexpr const char* kRed = "\x1b[31m";
constexpr const char* kPlain = "\x1b[0m";
constexpr std::size_t kLineWidth = 118;

/// One place wide whatever the verdict, so that numbers stand under each other.
std::string marked(const DocumentCell& cell, bool has_verdicts) {
    if (!has_verdicts) return cell.text;
    return cell.text + (cell.verdict == Verdict::outside ? " x" : "  ");
}

bool has_verdicts(const DocumentTable& table, std::size_t column) {
    return std::any_of(table.rows.begin(), table.rows.end(),
                       [column](const auto& row) { return row[column].verdict != Verdict::none; });
}

std::string coloured(const std::string& text, Verdict verdict, bool colour) {
    if (!colour || verdict == Verdict::none) return text;
    return (verdict == Verdict::within ? kGreen : kRed) + text + kPlain;
}

/// Characters of a UTF-8 text: all bytes but those that continue one.
std::size_t length_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool is_left) {
    const std::string space(width - std::min(width, length_of(text)), ' ');
    return is_left ? text + space : space + text;
}

std::string without_trailing_spaces(std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

std::string text_table(const DocumentTable& table, bool colour) {
    std::vector<std::size_t> widths;
    std::vector<bool> with_mark;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        with_mark.push_back(has_verdicts(table, c));
        std::size_t width = length_of(table.columns[c]);
        for (const auto& row : table.rows)
            width = std::max(width, length_of(marked(row[c], with_mark[c])));
        widths.push_back(width);
    }
    std::string line;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        line += "  " + padded(table.columns[c], widths[c], c == 0);
    std::string text = without_trailing_spaces(line);
    for (const auto& row : table.rows) {
        line.clear();
        for (std::size_t c = 0; c < row.size(); ++c)
            line += "  " +
                    coloured(padded(marked(row[c], with_mark[c]), widths[c], c == 0), row[c].verdict, colour);
        text += without_trailing_spaces(line);
    }
    return text;
}

/// Broken between words.
std::string paragraph(const std::string& words) {
    std::string text;
    std::size_t length = 0;
    for (std::size_t from = 0; from < words.size();) {
        const std::size_t space = std::min(words.find(' ', from), words.size());
        const std::string word = words.substr(from, space - from);
        if (length > 0 && length + 1 + length_of(word) > kLineWidth) {
            text += '\n';
            length = 0;
        }
        text += (length > 0 ? " " : "") + word;
        length += length_of(word) + (length > 0 ? 1 : 0);
        from = space + 1;
    }
    return text + '\n';
}

std::string markdown_cell(const DocumentCell& cell) {
    if (cell.text.empty() || cell.verdict == Verdict::none) return cell.text;
    return cell.text + (cell.verdict == Verdict::outside ? " \u2717" : " \u2713");
}

std::string markdown_table(const DocumentTable& table) {
    std::string text = "|", line = "|";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        text += ' ' + table.columns[c] + " |";
        line += c == 0 ? "---|" : "---:|";
    }
    text += '\n' + line + '\n';
    for (const auto& row : table.rows) {
        text += '|';
        for (const DocumentCell& cell : row)
            text += ' ' + markdown_cell(cell) + " |";
        text += '\n';
    }
    return text;
}

}  // namespace

std::string as_text(const std::vector<DocumentPart>& parts, bool colour) {
    std::string text;
    for (const DocumentPart& part : parts) {
        text +=
            (text.empty() ? "" : "\n") + part.heading + '\n' + std::string(part.heading.size(), '-') + '\n';
        for (const std::string& sentence : part.before)
            text += paragraph(sentence);
        if (!part.table.columns.empty()) text += text_table(part.table, colour);
        for (const std::string& sentence : part.after)
            text += paragraph(sentence);
    }
    return text;
}

std::string as_markdown(const std::vector<DocumentPart>& parts) {
    std::string text;
    for (const DocumentPart& part : parts) {
        text += (text.empty() ? "### " : "\n### ") + part.heading + "\n\n";
        for (const std::string& sentence : part.before)
            text += paragraph(sentence) + '\n';
        if (!part.table.columns.empty()) text += markdown_table(part.table);
        for (const std::string& sentence : part.after)
            text += '\n' + paragraph(sentence);
    }
    return text;
}

}  // namespace knead::tools
