// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "core/node_field.h"

namespace knead::core {

/// Fields of numbers From for those who compute with To: the same field, and no memory, if they are the same.
template <class To, class From>
class Converted {
  public:
    explicit Converted(std::size_t nodes) {
        if constexpr (!std::is_same_v<To, From>) copy_ = NodeField<To>(nodes);
    }

    /// @return valid until the next call
    [[nodiscard]] const NodeField<To>& of(const NodeField<From>& field) noexcept {
        if constexpr (std::is_same_v<To, From>) {
            return field;
        } else {
            copy_.copy(field);
            return copy_;
        }
    }

  private:
    NodeField<To> copy_;
};

}  // namespace knead::core
