// SPDX-License-Identifier: Apache-2.0
#include "core/factor/symbolic_factor.h"

#include <algorithm>
#include <numeric>

namespace knead::core {
namespace {

constexpr std::uint32_t kNone = SymbolicFactor::kNoParent;

// What a supernode costs in a solve beyond its stored numbers, in numbers read; measured.
constexpr double kSupernodeCost = 500;
constexpr double kRowCost = 8;

/// Nodes by place, and the elimination tree between places; parents come after children.
struct Tree {
    std::vector<std::uint32_t> node_at;
    std::vector<std::uint32_t> parent;
};

std::vector<std::uint32_t> elimination_tree(const MatrixPattern& pattern,
                                            const std::vector<std::uint32_t>& upper_begin,
                                            const std::vector<std::uint32_t>& upper) {
    const std::uint32_t n = pattern.node_count;
    std::vector<std::uint32_t> parent(n, kNone), ancestor(n, kNone);
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t k = upper_begin[i]; k < upper_begin[i + 1]; ++k) {
            std::uint32_t j = upper[k];
            while (j != kNone && j != i) {
                const std::uint32_t next = ancestor[j];
                ancestor[j] = i;
                if (next == kNone) parent[j] = i;
                j = next;
            }
        }
    return parent;
}

/// Children before parents, subtrees together, siblings as they were. @return node at each place
std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent) {
    const auto n = static_cast<std::uint32_t>(parent.size());
    std::vector<std::uint32_t> first_child(n, kNone), sibling(n, kNone), order, stack;
    std::uint32_t roots = kNone;
    for (std::uint32_t i = n; i-- > 0;) {
        std::uint32_t& head = parent[i] == kNone ? roots : first_child[parent[i]];
        sibling[i] = head;
        head = i;
    }
    order.reserve(n);
    for (std::uint32_t root = roots; root != kNone; root = sibling[root]) {
        stack.push_back(root);
        while (!stack.empty()) {
            const std::uint32_t i = stack.back();
            if (first_child[i] != kNone) {
                stack.push_back(first_child[i]);
                first_child[i] = kNone;
                continue;
            }
            stack.pop_back();
            order.push_back(i);
            if (!stack.empty() && sibling[i] != kNone) stack.push_back(sibling[i]);
        }
    }
    return order;
}

/// Neighbours with a lower number, in compressed rows.
void upper_rows(const MatrixPattern& pattern, std::vector<std::uint32_t>& begin,
                std::vector<std::uint32_t>& columns) {
    const std::uint32_t n = pattern.node_count;
    begin.assign(n + 1, 0);
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t k = pattern.column_begin[j] + 1; k < pattern.column_begin[j + 1]; ++k)
            ++begin[pattern.row_nodes[k] + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    columns.resize(begin[n]);
    std::vector<std::uint32_t> next(begin.begin(), begin.end());
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t k = pattern.column_begin[j] + 1; k < pattern.column_begin[j + 1]; ++k)
            columns[next[pattern.row_nodes[k]]++] = j;
}

/// Supernodes while they are being merged. Columns are a linked list of nodes in the order of elimination.
struct Group {
    std::uint32_t head = kNone, tail = kNone;
    std::uint32_t columns = 0;
    std::uint32_t parent = kNone;
    bool merged = false;
    std::vector<std::uint32_t> rows;  ///< nodes below, unsorted
    std::vector<std::uint32_t> children;
};

class Analysis {
  public:
    Analysis(const MatrixPattern& pattern, const FactorLayout& layout) : pattern_(pattern), layout_(layout) {
        upper_rows(pattern, upper_begin_, upper_);
    }

    SymbolicFactor run() {
        parent_ = elimination_tree(pattern_, upper_begin_, upper_);
        order_ = postorder(parent_);
        place_.resize(order_.size());
        for (std::uint32_t p = 0; p < order_.size(); ++p)
            place_[order_[p]] = p;
        find_supernodes(column_counts());
        find_rows();
        for (std::uint32_t g = 0; g < groups_.size(); ++g)
            merge_children(g);
        return number();
    }

  private:
    /// Nodes of each column of the factor, the diagonal included; by walking each row's subtree.
    std::vector<std::uint32_t> column_counts() {
        const std::uint32_t n = pattern_.node_count;
        std::vector<std::uint32_t> counts(n, 1), mark(n, kNone);
        for (std::uint32_t i = 0; i < n; ++i) {
            mark[i] = i;
            for (std::uint32_t k = upper_begin_[i]; k < upper_begin_[i + 1]; ++k)
                for (std::uint32_t j = upper_[k]; mark[j] != i; j = parent_[j]) {
                    mark[j] = i;
                    ++counts[j];
                }
        }
        return counts;
    }

