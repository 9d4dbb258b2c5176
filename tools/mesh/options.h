// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/gmsh_mesher.h"

namespace knead::tools {

/// The command line of knead-mesh as it was typed. Lengths are texts until length_m() and lengths_m() read
/// them.
struct MeshOptions {
    std::string command;  ///< "cubes", "box", "sphere", "cylinder", "ellipsoid", "outline" or "import"
    std::filesystem::path output;
    std::vector<std::uint32_t> divisions;
    std::vector<std::string> lengths;  ///< --size or --radii
    std::string radius;
    std::string height;
    std::string thickness;
    std::string round = "0";
    bool polygon = false;
    std::filesystem::path file;  ///< --points, or what is imported
    std::string length_unit;     ///< empty: not said
    std::optional<std::size_t> target_tetrahedra;
    std::string edge_length;  ///< empty: not said
    bool merge_duplicate_nodes = false;
    bool repair_orientation = false;

    [[nodiscard]] MeshSize size() const;
};

void declare_options(CLI::App& app, MeshOptions& options);

/// Lengths in metres; one length stands for all three axes. Throws bad_usage for what is no length > 0.
[[nodiscard]] double length_m(const std::string& text, const char* option);
[[nodiscard]] std::array<double, 3> lengths_m(const std::vector<std::string>& texts, const char* option);
[[nodiscard]] std::array<std::uint32_t, 3> divisions(const MeshOptions& options);

/// Everything that changes the result, defaults included, lengths in metres, in a fixed order; no path.
[[nodiscard]] std::vector<std::string> canonical_arguments(const MeshOptions& options);

}  // namespace knead::tools
