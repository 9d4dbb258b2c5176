// SPDX-License-Identifier: Apache-2.0
#include "mesh_checks.h"

#include <cmath>
#include <limits>
#include <unordered_set>

#include "failure.h"
#include "offenders.h"

namespace knead {
namespace {

/// One string has to fit in an attribute of an HDF5 object header (64 kB).
constexpr std::size_t kMaxTextBytes = 32768;
/// Node indices and 4 * tetrahedra are int32 on disk, as VTK wants them.
constexpr std::size_t kMaxIndex = std::numeric_limits<std::int32_t>::max();

void check_coordinates(const std::vector<Point>& nodes_m, const std::string& where) {
    Offenders bad;
    for (std::size_t i = 0; i < nodes_m.size(); ++i)
        if (!std::isfinite(nodes_m[i][0]) || !std::isfinite(nodes_m[i][1]) || !std::isfinite(nodes_m[i][2]))
            bad.add(i);
    if (bad.any())
        fail(ErrorCode::invalid_data, bad.text(nodes_m.size(), "nodes are not finite", "nodes"), where);
}

void check_indices(std::size_t node_count, const std::vector<Tetrahedron>& tetrahedra,
                   const std::string& where) {
    Offenders outside, repeated;
    for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
        const auto& [a, b, c, d] = tetrahedra[i];
        if (a >= node_count || b >= node_count || c >= node_count || d >= node_count) outside.add(i);
        if (a == b || a == c || a == d || b == c || b == d || c == d) repeated.add(i);
    }
    const std::string nodes = std::to_string(node_count) + " nodes";
    if (outside.any())
        fail(ErrorCode::invalid_data,
             outside.text(tetrahedra.size(), "tetrahedra name a node beyond the " + nodes, "elements"),
             where);
    if (repeated.any())
        fail(ErrorCode::invalid_data,
             repeated.text(tetrahedra.size(), "tetrahedra name a node twice", "elements"), where);
}

void check_every_node_used(std::size_t node_count, const std::vector<Tetrahedron>& tetrahedra,
                           const std::string& where) {
    std::vector<bool> used(node_count, false);
    for (const Tetrahedron& tetrahedron : tetrahedra)
        for (const std::uint32_t node : tetrahedron)
            used[node] = true;
    Offenders unused;
    for (std::size_t i = 0; i < node_count; ++i)
        if (!used[i]) unused.add(i);
    if (unused.any())
        fail(ErrorCode::invalid_data, unused.text(node_count, "nodes belong to no tetrahedron", "nodes"),
             where);
}

void check_volumes(const std::vector<Point>& nodes_m, const std::vector<Tetrahedron>& tetrahedra,
                   const std::string& where) {
    Offenders bad;
    for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
        const auto& [a, b, c, d] = tetrahedra[i];
        const double volume_m3 = signed_volume_m3(nodes_m[a], nodes_m[b], nodes_m[c], nodes_m[d]);
        if (!is_positive(volume_m3)) bad.add(i);
    }
    if (bad.any())
        fail(ErrorCode::invalid_data,
             bad.text(tetrahedra.size(), "tetrahedra have no positive volume (flat or inverted)", "elements"),
             where);
}

}  // namespace

bool is_positive(double value) {
    return std::isfinite(value) && value > 0;
}

bool is_poissons_ratio(double value) {
    return value > -1.0 && value < 0.5;
}

void check_mesh(const std::vector<Point>& nodes_m, const std::vector<Tetrahedron>& tetrahedra,
                const std::string& group) {
    const std::string at_nodes = group + "/nodes_m", at_tetrahedra = group + "/tetrahedra";
    if (tetrahedra.empty()) fail(ErrorCode::invalid_data, "there is no tetrahedron", at_tetrahedra);
    if (nodes_m.size() > kMaxIndex || tetrahedra.size() > kMaxIndex / 4)
        fail(ErrorCode::invalid_data, "too many nodes or tetrahedra for 32-bit indices", group);
    check_coordinates(nodes_m, at_nodes);
    check_indices(nodes_m.size(), tetrahedra, at_tetrahedra);
    check_every_node_used(nodes_m.size(), tetrahedra, at_nodes);
    check_volumes(nodes_m, tetrahedra, at_tetrahedra);
}

void check_text(const std::string& text, const char* what, const std::string& where) {
    if (text.size() > kMaxTextBytes)
        fail(ErrorCode::invalid_data,
             std::string(what) + " is longer than " + std::to_string(kMaxTextBytes) + " bytes", where);
    if (text.find('\0') != std::string::npos)
        fail(ErrorCode::invalid_data, std::string(what) + " holds a zero byte", where);
}

void check_names(const std::vector<std::string>& names, const char* what, const std::string& where) {
    std::unordered_set<std::string> seen;
    for (const std::string& name : names) {
        check_text(name, what, where);
        if (name.empty()) fail(ErrorCode::invalid_data, std::string(what) + " is empty", where);
        if (!seen.insert(name).second)
            fail(ErrorCode::invalid_data, std::string(what) + " \"" + name + "\" appears twice", where);
    }
}

}  // namespace knead
