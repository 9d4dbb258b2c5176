// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace knead::tools {

/// What the paper published, and what its reference and homogenised rows are checked against: the content of
/// data/paper.json. Errors are signed shares.
struct PublishedPaper {
    struct Cell {
        std::string scene;
        std::uint64_t tetrahedra = 0;
        std::uint32_t clusters = 0;  ///< 0: the homogenised object
        double error = 0;
    };
    /// Of a solver of its own, on other draws of the elasticities (docs/reference.md, column "design").
    struct ExpectedRow {
        std::string scene;
        double reference_n = 0;
        double homogenised_error = 0;
    };
    std::map<std::string, double> reference_n;      ///< [scene]
    std::vector<Cell> table2;                       ///< nine scenarios
    std::vector<Cell> steak;                        ///< scene "steak"
    std::map<std::uint64_t, double> step_ms;        ///< [tetrahedra] Table 1
    std::map<std::uint64_t, double> steak_step_ms;  ///< [tetrahedra] from the rates in Hz
    std::vector<ExpectedRow> expected;
    double some_k_works = 0;  ///< as the paper says it, a share

    /// Of the steak whatever the number of tetrahedra: the mesher meets the paper's within 2 %.
    [[nodiscard]] std::optional<double> error_of(const std::string& scene, std::uint64_t tetrahedra,
                                                 std::uint32_t clusters) const;
};

/// @throws ToolError(no_valid_result) when a number is missing
[[nodiscard]] PublishedPaper published_paper(const nlohmann::ordered_json& json);

}  // namespace knead::tools
