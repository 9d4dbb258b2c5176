// SPDX-License-Identifier: Apache-2.0
#include "material/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/error.h"

namespace knead::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using namespace tools;

/// Message of the ToolError that a call throws.
std::string complaint(const std::function<void()>& call) {
    try {
        call();
    } catch (const ToolError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Value_csv, One_column_with_header_and_foreign_line_ends_is_read) {
    const ValueTable table = parse_value_csv("\xEF\xBB\xBFyoungs modulus\r\n 1e3 \r\n+2500.5\r\n\r\n");
    EXPECT_THAT(table.youngs_modulus_pa, ElementsAre(1000, 2500.5));
    EXPECT_TRUE(table.poissons_ratio.empty());
    EXPECT_TRUE(table.density_kg_per_m3.empty());
}

TEST(Value_csv, Three_columns_without_header_are_read) {
    const ValueTable table = parse_value_csv("1000,0.3,900\n2000, 0.4 ,1100");
    EXPECT_THAT(table.youngs_modulus_pa, ElementsAre(1000, 2000));
    EXPECT_THAT(table.poissons_ratio, ElementsAre(0.3, 0.4));
    EXPECT_THAT(table.density_kg_per_m3, ElementsAre(900, 1100));
}

TEST(Value_csv, Errors_name_the_line) {
    EXPECT_THAT(complaint([] { return parse_value_csv("E\n1\n2\n3x\n"); }), HasSubstr("line 4: \"3x\""));
    EXPECT_THAT(complaint([] { return parse_value_csv("1\n2,0.3,1000\n"); }), HasSubstr("line 2: 3 columns"));
    EXPECT_THAT(complaint([] { return parse_value_csv("1,2\n"); }), HasSubstr("line 1: 2 columns"));
    EXPECT_THAT(complaint([] { return parse_value_csv("1\n\n2\n"); }), HasSubstr("line 2: is empty"));
    EXPECT_THAT(complaint([] { return parse_value_csv("1,0.3,\n"); }), HasSubstr("line 1: \"\""));
    EXPECT_THAT(complaint([] { return parse_value_csv(""); }), HasSubstr("no values"));
    EXPECT_THAT(complaint([] { return parse_value_csv("E\n"); }), HasSubstr("no values"));
    EXPECT_THAT(complaint([] { return parse_value_csv("1.000,5\n"); }), HasSubstr("2 columns"));
}

TEST(Value_csv, A_second_header_is_not_skipped) {
    EXPECT_THAT(complaint([] { return parse_value_csv("E\nE\n1\n"); }), HasSubstr("line 2: \"E\""));
}

TEST(Value_csv, Not_a_number_reaches_the_check_of_the_values) {
    EXPECT_TRUE(std::isnan(parse_value_csv("1\nnan\n").youngs_modulus_pa[1]));
}

TEST(Region_csv, Names_may_hold_commas_and_quotes_are_taken_off) {
    const auto regions =
        parse_region_csv("region,E,nu,density\nfat, left,1000,0.3,900\n\"lean\",2e3,0.4,1100\n");
    ASSERT_EQ(regions.size(), 2U);
    EXPECT_EQ(regions[0].region, "fat, left");
    EXPECT_EQ(regions[0].youngs_modulus_pa, 1000);
    EXPECT_EQ(regions[1].region, "lean");
    EXPECT_EQ(regions[1].poissons_ratio, 0.4);
    EXPECT_EQ(regions[1].density_kg_per_m3, 1100);
}

TEST(Region_csv, Errors_name_the_line) {
    EXPECT_THAT(complaint([] { return parse_region_csv("fat,1,0.3,900\nlean,1,0.3\n"); }),
                HasSubstr("line 2"));
    EXPECT_THAT(complaint([] { return parse_region_csv("fat,1,0.3,heavy\nlean,1,0.3,1\n"); }),
                HasSubstr("line 1: \"heavy\""));
}

TEST(Region_option, Last_equals_sign_separates) {
    const RegionValues values = parse_region_option("a=b=1e4,0.45,1050");
    EXPECT_EQ(values.region, "a=b");
    EXPECT_EQ(values.youngs_modulus_pa, 1e4);
    EXPECT_EQ(values.poissons_ratio, 0.45);
    EXPECT_EQ(values.density_kg_per_m3, 1050);
}

TEST(Region_option, Anything_else_is_bad_usage) {
    for (const char* text : {"", "fat", "=1,0.3,900", "fat=1,0.3", "fat=1,0.3,900,1", "fat=1,0.3,x"}) {
        try {
            (void)parse_region_option(text);
            ADD_FAILURE() << text << " was accepted";
        } catch (const ToolError& error) {
            EXPECT_EQ(error.code(), ExitCode::bad_usage) << text;
        }
    }
}

}  // namespace
}  // namespace knead::test
