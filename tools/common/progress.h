// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace knead::tools {

/// A progress bar on standard error, drawn only when that is a terminal; elsewhere every call does nothing.
class Progress {
  public:
    explicit Progress(bool wanted);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Shows `done` of `total` and what is under way.
    void show(std::size_t done, std::size_t total, std::string_view what);
    /// Takes the bar away, so that a line of text can be printed.
    void clear();

  private:
    bool on_terminal_;
    bool shown_ = false;
};

}  // namespace knead::tools
