// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/evaluation.h"
#include "evaluate/paper/published.h"

namespace knead::tools {

/// How far a row of the reference or of the homogenised object may be from what is expected.
inline constexpr double kReferenceTolerance = 0.05;    ///< relative
inline constexpr double kHomogenisedTolerance = 0.02;  ///< 2 points

/// Mean and spread of some values.
struct Statistic {
    double mean = 0;
    double deviation = 0;  ///< sample standard deviation; 0 for one value
    double lowest = 0, highest = 0;
};
[[nodiscard]] Statistic statistic_of(const std::vector<double>& values);

/// One cell of Table 2 over all seeds.
struct PaperCell {
    std::string scene;
    std::uint64_t tetrahedra = 0;
    std::uint32_t clusters = 0;  ///< 0: the homogenised object
    std::size_t seeds = 0, converged = 0;
    std::size_t within = 0;       ///< seeds inside the JND
    Statistic error;              ///< of what converged
    std::optional<double> paper;  ///< the paper's cell
    /// The mean is inside the JND and every seed converged.
    [[nodiscard]] bool mean_is_within() const;
    [[nodiscard]] bool paper_is_within() const;
};

/// The two rows that every solver should agree on.
struct RowCheck {
    std::string scene;
    Statistic reference_n;
    PaperCell homogenised;  ///< on the fine mesh
    double expected_reference_n = 0, expected_homogenised = 0;
    std::optional<double> paper_reference_n;
    [[nodiscard]] bool reference_is_ok() const;
    [[nodiscard]] bool homogenised_is_ok() const;
};

/// How many things are so, ours and the paper's.
struct PaperCount {
    std::size_t of = 0;      ///< counted things
    std::size_t ours = 0;    ///< by the mean over the seeds
    Statistic ours_of_seed;  ///< count of each seed
    std::size_t paper_of = 0, paper = 0;
};

/// Ours against the paper's, over the cells of one number of clusters that both have.
struct PaperDifference {
    std::uint32_t clusters = 0;
    std::size_t cells = 0, same_verdict = 0;
    double root_mean_square = 0;  ///< of mean - paper, shares
    double mean = 0;
    double deviation_of_seeds = 0;  ///< root mean square of the cells' standard deviations
};

/// One mesh of Table 1: median steps, microseconds, over the scenes.
struct SpeedRow {
    std::uint64_t tetrahedra = 0;
    Statistic runtime_us, baseline_us;  ///< `mean` is the median over the scenes
    std::optional<double> paper_ms;
};

/// Where runtime and reference solver are farthest apart.
struct Disagreement {
    std::size_t compared = 0;  ///< results in which both ran
    double largest = 0;
    std::string where;
};

struct PaperSummary {
    std::uint32_t seeds = 0;
    std::vector<std::string> scenes;  ///< scenarios, in the order of the results
    std::vector<SpeedRow> table1, steak_speed;
    std::vector<PaperCell> table2, steak;
    PaperCount cells, some_k;
    std::vector<PaperDifference> differences;
    std::vector<RowCheck> checks;
    std::vector<CurveResult> figure8;  ///< of scenario 2, all meshes; the reference first
    Disagreement disagreement;
    double some_k_works_in_paper = 0;  ///< as its text says it
    [[nodiscard]] bool rows_are_ok() const;
};

/// @param scenes results of evaluate_paper()
[[nodiscard]] PaperSummary summarise_paper(const std::vector<SceneResult>& scenes,
                                           const PublishedPaper& published);

}  // namespace knead::tools
