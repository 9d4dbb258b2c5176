// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/error.h"
#include "quality/mesh_quality.h"

namespace knead::tools {
namespace {

constexpr std::size_t kNamed = 5;

/// "3 of 12 tetrahedra are flat (17, 204, 993, numbered from 1)"
std::string count_and_numbers(const std::vector<std::size_t>& found, std::size_t total, const char* what,
                              const std::vector<std::int64_t>& numbers, const std::string& numbering) {
    std::string text = fmt::format("{} of {} {} (", found.size(), total, what);
    for (std::size_t i = 0; i < std::min(found.size(), kNamed); ++i)
        text += fmt::format("{}{}", i == 0 ? "" : ", ", numbers[found[i]]);
    return text + (found.size() > kNamed ? ", ..." : "") + (numbering.empty() ? ")" : "; " + numbering + ")");
}

/// The positions of the tetrahedra for which `is_bad` holds.
template <class Predicate>
std::vector<std::size_t> select(std::size_t count, Predicate is_bad) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < count; ++i)
        if (is_bad(i)) found.push_back(i);
    return found;
}

class Repair {
  public:
    Repair(RawMesh raw, const RepairOptions& options) : raw_(std::move(raw)), options_(options) {
        result_.notes = std::move(raw_.notes);
    }

    RepairedMesh run() {
        tell_other_cells();
        require_indices();
        drop_unused_nodes();
        require_finite();
        join_or_refuse_coincident_nodes();
        require_distinct_corners();
        scale_nodes();
        require_volume();
        repair_orientation();
        require_different_tetrahedra();
        result_.mesh.regions = std::move(raw_.regions);
        result_.mesh.cell_arrays = std::move(raw_.cell_arrays);
        return std::move(result_);
    }

  private:
    void tell(const std::string& text) { result_.notes.push_back({false, text}); }
    void tell_other_cells();
    void require_indices();
    void drop_unused_nodes();
    void require_finite();
    void join_or_refuse_coincident_nodes();
    void require_distinct_corners();
    void scale_nodes();
    void require_volume();
    void repair_orientation();
    void require_different_tetrahedra();
    void keep_nodes(const std::vector<std::int64_t>& new_position);

    [[nodiscard]] std::string tetrahedra_that(const std::vector<std::size_t>& found, const char* what) const {
        return count_and_numbers(found, raw_.tetrahedra.size(), what, raw_.tetrahedron_numbers,
                                 raw_.numbering);
    }
    [[nodiscard]] std::string nodes_that(const std::vector<std::size_t>& found, const char* what) const {
        return count_and_numbers(found, raw_.nodes.size(), what, raw_.node_numbers, raw_.numbering);
    }

    RawMesh raw_;
    RepairOptions options_;
    RepairedMesh result_;
    std::vector<double> volumes_m3_;
};

void Repair::tell_other_cells() {
    std::string types;
    for (const auto& [type, count] : raw_.other_cells)
        types += fmt::format("{}{} {}", types.empty() ? "" : ", ", count, type);
    if (raw_.tetrahedra.empty())
        fail_input(types.empty() ? "the file has no tetrahedra"
                                 : "the file has no linear tetrahedra, only " + types);
    if (!types.empty()) tell("cells that are not linear tetrahedra left out: " + types);
    constexpr std::size_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();
    if (raw_.nodes.size() > kMaxIndex || raw_.tetrahedra.size() > kMaxIndex)
        fail_input("the mesh has more nodes or tetrahedra than a 32-bit index can name");
}

void Repair::require_indices() {
    const auto count = static_cast<std::int64_t>(raw_.nodes.size());
    const auto bad = select(raw_.tetrahedra.size(), [&](std::size_t t) {
        const auto& nodes = raw_.tetrahedra[t];
        return std::any_of(nodes.begin(), nodes.end(), [&](std::int64_t n) { return n < 0 || n >= count; });
    });
    if (!bad.empty()) fail_input(tetrahedra_that(bad, "tetrahedra name a node that does not exist"));
}

