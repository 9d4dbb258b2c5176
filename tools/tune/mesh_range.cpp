// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/mesh_range.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace knead::tools {
namespace {

constexpr std::uint32_t kFewestCubes = 3;  // along the longest side: with fewer, half of the nodes are held
constexpr std::uint32_t kMostSizes = 12;
constexpr double kShares[] = {0.15, 0.2, 0.27, 0.35, 0.45, 0.55, 0.68, 0.8};
constexpr double kFewestTetrahedra = 100;

MeshSource cubes_along(const MeshSource& fine, std::uint32_t longest, std::uint32_t wanted) {
    MeshSource source = fine;
    for (std::uint32_t& n : source.divisions)
        n = std::max(1U, static_cast<std::uint32_t>(std::lround(static_cast<double>(n) * wanted / longest)));
    return source;
}

}  // namespace

std::vector<MeshSource> coarser_meshes(const MeshSource& fine, std::size_t tetrahedra) {
    std::vector<MeshSource> sources;
    if (fine.kind == "cubes") {
        const std::uint32_t longest = *std::max_element(fine.divisions.begin(), fine.divisions.end());
        if (longest <= kFewestCubes) return sources;
        const std::uint32_t sizes = std::min(kMostSizes, longest - kFewestCubes);
        for (std::uint32_t k = 0; k < sizes; ++k)
            sources.push_back(
                cubes_along(fine, longest, kFewestCubes + k * (longest - kFewestCubes) / sizes));
        return sources;
    }
    for (const double share : kShares) {
        const double wanted = std::round(share * static_cast<double>(tetrahedra));
        if (wanted < kFewestTetrahedra) continue;
        MeshSource source = fine;
        source.edge_length_m = 0;
        source.target_tetrahedra = static_cast<std::uint32_t>(wanted);
        sources.push_back(source);
    }
    return sources;
}

std::string text_of(const MeshSource& source) {
    if (source.kind == "cubes") return fmt::format("of {} cubes", fmt::join(source.divisions, " x "));
    if (source.target_tetrahedra > 0) return fmt::format("of {} tetrahedra", source.target_tetrahedra);
    return source.kind;
}

std::string level_mesh_toml(const MeshSource& source, const MeshSource& fine) {
    MeshSource same = source;
    same.divisions = fine.divisions;
    same.target_tetrahedra = fine.target_tetrahedra;
    same.edge_length_m = fine.edge_length_m;
    if (!(same == fine)) return {};
    if (source.kind == "cubes")
        return fmt::format("{{ divisions = [{}] }}", fmt::join(source.divisions, ", "));
    if (source.target_tetrahedra > 0)
        return fmt::format("{{ target_tetrahedra = {} }}", source.target_tetrahedra);
    return fmt::format("{{ edge_length = {} }}", source.edge_length_m);
}

}  // namespace knead::tools