    void find_supernodes(const std::vector<std::uint32_t>& counts) {
        next_.assign(order_.size(), kNone);
        group_of_.resize(order_.size());
        for (std::uint32_t p = 0; p < order_.size(); ++p) {
            const std::uint32_t node = order_[p];
            const std::uint32_t before = p > 0 ? order_[p - 1] : kNone;
            if (before != kNone && parent_[before] == node && counts[node] + 1 == counts[before]) {
                next_[before] = node;
            } else {
                groups_.emplace_back();
                groups_.back().head = node;
            }
            groups_.back().tail = node;
            ++groups_.back().columns;
            group_of_[node] = static_cast<std::uint32_t>(groups_.size()) - 1;
        }
    }

    void find_rows() {
        std::vector<std::uint32_t> mark(order_.size(), kNone);
        for (std::uint32_t g = 0; g < groups_.size(); ++g) {
            Group& group = groups_[g];
            const auto add = [&](std::uint32_t node) {
                if (group_of_[node] == g || place_[node] < place_[group.head] || mark[node] == g) return;
                mark[node] = g;
                group.rows.push_back(node);
            };
            for (std::uint32_t node = group.head; node != kNone; node = next_[node]) {
                for (std::uint32_t k = pattern_.column_begin[node]; k < pattern_.column_begin[node + 1]; ++k)
                    add(pattern_.row_nodes[k]);
                for (std::uint32_t k = upper_begin_[node]; k < upper_begin_[node + 1]; ++k)
                    add(upper_[k]);
            }
            for (const std::uint32_t child : group.children)
                for (const std::uint32_t node : groups_[child].rows)
                    add(node);
            if (parent_[group.tail] == kNone) continue;
            group.parent = group_of_[parent_[group.tail]];
            groups_[group.parent].children.push_back(g);
        }
    }

    [[nodiscard]] double cost(std::size_t columns, std::size_t rows) const {
        return kSupernodeCost + kRowCost * static_cast<double>(rows) +
               static_cast<double>(layout_.value_count(columns, rows));
    }

    void merge_children(std::uint32_t g) {
        for (;;) {
            Group& group = groups_[g];
            double best_gain = 0;
            std::size_t best = group.children.size();
            for (std::size_t k = 0; k < group.children.size(); ++k) {
                const Group& child = groups_[group.children[k]];
                const double gain = cost(child.columns, child.rows.size()) +
                                    cost(group.columns, group.rows.size()) -
                                    cost(std::size_t{child.columns} + group.columns, group.rows.size());
                if (gain > best_gain) {
                    best_gain = gain;
                    best = k;
                }
            }
            if (best == group.children.size()) return;
            take(group, groups_[group.children[best]], best);
        }
    }

    void take(Group& group, Group& child, std::size_t place) {
        next_[child.tail] = group.head;
        group.head = child.head;
        group.columns += child.columns;
        child.merged = true;
        group.children.erase(group.children.begin() + static_cast<std::ptrdiff_t>(place));
        const auto self = static_cast<std::uint32_t>(&group - groups_.data());
        for (const std::uint32_t grandchild : child.children) {
            groups_[grandchild].parent = self;
            group.children.push_back(grandchild);
        }
    }

    SymbolicFactor number() {
        std::vector<std::uint32_t> kept, kept_index(groups_.size(), kNone);
        for (std::uint32_t g = 0; g < groups_.size(); ++g) {
            if (groups_[g].merged) continue;
            kept_index[g] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(g);
        }
        std::vector<std::uint32_t> kept_parent;
        for (const std::uint32_t g : kept)
            kept_parent.push_back(groups_[g].parent == kNone ? kNone : kept_index[groups_[g].parent]);
        const std::vector<std::uint32_t> sequence = postorder(kept_parent);
        std::vector<std::uint32_t> final_index(kept.size());
        for (std::uint32_t s = 0; s < sequence.size(); ++s)
            final_index[sequence[s]] = s;

        SymbolicFactor result;
        result.place_of.resize(order_.size());
        std::uint32_t place = 0;
        for (const std::uint32_t k : sequence)
            for (std::uint32_t node = groups_[kept[k]].head; node != kNone; node = next_[node])
                result.place_of[node] = place++;
        std::uint32_t first = 0;
        for (const std::uint32_t k : sequence) {
            const Group& group = groups_[kept[k]];
            const auto begin = static_cast<std::uint32_t>(result.rows.size());
            for (const std::uint32_t node : group.rows)
                result.rows.push_back(result.place_of[node]);
            std::sort(result.rows.begin() + begin, result.rows.end());
            const auto row_count = static_cast<std::uint32_t>(group.rows.size());
            result.supernodes.push_back({first, group.columns, begin, row_count, result.value_count});
            result.parents.push_back(kept_parent[k] == kNone ? kNone : final_index[kept_parent[k]]);
            result.value_count += layout_.value_count(group.columns, row_count);
            first += group.columns;
        }
        return result;
    }

    const MatrixPattern& pattern_;
    const FactorLayout layout_;
    std::vector<std::uint32_t> upper_begin_, upper_;
    std::vector<std::uint32_t> parent_, order_, place_;
    std::vector<std::uint32_t> next_, group_of_;
    std::vector<Group> groups_;
};

}  // namespace

SymbolicFactor analyse(const MatrixPattern& pattern, const FactorLayout& layout) {
    return Analysis(pattern, layout).run();
}

}  // namespace knead::core