/// Moves node i to new_position[i] (drops it where that is -1), in order.
void Repair::keep_nodes(const std::vector<std::int64_t>& new_position) {
    for (auto& nodes : raw_.tetrahedra)
        for (std::int64_t& node : nodes)
            node = new_position[static_cast<std::size_t>(node)];
    std::size_t kept = 0;
    for (std::size_t i = 0; i < raw_.nodes.size(); ++i) {
        if (new_position[i] != static_cast<std::int64_t>(kept)) continue;
        raw_.nodes[kept] = raw_.nodes[i];
        raw_.node_numbers[kept] = raw_.node_numbers[i];
        ++kept;
    }
    raw_.nodes.resize(kept);
    raw_.node_numbers.resize(kept);
}

void Repair::drop_unused_nodes() {
    std::vector<char> used(raw_.nodes.size(), 0);
    for (const auto& nodes : raw_.tetrahedra)
        for (const std::int64_t node : nodes)
            used[static_cast<std::size_t>(node)] = 1;
    const auto unused = select(used.size(), [&](std::size_t i) { return used[i] == 0; });
    if (unused.empty()) return;
    tell(nodes_that(unused, "nodes dropped: no tetrahedron uses them"));
    std::vector<std::int64_t> new_position(used.size(), -1);
    std::int64_t kept = 0;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i] != 0) new_position[i] = kept++;
    keep_nodes(new_position);
}

void Repair::require_finite() {
    const auto bad = select(raw_.nodes.size(), [&](std::size_t i) {
        const Point& node = raw_.nodes[i];
        return !std::isfinite(node[0] * options_.metres_per_unit) ||
               !std::isfinite(node[1] * options_.metres_per_unit) ||
               !std::isfinite(node[2] * options_.metres_per_unit);
    });
    if (!bad.empty()) fail_input(nodes_that(bad, "nodes have a coordinate that is not finite"));
}

void Repair::join_or_refuse_coincident_nodes() {
    std::vector<std::size_t> order(raw_.nodes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (raw_.nodes[a] != raw_.nodes[b]) return raw_.nodes[a] < raw_.nodes[b];
        return a < b;
    });
    std::vector<std::int64_t> first_there(raw_.nodes.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        first_there[order[i]] = i > 0 && raw_.nodes[order[i]] == raw_.nodes[order[i - 1]]
                                    ? first_there[order[i - 1]]
                                    : static_cast<std::int64_t>(order[i]);
    const auto doubled =
        select(order.size(), [&](std::size_t i) { return first_there[i] != static_cast<std::int64_t>(i); });
    if (doubled.empty()) return;
    if (!options_.merge_duplicate_nodes)
        fail_input(nodes_that(doubled, "nodes lie exactly where an earlier node lies") +
                   "; --merge-duplicate-nodes joins them");
    tell(nodes_that(doubled, "nodes joined with an earlier node at the same place"));
    std::vector<std::int64_t> new_position(order.size());
    std::int64_t kept = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto first = static_cast<std::size_t>(first_there[i]);
        new_position[i] = first == i ? kept++ : new_position[first];
    }
    keep_nodes(new_position);
}

void Repair::require_distinct_corners() {
    const auto bad = select(raw_.tetrahedra.size(), [&](std::size_t t) {
        auto nodes = raw_.tetrahedra[t];
        std::sort(nodes.begin(), nodes.end());
        return std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end();
    });
    if (!bad.empty()) fail_input(tetrahedra_that(bad, "tetrahedra have the same node twice"));
}

void Repair::scale_nodes() {
    for (const Point& node : raw_.nodes) {
        const double scale = options_.metres_per_unit;
        result_.mesh.nodes_m.push_back({node[0] * scale, node[1] * scale, node[2] * scale});
    }
    for (const auto& nodes : raw_.tetrahedra)
        result_.mesh.tetrahedra.push_back(
            {static_cast<std::uint32_t>(nodes[0]), static_cast<std::uint32_t>(nodes[1]),
             static_cast<std::uint32_t>(nodes[2]), static_cast<std::uint32_t>(nodes[3])});
    for (std::size_t t = 0; t < raw_.tetrahedra.size(); ++t)
        volumes_m3_.push_back(signed_volume_m3(result_.mesh, t));
}

