// SPDX-License-Identifier: Apache-2.0
#include "material/request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using namespace tools;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Refusal {
    ExitCode code = ExitCode::done;
    std::string message;
};

Refusal refusal(const MaterialRequest& request, const TetMesh& mesh = kuhn_cube(1)) {
    try {
        (void)make_material(mesh, request);
    } catch (const ToolError& error) {
        return {error.code(), error.what()};
    }
    return {};
}

MaterialRequest table_of(ValueTable table) {
    MaterialRequest request;
    request.table = std::move(table);
    return request;
}

TEST(Request, Uniform_notes_its_values_and_the_defaults) {
    MaterialRequest request;
    request.uniform_pa = 22e3;
    const MaterialAnswer answer = make_material(kuhn_cube(1), request);
    EXPECT_EQ(answer.material.youngs_modulus_pa, std::vector<double>(6, 22e3));
    EXPECT_FALSE(answer.used_seed);
    EXPECT_THAT(answer.canonical_arguments,
                ElementsAre("--uniform", "22000", "--poissons-ratio", "0.3", "--density", "1000"));
}

TEST(Request, Scenario_with_total_mass_weighs_that) {
    MaterialRequest request;
    request.scenario = 1;
    request.total_mass_kg = 1;
    const MaterialAnswer answer = make_material(kuhn_cube(4), request);
    EXPECT_NEAR(answer.material.density_kg_per_m3[0], 1000, 1e-9);
    EXPECT_TRUE(answer.used_seed);
    EXPECT_THAT(answer.canonical_arguments,
                ElementsAre("--scenario", "1", "--poissons-ratio", "0.3", "--total-mass", "1"));
}

TEST(Request, Bad_values_of_the_request_itself_are_bad_usage) {
    MaterialRequest request;
    request.uniform_pa = 0;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.uniform_pa = kNan;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.uniform_pa = 1e4;
    request.poissons_ratio = 0.5;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    EXPECT_THAT(refusal(request).message, HasSubstr("incompressible"));
    request.poissons_ratio = -1;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.poissons_ratio = 0.3;
    request.density_kg_per_m3 = -1;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.density_kg_per_m3 = 1000;
    request.total_mass_kg = 1;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.density_kg_per_m3.reset();
    EXPECT_EQ(refusal(request).code, ExitCode::done);
    EXPECT_EQ(refusal(MaterialRequest{}).code, ExitCode::bad_usage);
}

TEST(Request, Bad_values_of_a_source_name_the_tetrahedra) {
    const Refusal negative = refusal(table_of({{1, -2, 3, kNan, 5, 0}, {}, {}}));
    EXPECT_EQ(negative.code, ExitCode::bad_input);
    EXPECT_THAT(negative.message, HasSubstr("3 of 6 values of Young's modulus"));
    EXPECT_THAT(negative.message, HasSubstr("from 0: 1, 3, 5)"));
    const std::vector<double> ones(6, 1.0);
    const Refusal incompressible = refusal(table_of({ones, {.3, .3, .5, .3, .3, .3}, ones}));
    EXPECT_THAT(incompressible.message, HasSubstr("incompressible"));
    EXPECT_THAT(incompressible.message, HasSubstr("from 0: 2)"));
    EXPECT_THAT(refusal(table_of({ones, {.3, .3, .3, .3, -1, .3}, ones})).message, HasSubstr("from 0: 4)"));
    EXPECT_THAT(refusal(table_of({ones, {.3, kNan, .3, .3, .3, .3}, ones})).message, HasSubstr("from 0: 1)"));
    EXPECT_THAT(refusal(table_of({ones, std::vector<double>(6, .3), {1, 1, 1, 1, 1, 0}})).message,
                HasSubstr("density"));
}

TEST(Request, An_expression_that_reaches_zero_is_bad_input) {
    MaterialRequest request;
    request.expression = "z - 0.05";
    EXPECT_EQ(refusal(request).code, ExitCode::bad_input);
}

TEST(Request, Defaults_that_the_source_overrules_are_refused) {
    const std::vector<double> ones(6, 1.0);
    MaterialRequest request = table_of({ones, std::vector<double>(6, 0.3), ones});
    EXPECT_EQ(refusal(request).code, ExitCode::done);
    request.poissons_ratio = 0.3;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.poissons_ratio.reset();
    request.total_mass_kg = 1;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
    request.total_mass_kg.reset();
    request.density_kg_per_m3 = 1;
    EXPECT_EQ(refusal(request).code, ExitCode::bad_usage);
}

TEST(Request, Own_arrays_of_the_mesh_bring_what_they_have) {
    TetMesh mesh = kuhn_cube(1);
    mesh.cell_arrays = {{"youngs_modulus_pa", std::vector<double>(6, 5e3)},
                        {"poissons_ratio", std::vector<double>(6, 0.45)}};
    MaterialRequest request;
    request.from_mesh = true;
    request.density_kg_per_m3 = 1100;
    const MaterialAnswer answer = make_material(mesh, request);
    EXPECT_EQ(answer.material.poissons_ratio[0], 0.45);
    EXPECT_EQ(answer.material.density_kg_per_m3[0], 1100);
    EXPECT_THAT(answer.canonical_arguments, ElementsAre("--from-mesh", "--density", "1100"));
}

}  // namespace
}  // namespace knead::test
