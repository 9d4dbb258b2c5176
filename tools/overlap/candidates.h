// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "overlap/prepared_tet.h"

namespace knead::tools {

/// Finds the tetrahedra whose bounding boxes meet a box. Built once, then read by any number of threads.
class BoxTree {
  public:
    explicit BoxTree(const std::vector<PreparedTet>& tets);
    ~BoxTree();
    BoxTree(const BoxTree&) = delete;
    BoxTree& operator=(const BoxTree&) = delete;

    /// Replaces `found` by the ids of the tetrahedra whose boxes share at least a point with [low, high],
    /// ascending.
    void find(const Point& low, const Point& high, std::vector<std::uint32_t>& found) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> tree_;
};

}  // namespace knead::tools
