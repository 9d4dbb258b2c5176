// SPDX-License-Identifier: Apache-2.0
#include "evaluate/html_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"

namespace knead::tools {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kTemplate = "<script id=\"data\">@KNEAD_EVALUATION@</script><p>after</p>";
/// Six significant digits are kept: half a unit in the last place.
constexpr double kRounding = 5e-6;

/// The data of a page made with kTemplate, as a browser would read it: up to the first end of a script.
json data_of(const std::string& page) {
    const std::size_t from = page.find('>') + 1;
    return json::parse(page.substr(from, page.find("</script") - from));
}

json evaluation_with_name(const std::string& name) {
    return {{"schema", "knead-evaluation/1"}, {"scenes", {{{"name", name}}}}};
}

class Report_with_a_hostile_name : public testing::TestWithParam<const char*> {};

TEST_P(Report_with_a_hostile_name, keeps_it_inside_the_script) {
    const std::string page = html_report(evaluation_with_name(GetParam()), kTemplate);
    EXPECT_EQ(data_of(page)["scenes"][0]["name"], GetParam());
    EXPECT_THAT(page, testing::EndsWith("}</script><p>after</p>"));
    EXPECT_TRUE(std::all_of(page.begin(), page.end(), [](unsigned char c) { return c >= 0x20 && c < 0x80; }));
    EXPECT_EQ(page.find('<', page.find('>')), page.find("</script><p>after"));
}

INSTANTIATE_TEST_SUITE_P(each, Report_with_a_hostile_name,
                         testing::Values("</script><script>alert(1)</script>", "<!-- <script>", "]]>",
                                         "$& $1 \\ \"", "\xe2\x80\xa8 and \xe2\x80\xa9", "\n\t\x01",
                                         "@KNEAD_EVALUATION@", "\xf0\x9f\xa5\xa9 steak"));

TEST(Report_of_a_name_that_is_not_utf8, shows_the_replacement_character) {
    const std::string page = html_report(evaluation_with_name("a\xff"
                                                              "b"),
                                         kTemplate);
    EXPECT_EQ(data_of(page)["scenes"][0]["name"],
              "a\xef\xbf\xbd"
              "b");
}

TEST(Report_from_a_template, without_the_placeholder_is_refused) {
    try {
        (void)html_report(json::object(), "<p></p>");
        FAIL() << "accepted";
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        EXPECT_THAT(error.what(), HasSubstr("nowhere"));
    }
}

TEST(Report_from_a_template, with_two_placeholders_is_refused) {
    EXPECT_THROW((void)html_report(json::object(), std::string(kTemplate) + kTemplate), ToolError);
}

json result(const std::string& method, double error) {
    return {{"method", method},
            {"tets", 1296},
            {"force_error", error},
            {"fitted", false},
            {"step_us", {{"p50", 128.25}, {"max", 400}}}};
}

json scene_with(const json& results) {
    return {{"scenes", {{{"name", "a"}, {"results", results}}}}};
}

TEST(Report_data_of_results, is_a_table_with_a_row_for_each) {
    json second = result("hill", -1.0 / 3);
    second.erase("fitted");
    const json data = page_data(scene_with({result("paper", 0.1), second}));
    EXPECT_EQ(
        data["scenes"][0]["results"],
        json::parse(R"({"columns": ["fitted", "force_error", "method", "step_us.max", "step_us.p50", "tets"],
                              "rows": [[false, 0.1, "paper", 400, 128.25, 1296],
                                       [null, -0.333333, "hill", 400, 128.25, 1296]]})"));
}

TEST(Report_data_of_results, that_no_table_can_hold_stays_as_it_is) {
    for (const char* odd :
         {R"([{"a.b": {"c": 1}, "step_us": {"p.50": 1}}])", R"([1, 2])", R"([{"step_us": {}}])"}) {
        const json results = json::parse(odd);
        EXPECT_EQ(page_data(scene_with(results))["scenes"][0]["results"], results) << odd;
    }
}

TEST(Report_data_of_numbers, keep_six_digits) {
    const std::vector<double> values{1.0 / 3, -2.0e-7 / 3, 12345.678901, 1e300 / 7, 0.1, 107.6951234};
    const json data = page_data({{"values", values}});
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(data["values"][i].get<double>(), values[i], kRounding * std::abs(values[i]));
        EXPECT_LE(data["values"][i].dump().size(), std::string("-6.66667e-08").size());
    }
    EXPECT_EQ(page_data({{"n", 3000000000000000000}})["n"], 3000000000000000000);
    EXPECT_EQ(page_data({{"n", 2.0}}).dump(), R"({"n":2})");
}

json state(const std::string& name, const std::vector<double>& moduli) {
    return {{"name", name},
            {"nodes_m", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}},
            {"tetrahedra", {0, 1, 2, 3}},
            {"youngs_modulus_pa", moduli},
            {"bin", {1}},
            {"cluster", {0}}};
}

TEST(Report_data_of_states, share_their_mesh_and_use_a_palette) {
    json data = {{"scenes", json::array()}};
    data["scenes"].push_back(
        {{"states", {state("C1", {4000.125, 2.5e4}), state("C2", {4e3, 4e3, 2e4, 4e3})}}});
    data["scenes"].push_back({{"states", {state("C1", {4e3, 2.5e4})}}});
    data["scenes"][1]["states"][0]["tetrahedra"] = {0, 2, 1, 3};
    data = page_data(data);
    EXPECT_EQ(data["scenes"][0]["states"], json::parse(R"([
        {"name": "C1", "mesh": 0, "modulus": 0}, {"name": "C2", "mesh": 0, "modulus": 1}])"));
    EXPECT_EQ(data["moduli"],
              json::parse(R"([[4000, 25000], {"palette": [4000, 20000], "index": [0, 0, 1, 0]}])"));
    EXPECT_EQ(data["scenes"][1]["states"][0]["modulus"], 0);
    EXPECT_EQ(data["scenes"][1]["states"][0]["mesh"], 1);
    EXPECT_EQ(data["meshes"].size(), 2U);
    EXPECT_EQ(data["meshes"][1]["tetrahedra"], json::parse("[0, 2, 1, 3]"));
}

TEST(Report_data_of_something_else, is_that) {
    for (const char* odd : {"3", "[]", "null", R"({"scenes": 3})", R"({"scenes": [1, null]})"})
        EXPECT_NO_THROW((void)html_report(json::parse(odd), kTemplate)) << odd;
}

TEST(Report_template, is_beside_the_programs_folder) {
    EXPECT_EQ(html_template_path("/opt/knead/bin/knead-evaluate"), "/opt/knead/share/knead/report.html");
}

}  // namespace
}  // namespace knead::tools
