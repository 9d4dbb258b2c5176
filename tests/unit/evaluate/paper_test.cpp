// SPDX-License-Identifier: Apache-2.0
// The paper's tables: what is published, how ours are summed up, how they are shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "common/error.h"
#include "evaluate/paper/document.h"
#include "evaluate/paper/published.h"
#include "evaluate/paper/report.h"
#include "evaluate/paper/run.h"
#include "evaluate/paper/summary.h"
#include "evaluate/tables.h"

namespace knead::tools {
namespace {

using testing::HasSubstr;
using testing::Not;

PublishedPaper published() {
    std::ifstream stream(KNEAD_PAPER_JSON);
    return published_paper(nlohmann::ordered_json::parse(stream));
}

CellResult cell(const Method& method, std::uint64_t tetrahedra, std::uint64_t seed, double error) {
    CellResult result;
    result.method = method;
    result.tetrahedra = tetrahedra;
    result.seed = seed;
    result.load = "press10";
    result.converged = true;
    result.reference_force_n = 20;
    result.force_n = 20 * (1 + error);
    result.force_error = error;
    result.runtime_force_n = result.force_n * (1 + 1e-6);
    return result;
}

constexpr Method kHomogenised{MethodKind::homogenised, 1, 1};
Method clustered(std::uint32_t clusters) {
    return {MethodKind::paper, 2, clusters};
}

/// Scenario 1 on its two meshes with two seeds: k = 1 outside, k = 3 inside with one seed only.
SceneResult small_scene() {
    SceneResult scene;
    scene.name = "scenario1";
    scene.reference_tetrahedra = 6000;
    for (const std::uint64_t tetrahedra : {6000U, 1296U}) {
        scene.cells.push_back(cell(kHomogenised, tetrahedra, 1, 0.18));
        scene.cells.push_back(cell(kHomogenised, tetrahedra, 2, 0.20));
        scene.cells.push_back(cell(clustered(1), tetrahedra, 1, -0.3));
        scene.cells.push_back(cell(clustered(1), tetrahedra, 2, -0.3));
        scene.cells.push_back(cell(clustered(3), tetrahedra, 1, -0.14));
        scene.cells.push_back(cell(clustered(3), tetrahedra, 2, -0.02));
    }
    return scene;
}

TEST(PublishedPaper, Table_2_has_53_of_81_cells_inside_the_jnd_and_some_k_in_24_of_27_pairs) {
    const PublishedPaper paper = published();
    std::size_t cells = 0, inside = 0;
    std::map<std::pair<std::string, std::uint64_t>, bool> some_k;
    for (const PublishedPaper::Cell& c : paper.table2) {
        if (c.clusters == 0) continue;
        ++cells;
        const bool within = std::abs(c.error) <= kJndOfForce;
        inside += within ? 1 : 0;
        some_k[{c.scene, c.tetrahedra}] |= within;
    }
    EXPECT_EQ(cells, 81u);
    EXPECT_EQ(inside, 53u);
    EXPECT_EQ(some_k.size(), 27u);
    std::size_t works = 0;
    for (const auto& [pair, any] : some_k)
        works += any ? 1 : 0;
    EXPECT_EQ(works, 24u);
    EXPECT_EQ(paper.reference_n.size(), 9u);
    EXPECT_EQ(paper.expected.size(), 9u);
    EXPECT_NEAR(paper.step_ms.at(6000) / paper.step_ms.at(1296), 5.9, 0.05);
}

TEST(PublishedPaper, Missing_number_is_no_valid_result) {
    nlohmann::ordered_json json;
    {
        std::ifstream stream(KNEAD_PAPER_JSON);
        json = nlohmann::ordered_json::parse(stream);
    }
    json["table2"][12].erase("value_percent");
    try {
        (void)published_paper(json);
        FAIL();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::no_valid_result);
        EXPECT_THAT(error.what(), HasSubstr("value_percent"));
    }
}

TEST(PaperSummary, Counts_are_by_the_mean_and_by_each_seed) {
    const PaperSummary summary = summarise_paper({small_scene()}, published());
    EXPECT_EQ(summary.seeds, 2u);
    EXPECT_EQ(summary.cells.of, 4u);
    EXPECT_EQ(summary.cells.ours, 2u);  // k = 3: mean -0.08 on both meshes
    EXPECT_EQ(summary.cells.ours_of_seed.lowest, 0);
    EXPECT_EQ(summary.cells.ours_of_seed.highest, 2);
    EXPECT_EQ(summary.cells.ours_of_seed.mean, 1);
    EXPECT_EQ(summary.some_k.of, 2u);
    EXPECT_EQ(summary.some_k.ours, 2u);
    EXPECT_EQ(summary.some_k.ours_of_seed.mean, 1);
    EXPECT_EQ(summary.cells.paper, 2u);  // the paper's k = 3 of scenario 1
}

TEST(PaperSummary, Cell_in_which_a_seed_did_not_converge_is_a_miss) {
    SceneResult scene = small_scene();
    scene.cells.back().converged = false;  // k = 3, 1,296 tetrahedra, seed 2
    scene.cells.back().runtime_force_n.reset();
    const PaperSummary summary = summarise_paper({scene}, published());
    EXPECT_EQ(summary.cells.ours, 1u);
    EXPECT_THAT(as_text(paper_document(summary, {}), false), HasSubstr("1 not converged"));
}

TEST(PaperSummary, Reference_and_homogenised_row_are_held_against_the_expected) {
    SceneResult scene = small_scene();
    const PaperSummary good = summarise_paper({scene}, published());
    ASSERT_EQ(good.checks.size(), 1u);
    EXPECT_TRUE(good.checks[0].reference_is_ok());    // 20 N, expected 19.79 N
    EXPECT_TRUE(good.checks[0].homogenised_is_ok());  // 19 %, expected 18.9 %
    EXPECT_TRUE(good.rows_are_ok());
    for (CellResult& c : scene.cells)
        c.reference_force_n = 19.79 * 1.051;
    EXPECT_FALSE(summarise_paper({scene}, published()).rows_are_ok());
    scene = small_scene();
    for (CellResult& c : scene.cells)
        if (c.method == kHomogenised) c.force_error = 0.189 + 0.021;
    const PaperSummary bad = summarise_paper({scene}, published());
    EXPECT_FALSE(bad.rows_are_ok());
    EXPECT_THAT(as_text(paper_document(bad, {}), false), HasSubstr("NOT OK"));
}

TEST(PaperSummary, Largest_disagreement_is_found_and_named_and_too_large_a_one_is_not_ok) {
    SceneResult scene = small_scene();
    scene.cells[7].runtime_force_n = scene.cells[7].force_n * (1 + 2e-3);
    const PaperSummary summary = summarise_paper({scene}, published());
    EXPECT_EQ(summary.disagreement.compared, scene.cells.size());
    EXPECT_NEAR(summary.disagreement.largest, 2e-3, 1e-9);
    EXPECT_EQ(summary.disagreement.where, "scenario1, homogenised, 1296 tetrahedra, seed 2");
    EXPECT_THAT(as_text(paper_document(summary, {}), false), HasSubstr("wanted at most 1e-03: NOT OK"));
    EXPECT_NE(disagreements({scene}), "");  // with which knead-evaluate fails
}

TEST(PaperSummary, Speed_up_is_between_medians_over_the_scenes) {
    std::vector<SceneResult> scenes(3, small_scene());
    const double disturbed = 10;
    for (std::size_t k = 0; k < 3; ++k) {
        const double factor = k == 1 ? disturbed : 1;
        scenes[k].speed = {{"reference", 0, 0, 6000, {{100 * factor}, {2000}}},
                           {"paper", 2, 3, 1296, {{20 * factor}, {500}}}};
    }
    const PaperSummary summary = summarise_paper(scenes, published());
    ASSERT_EQ(summary.table1.size(), 2u);
    EXPECT_EQ(summary.table1[0].tetrahedra, 6000u);
    EXPECT_EQ(summary.table1[0].runtime_us.mean, 100);
    EXPECT_EQ(summary.table1[0].runtime_us.highest, 1000);
    EXPECT_EQ(summary.table1[1].baseline_us.mean, 500);
    const std::string text = as_text(paper_document(summary, {}), false);
    EXPECT_THAT(text, HasSubstr("5.0x"));  // runtime
    EXPECT_THAT(text, HasSubstr("4.0x"));  // baseline
    EXPECT_THAT(text, HasSubstr("5.9x"));  // paper
}

TEST(PaperSummary, Steak_is_beside_the_papers_although_its_mesh_has_a_few_tetrahedra_more) {
    SceneResult steak = small_scene();
    steak.name = "steak";
    for (CellResult& c : steak.cells)
        c.tetrahedra = 1214;
    const PaperSummary summary = summarise_paper({steak}, published());
    EXPECT_TRUE(summary.table2.empty());
    ASSERT_FALSE(summary.steak.empty());
    for (const PaperCell& c : summary.steak)
        EXPECT_EQ(c.paper.has_value(), c.clusters != 0) << c.clusters;
}

TEST(PaperReport, Numbers_are_in_text_markdown_json_and_csv) {
    const PaperSummary summary = summarise_paper({small_scene()}, published());
    const std::vector<DocumentPart> document = paper_document(summary, {});
    EXPECT_THAT(as_text(document, false), HasSubstr("-8.0 ±8.5"));
    EXPECT_THAT(as_markdown(document), HasSubstr("-8.0 ±8.5 \u2713"));
    EXPECT_THAT(as_markdown(document), HasSubstr("-30.0 ±0.0 \u2717"));
    EXPECT_THAT(to_json(summary).dump(), HasSubstr("\"checks\":[{\"scene\":\"scenario1\""));
    EXPECT_THAT(table2_csv(summary), HasSubstr("scenario1,force_error,3,1296,2,2,1,-0.08000"));
}

TEST(Document, Colours_are_there_only_when_asked_for_and_marks_always) {
    const DocumentPart part{
        "A",
        {},
        {{"name", "value"}, {{{"x"}, {"1", Verdict::within}}, {{"y"}, {"2", Verdict::outside}}}},
        {}};
    const std::string plain = as_text({part}, false);
    EXPECT_EQ(plain, "A\n-\n  name  value\n  x       1\n  y       2 x\n");
    const std::string coloured = as_text({part}, true);
    EXPECT_THAT(coloured, HasSubstr("\x1b[32m"));
    EXPECT_THAT(coloured, HasSubstr("\x1b[31m"));
    EXPECT_THAT(plain, Not(HasSubstr("\x1b")));
}

TEST(Document, Columns_line_up_where_a_text_has_characters_of_several_bytes) {
    const DocumentPart part{"A", {}, {{"n", "v"}, {{{"x"}, {"1 ±2"}}, {{"y"}, {"1234"}}}}, {}};
    EXPECT_EQ(as_text({part}, false), "A\n-\n  n     v\n  x  1 ±2\n  y  1234\n");
}

TEST(PaperRun, Scene_that_is_not_in_the_paper_is_bad_usage) {
    EXPECT_TRUE(is_scenario("scenario1"));
    EXPECT_TRUE(is_scenario("scenario9"));
    EXPECT_FALSE(is_scenario("scenario0"));
    EXPECT_FALSE(is_scenario("scenario12"));
    EXPECT_FALSE(is_scenario("cube"));
}

// ---- The numbers of the last `make paper`, as committed in docs/paper.csv

struct CommittedRow {
    std::string scene, row;
    double clusters = 0, tetrahedra = 0, seeds = 0, mean = 0;
};

std::vector<CommittedRow> committed_rows() {
    std::ifstream stream(KNEAD_PAPER_CSV);
    std::vector<CommittedRow> rows;
    std::string line;
    std::getline(stream, line);
    EXPECT_EQ(line, "scene,row,clusters,tets,seeds,converged,seeds_within_jnd,mean,sd,lowest,highest,paper");
    while (std::getline(stream, line)) {
        std::vector<std::string> fields;
        std::istringstream in(line);
        for (std::string field; std::getline(in, field, ',');)
            fields.push_back(field);
        const auto number = [](const std::string& text) { return text.empty() ? 0 : std::stod(text); };
        rows.push_back({fields.at(0), fields.at(1), number(fields.at(2)), number(fields.at(3)),
                        number(fields.at(4)), number(fields.at(7))});
    }
    return rows;
}

TEST(CommittedPaper, Every_cell_of_ten_seeds_is_there) {
    std::size_t cells = 0, references = 0;
    for (const CommittedRow& row : committed_rows()) {
        EXPECT_EQ(row.seeds, 10) << row.scene;
        references += row.row == "reference_n" ? 1 : 0;
        cells += is_scenario(row.scene) && row.row == "force_error" ? 1 : 0;
    }
    EXPECT_EQ(references, 9u);
    EXPECT_EQ(cells, 9u * 3u * 4u);
}

TEST(CommittedPaper, Reference_and_homogenised_rows_are_within_5_percent_and_2_points_of_the_expected) {
    std::size_t checked = 0;
    const std::vector<CommittedRow> rows = committed_rows();
    for (const PublishedPaper::ExpectedRow& expected : published().expected)
        for (const CommittedRow& row : rows) {
            if (row.scene != expected.scene || row.tetrahedra != 6000) continue;
            if (row.row == "reference_n") {
                EXPECT_NEAR(row.mean / expected.reference_n, 1, kReferenceTolerance) << row.scene;
                ++checked;
            } else if (row.clusters == 0) {
                EXPECT_NEAR(row.mean, expected.homogenised_error, kHomogenisedTolerance) << row.scene;
                ++checked;
            }
        }
    EXPECT_EQ(checked, 18u);
}

}  // namespace
}  // namespace knead::tools
