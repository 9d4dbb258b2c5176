// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlap/candidates.h"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <utility>

namespace knead::tools {
namespace {

namespace index = boost::geometry::index;
using BoxCorner = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<BoxCorner>;
using Entry = std::pair<Box, std::uint32_t>;
using Tree = index::rtree<Entry, index::linear<16>>;

Box box_of(const Point& low, const Point& high) {
    return {BoxCorner(low[0], low[1], low[2]), BoxCorner(high[0], high[1], high[2])};
}

std::vector<Entry> entries_of(const std::vector<PreparedTet>& tets) {
    std::vector<Entry> entries;
    entries.reserve(tets.size());
    for (std::size_t i = 0; i < tets.size(); ++i)
        entries.emplace_back(box_of(tets[i].low, tets[i].high), static_cast<std::uint32_t>(i));
    return entries;
}

}  // namespace

struct BoxTree::Implementation {
    Tree tree;  // bulk loaded: balanced, well packed
};

BoxTree::BoxTree(const std::vector<PreparedTet>& tets)
    : tree_(std::make_unique<Implementation>(Implementation{Tree(entries_of(tets))})) {}

BoxTree::~BoxTree() = default;

void BoxTree::find(const Point& low, const Point& high, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto keep = [&found](const Entry& entry) { found.push_back(entry.second); };
    tree_->tree.query(index::intersects(box_of(low, high)), boost::make_function_output_iterator(keep));
    std::sort(found.begin(), found.end());
}

}  // namespace knead::tools
