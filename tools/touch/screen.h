// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace knead::tools {

/// Standard output as a screen: a block of lines drawn over itself.
class Screen {
  public:
    [[nodiscard]] static bool on_terminal();
    Screen() = default;
    ~Screen();  ///< leaves the last block where it stands, and a visible cursor
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Asked anew each time: a window may change.
    [[nodiscard]] std::size_t columns() const;
    void draw(const std::vector<std::string>& lines);

  private:
    std::size_t drawn_ = 0;          ///< lines of the block that stands above the cursor
    std::size_t drawn_columns_ = 0;  ///< of the window then; 0: nothing was drawn
};

}  // namespace knead::tools
