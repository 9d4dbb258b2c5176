// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace knead {

/// Counts the elements that break a rule and keeps the first few ids for the message.
class Offenders {
  public:
    void add(std::size_t id) {
        if (count_ < ids_.size()) ids_[count_] = id;
        ++count_;
    }
    [[nodiscard]] bool any() const noexcept { return count_ > 0; }

    /// "3 of 1185 values are not positive (elements 17, 204, 993)"
    [[nodiscard]] std::string text(std::size_t total, const std::string& what,
                                   const std::string& id_name) const {
        std::string text =
            std::to_string(count_) + " of " + std::to_string(total) + " " + what + " (" + id_name;
        for (std::size_t i = 0; i < ids_.size() && i < count_; ++i)
            text += (i == 0 ? " " : ", ") + std::to_string(ids_[i]);
        return text + (count_ > ids_.size() ? ", ...)" : ")");
    }

  private:
    std::size_t count_ = 0;
    std::array<std::size_t, 5> ids_{};
};

}  // namespace knead
