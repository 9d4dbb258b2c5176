// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>

namespace knead::tools {
namespace {

constexpr std::size_t kUsualColumns = 80;
constexpr const char* kHideCursor = "\033[?25l";
constexpr const char* kShowCursor = "\033[?25h";
constexpr const char* kEraseToEnd = "\033[J";

}  // namespace

bool Screen::on_terminal() {
    const char* const type = std::getenv("TERM");
    return isatty(STDOUT_FILENO) == 1 && !(type != nullptr && std::string(type) == "dumb");
}

Screen::~Screen() {
    if (drawn_columns_ > 0) std::cout << kShowCursor << std::flush;
}

std::size_t Screen::columns() const {
    winsize size{};
    const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : kUsualColumns;
}

void Screen::draw(const std::vector<std::string>& lines) {
    const std::size_t columns_now = columns();
    if (columns_now < drawn_columns_) drawn_ = 0;  // lines were folded: nobody knows where the block began
    drawn_columns_ = columns_now;
    std::string text = drawn_ == 0 ? std::string(kHideCursor) : "\033[" + std::to_string(drawn_) + "A\r";
    text += kEraseToEnd;
    for (const std::string& line : lines)
        text += line + "\n";
    std::cout << text << std::flush;
    drawn_ = lines.size();
}

}  // namespace knead::tools
