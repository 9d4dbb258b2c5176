// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/node_field.h"

namespace knead::core {

/// Where nodes are: all that contact sees of the state, whatever numbers it is kept in. A view; cheap to
/// copy.
class NodeReader {
  public:
    explicit NodeReader(const Field& rest_m) : rest_(&rest_m) {}

    /// At rest + displacement.
    template <class S>
    NodeReader(const Field& rest_m, const NodeField<S>& displacement_m) : rest_(&rest_m) {
        add(displacement_m);
    }
    /// At rest + displacement + more.
    template <class S, class V>
    NodeReader(const Field& rest_m, const NodeField<S>& displacement_m, const NodeField<V>& more_m)
        : rest_(&rest_m) {
        add(displacement_m);
        add(more_m);
    }

    Vec operator()(std::uint32_t node) const {
        Vec x = (*rest_)[node];
        for (const auto* field : floats_) {
            if (field != nullptr) x += field->get(node);
        }
        for (const auto* field : doubles_) {
            if (field != nullptr) x += field->get(node);
        }
        return x;
    }

  private:
    void add(const NodeField<float>& field) { (floats_[0] == nullptr ? floats_[0] : floats_[1]) = &field; }
    void add(const NodeField<double>& field) {
        (doubles_[0] == nullptr ? doubles_[0] : doubles_[1]) = &field;
    }

    const Field* rest_;
    const NodeField<float>* floats_[2] = {};
    const NodeField<double>* doubles_[2] = {};
};

}  // namespace knead::core
