// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>

#include "mesh/gmsh_primitives.h"
#include "mesh/import.h"
#include "mesh/outline.h"
#include "quality/mesh_quality.h"
#include "unit/mesh/samples.h"

namespace knead::tools {
namespace {

using namespace test;

/// Flat shapes are meshed exactly: only rounding remains.
constexpr double kExactVolume = 1e-9;
/// A ball of about 2000 tetrahedra has chords instead of arcs.
constexpr double kRoundVolume = 0.03;
constexpr double kWantedCount = 0.05;  // the paper's steak: within 5 %

std::string data(const std::string& name) {
    std::ifstream stream(std::string(KNEAD_TEST_DATA) + "/mesh/" + name, std::ios::binary);
    EXPECT_TRUE(stream.good()) << name;
    return {std::istreambuf_iterator<char>(stream), {}};
}

ImportRequest in_metres() {
    ImportRequest request;
    request.metres_per_unit = 1;
    return request;
}

MeshSize target(std::size_t count) {
    return {.target_tetrahedra = count, .edge_length_m = {}};
}

void expect_count(const MadeMesh& made, double wanted) {
    EXPECT_NEAR(static_cast<double>(made.mesh.tetrahedra.size()), wanted, kWantedCount * wanted);
    EXPECT_TRUE(validate(made.mesh).ok());
}

void expect_volume(const MadeMesh& made, double volume, double tolerance) {
    EXPECT_NEAR(measure(made.mesh).volume_m3, volume, tolerance * volume);
}

TEST(Primitives, Have_their_volume_and_about_the_wanted_number_of_tetrahedra) {
    const double pi = std::numbers::pi;
    const MadeMesh box = finish(mesh_box({0.1, 0.05, 0.02}, target(2000)), "a box");
    expect_count(box, 2000);
    expect_volume(box, 0.1 * 0.05 * 0.02, kExactVolume);
    const MadeMesh sphere = finish(mesh_sphere(0.04, target(2000)), "a sphere");
    expect_count(sphere, 2000);
    expect_volume(sphere, 4 * pi / 3 * std::pow(0.04, 3), kRoundVolume);
    const MadeMesh cylinder = finish(mesh_cylinder(0.02, 0.05, target(2000)), "a cylinder");
    expect_count(cylinder, 2000);
    expect_volume(cylinder, pi * 0.02 * 0.02 * 0.05, kRoundVolume);
    EXPECT_NEAR(measure(cylinder.mesh).low_m[2], 0, kExactVolume);
    const MadeMesh ellipsoid = finish(mesh_ellipsoid({0.05, 0.03, 0.02}, target(2000)), "an ellipsoid");
    expect_count(ellipsoid, 2000);
    expect_volume(ellipsoid, 4 * pi / 3 * 0.05 * 0.03 * 0.02, kRoundVolume);
}

TEST(Primitives, Of_the_same_request_are_the_same_mesh) {
    const MadeMesh first = finish(mesh_sphere(0.04, target(800)), "a sphere");
    const MadeMesh second = finish(mesh_sphere(0.04, target(800)), "a sphere");
    EXPECT_EQ(first.mesh.nodes_m, second.mesh.nodes_m);
    EXPECT_EQ(first.mesh.tetrahedra, second.mesh.tetrahedra);
}

TEST(Primitives, Keep_the_wanted_edge_length) {
    const MadeMesh made =
        finish(mesh_box({0.1, 0.1, 0.1}, {.target_tetrahedra = {}, .edge_length_m = 0.02}), "a box");
    double sum = 0;
    for (const Tetrahedron& t : made.mesh.tetrahedra)
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j) {
                const Point& a = made.mesh.nodes_m[t[i]];
                const Point& b = made.mesh.nodes_m[t[j]];
                sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
            }
    // gmsh aims for the length, Delaunay meshes scatter around it, and each tetrahedron counts its inner
    // diagonals.
    constexpr double kMeanEdge = 0.25;
    EXPECT_NEAR(sum / (6.0 * static_cast<double>(made.mesh.tetrahedra.size())), 0.02, kMeanEdge * 0.02);
}

TEST(Primitives, With_bad_lengths_are_refused) {
    KNEAD_EXPECT_REFUSAL(mesh_sphere(0, {}), bad_usage, "greater than 0");
    KNEAD_EXPECT_REFUSAL(mesh_box({1, -1, 1}, {}), bad_usage, "greater than 0");
    KNEAD_EXPECT_REFUSAL(mesh_box({1, NAN, 1}, {}), bad_usage, "finite");
    KNEAD_EXPECT_REFUSAL(mesh_box({1, 1, 1}, {.target_tetrahedra = {}, .edge_length_m = 1e-5}), bad_usage,
                         "too small");
}

TEST(Outline, Of_the_steak_meshes_to_both_counts_of_the_paper) {
    OutlineSlab slab;
    slab.corners_m = read_outline(data("steak_outline.csv"));
    for (auto& corner : slab.corners_m)
        for (double& x : corner)
            x *= 0.01;
    slab.thickness_m = 0.025;
    for (const std::size_t wanted : {2894U, 1207U}) {
        const MadeMesh made = finish(mesh_outline(slab, target(wanted)), "an outline");
        expect_count(made, static_cast<double>(wanted));
        EXPECT_TRUE(made.notes.empty()) << made.notes[0].text;
        const MeshQuality quality = measure(made.mesh);
        EXPECT_EQ(quality.bodies, 1U);
        EXPECT_NEAR(quality.low_m[2], 0, kExactVolume);
        EXPECT_NEAR(quality.high_m[2], 0.025, kExactVolume);
        EXPECT_GT(quality.min_radius_ratio, kSliverRadiusRatio);
    }
}

TEST(Outline, As_a_polygon_has_the_area_of_the_polygon) {
    OutlineSlab slab;
    slab.corners_m = {{0, 0}, {0.04, 0}, {0.04, 0.02}, {0.02, 0.02}, {0.02, 0.04}, {0, 0.04}};
    slab.thickness_m = 0.01;
    slab.polygon = true;
    expect_volume(finish(mesh_outline(slab, target(600)), "an outline"), 0.0012 * 0.01, kExactVolume);
    slab.round_m = 0.006;
    KNEAD_EXPECT_REFUSAL(mesh_outline(slab, {}), bad_usage, "half of the thickness");
}

TEST(Import, Of_step_takes_the_unit_of_the_file) {
    ImportRequest request;
    request.size = target(500);
    const MadeMesh made = import_mesh(data("box_mm.step"), request);
    expect_count(made, 500);
    expect_volume(made, 0.01 * 0.02 * 0.03, kExactVolume);
    EXPECT_NEAR(measure(made.mesh).high_m[2], 0.03, kExactVolume);
    std::string in_metres_text = data("box_mm.step");
    const std::string milli = "SI_UNIT(.MILLI.,.METRE.)";
    in_metres_text.replace(in_metres_text.find(milli), milli.size(), "SI_UNIT($,.METRE.)");
    expect_volume(import_mesh(in_metres_text, request), 10 * 20 * 30, kExactVolume);
    request.metres_per_unit = 1;
    KNEAD_EXPECT_REFUSAL(import_mesh(data("box_mm.step"), request), bad_usage, "knows its length unit");
}

TEST(Import, Of_two_solids_that_touch_makes_one_mesh_with_two_regions) {
    const MadeMesh made = import_mesh(data("two_boxes.step"), {});
    EXPECT_EQ(made.mesh.regions.names, (std::vector<std::string>{"volume_1", "volume_2"}));
    EXPECT_EQ(measure(made.mesh).bodies, 1U);
    expect_volume(made, 2e-9, kExactVolume);
}

TEST(Import, Of_brep_needs_a_unit) {
    ImportRequest request;
    request.size = target(500);
    KNEAD_EXPECT_REFUSAL(import_mesh(data("box_mm.brep"), request), bad_usage, "--length-unit");
    request.metres_per_unit = 0.001;
    const MadeMesh made = import_mesh(data("box_mm.brep"), request);
    expect_count(made, 500);
    expect_volume(made, 0.01 * 0.02 * 0.03, kExactVolume);
}

TEST(Import, Of_a_closed_surface_fills_it) {
    ImportRequest request;
    request.metres_per_unit = 0.01;
    for (const std::string& content :
         {cube_stl(0, 2), cube_stl_binary(0, 2), cube_ply(0, 2), cube_ply_binary(0, 2, true)})
        expect_volume(import_mesh(content, request), 8e-6, kExactVolume);
    request.size = target(400);
    const MadeMesh anew = import_mesh(cube_stl(0, 2), request);
    expect_volume(anew, 8e-6, kExactVolume);
    EXPECT_NEAR(static_cast<double>(anew.mesh.tetrahedra.size()), 400, kWantedCount * 400);
}

TEST(Import, Of_a_hollow_surface_leaves_the_cavity_empty) {
    ImportRequest request = in_metres();
    request.size = target(1500);
    expect_volume(import_mesh(cube_stl(0, 1) + cube_stl(0.25, 0.75), request), 1 - 0.125, kExactVolume);
    expect_volume(import_mesh(cube_stl(0, 1) + cube_stl(2, 3), request), 2, kExactVolume);
}

TEST(Import, Of_a_surface_with_a_hole_is_refused) {
    KNEAD_EXPECT_REFUSAL(import_mesh(cube_stl(0, 1, 1), in_metres()), bad_input, "hole");
}

TEST(Import, Of_msh_gives_the_same_mesh_from_every_version) {
    const MadeMesh reference = import_mesh(data("two_boxes_v2.2.msh"), in_metres());
    EXPECT_EQ(reference.mesh.tetrahedra.size(), 48U);
    EXPECT_EQ(reference.mesh.regions.names, (std::vector<std::string>{"soft", "physical_12"}));
    expect_volume(reference, 2, kExactVolume);
    for (std::size_t t = 0; t < 48; ++t)
        EXPECT_EQ(reference.mesh.regions.region_of_tetrahedron[t],
                  barycentre_m(reference.mesh, t)[0] < 1 ? 0U : 1U);
    for (const char* name :
         {"two_boxes_v2.2b.msh", "two_boxes_v4.msh", "two_boxes_v4.1.msh", "two_boxes_v4.1b.msh"}) {
        const MadeMesh made = import_mesh(data(name), in_metres());
        EXPECT_EQ(made.mesh.nodes_m, reference.mesh.nodes_m) << name;
        EXPECT_EQ(made.mesh.tetrahedra, reference.mesh.tetrahedra) << name;
        EXPECT_EQ(made.mesh.regions.names, reference.mesh.regions.names) << name;
        EXPECT_EQ(made.mesh.regions.region_of_tetrahedron, reference.mesh.regions.region_of_tetrahedron)
            << name;
    }
    const MadeMesh version_1 = import_mesh(data("two_boxes_v1.msh"), in_metres());
    EXPECT_EQ(version_1.mesh.tetrahedra, reference.mesh.tetrahedra);
    EXPECT_EQ(version_1.mesh.regions.names, (std::vector<std::string>{"physical_11", "physical_12"}));
}

TEST(Import, Of_msh_with_element_data_carries_them) {
    const MadeMesh made = import_mesh(data("two_boxes_with_data.msh"), in_metres());
    ASSERT_EQ(made.mesh.cell_arrays.size(), 1U);
    EXPECT_EQ(made.mesh.cell_arrays[0].name, "stiffness");
    ASSERT_EQ(made.mesh.cell_arrays[0].values.size(), 48U);
    for (std::size_t t = 1; t < 48; ++t)  // the file gives every element its own number
        EXPECT_EQ(made.mesh.cell_arrays[0].values[t],
                  made.mesh.cell_arrays[0].values[0] + static_cast<double>(t));
}

TEST(Import, Of_msh_names_bad_elements_by_their_numbers) {
    std::string text = small_msh();
    text.replace(text.find("1 2 3 4\n$EndE"), 7, "1 2 3 9");
    KNEAD_EXPECT_REFUSAL(import_mesh(text, in_metres()), bad_input, "gmsh cannot read");
    text = small_msh();
    text.replace(text.find("4 0 0 1"), 7, "4 2 2 0");
    KNEAD_EXPECT_REFUSAL(import_mesh(text, in_metres()), bad_input, "have no volume (2;");
}

TEST(Import, Of_binary_msh_that_was_cut_off_is_refused) {
    const std::string whole = data("two_boxes_v4.1b.msh");
    const std::size_t elements = whole.find("$Elements");
    for (std::size_t size : {elements + 20, elements + 200, whole.size() - 20})
        EXPECT_THROW((void)import_mesh(whole.substr(0, size), in_metres()), ToolError) << size;
    // Cut in the middle, but with all the section names in place.
    const std::string patched = whole.substr(0, elements + 200) + "\n$EndElements\n";
    EXPECT_THROW((void)import_mesh(patched, in_metres()), ToolError);
}

TEST(Import, Of_a_damaged_file_that_crashes_gmsh_is_refused_and_survived) {
    KNEAD_EXPECT_REFUSAL(import_mesh(data("damaged_box.brep"), in_metres()), bad_input, "damaged");
}

TEST(Import, Options_that_do_not_fit_the_format_are_refused) {
    KNEAD_EXPECT_REFUSAL(import_mesh(small_msh(), {}), bad_usage, "--length-unit");
    ImportRequest request = in_metres();
    request.size = target(10);
    KNEAD_EXPECT_REFUSAL(import_mesh(small_msh(), request), bad_usage, "is a mesh already");
    request = in_metres();
    request.repair_orientation = true;
    KNEAD_EXPECT_REFUSAL(import_mesh(cube_stl(0, 1), request), bad_usage, "is not a mesh");
}

}  // namespace
}  // namespace knead::tools