double longest_edge(const TetMesh& mesh, std::size_t t) {
    double squared = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
            double sum = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double side =
                    mesh.nodes_m[mesh.tetrahedra[t][i]][axis] - mesh.nodes_m[mesh.tetrahedra[t][j]][axis];
                sum += side * side;
            }
            squared = std::max(squared, sum);
        }
    return std::sqrt(squared);
}

void Repair::require_volume() {
    const auto flat = select(volumes_m3_.size(), [&](std::size_t t) {
        const double edge = longest_edge(result_.mesh, t);
        return !(std::abs(volumes_m3_[t]) > kFlatVolumeRatio * edge * edge * edge);
    });
    if (!flat.empty())
        fail_input(tetrahedra_that(flat, "tetrahedra have no volume") +
                   fmt::format(": at most {:g} of the cube of their longest edge", kFlatVolumeRatio));
}

void Repair::repair_orientation() {
    const auto inverted = select(volumes_m3_.size(), [&](std::size_t t) { return volumes_m3_[t] < 0; });
    if (inverted.empty()) return;
    if (inverted.size() == volumes_m3_.size())
        tell(fmt::format("orientation repaired: all {} tetrahedra were inverted, the file's convention",
                         inverted.size()));
    else if (options_.repair_orientation)
        tell("orientation repaired: " + tetrahedra_that(inverted, "tetrahedra were inverted"));
    else
        fail_input(tetrahedra_that(inverted, "tetrahedra are inverted") +
                   "; --repair-orientation turns them round");
    for (const std::size_t t : inverted)
        std::swap(result_.mesh.tetrahedra[t][2], result_.mesh.tetrahedra[t][3]);
}

void Repair::require_different_tetrahedra() {
    struct Key {
        Tetrahedron nodes;
        std::size_t position;
    };
    std::vector<Key> keys;
    for (std::size_t t = 0; t < result_.mesh.tetrahedra.size(); ++t) {
        keys.push_back({result_.mesh.tetrahedra[t], t});
        std::sort(keys.back().nodes.begin(), keys.back().nodes.end());
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.nodes != b.nodes ? a.nodes < b.nodes : a.position < b.position;
    });
    std::vector<std::size_t> repeated;
    for (std::size_t i = 1; i < keys.size(); ++i)
        if (keys[i].nodes == keys[i - 1].nodes) repeated.push_back(keys[i].position);
    std::sort(repeated.begin(), repeated.end());
    if (!repeated.empty()) fail_input(tetrahedra_that(repeated, "tetrahedra repeat an earlier one"));
}

}  // namespace

RepairedMesh to_tet_mesh(RawMesh raw, const RepairOptions& options) {
    return Repair(std::move(raw), options).run();
}

Notes remarks(const TetMesh& mesh, const MeshQuality& quality) {
    Notes notes;
    const double extent = quality.extent_m();
    if (extent > kLargestLikelyExtent_m)
        notes.push_back({true, fmt::format("the mesh is {:.3g} m across: this looks like millimetres called "
                                           "metres; check the length unit",
                                           extent)});
    if (extent < kSmallestLikelyExtent_m)
        notes.push_back(
            {true,
             fmt::format(
                 "the mesh is {:.3g} m across: this looks like a unit converted twice; check the length unit",
                 extent)});
    if (quality.bodies > 1)
        notes.push_back({false, fmt::format("the mesh has {} bodies that share no node", quality.bodies)});
    if (!quality.slivers.empty()) {
        std::vector<std::int64_t> numbers(mesh.tetrahedra.size());
        std::iota(numbers.begin(), numbers.end(), 0);
        const std::vector<std::size_t> slivers(quality.slivers.begin(), quality.slivers.end());
        notes.push_back({true, count_and_numbers(slivers, numbers.size(), "tetrahedra are slivers", numbers,
                                                 "positions in the output, from 0") +
                                   fmt::format(": radius ratio below {:g}", kSliverRadiusRatio)});
    }
    return notes;
}

}  // namespace knead::tools
