// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/status_words.h"

#include <algorithm>

namespace knead::tools {
namespace {

template <std::size_t N>
void add_words(std::string& text, std::uint32_t bits, const std::array<const char*, N>& names) {
    for (std::size_t bit = 0; bit < N; ++bit)
        if ((bits >> bit & 1U) != 0) {
            if (!text.empty()) text += ", ";
            text += names[bit];
        }
}

}  // namespace

std::string status_words(std::uint32_t haptic_status, std::uint32_t step_status) {
    std::string text;
    add_words(text, haptic_status, kHapticStatusNames);
    add_words(text, step_status, kStepStatusNames);
    std::replace(text.begin(), text.end(), '_', ' ');
    return text.empty() ? "ok" : text;
}

}  // namespace knead::tools
