// SPDX-License-Identifier: Apache-2.0
// knead-material, knead-cluster, knead-aggregate and knead-coarsen as programs: what they write, what they
// refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "knead/formats/read.h"
#include "knead/formats/write/write.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Outcome {
    int code = -1;
    std::string message;  ///< stderr
};

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class Method_cli : public testing::Test {
  protected:
    Method_cli() {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        mesh_.regions = {{"fat", "lean"}, {}};
        for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
            mesh_.regions.region_of_tetrahedron.push_back(barycentre_m(mesh_, t)[2] > 0.05 ? 1 : 0);
        mesh_.cell_arrays = {{"youngs_modulus_pa", std::vector<double>(mesh_.tetrahedra.size(), 5e3)},
                             {"poissons_ratio", std::vector<double>(mesh_.tetrahedra.size(), 0.45)}};
        EXPECT_TRUE(write_tet_mesh(folder_ / "mesh.hdf", mesh_, {}).ok());
        OverlapMatrix overlap{384, 384, {0}, {}, {}};
        for (std::uint32_t t = 0; t < 384; ++t) {
            overlap.columns.push_back(t);
            overlap.volumes_m3.push_back(signed_volume_m3(mesh_, t));
            overlap.row_offsets.push_back(t + 1);
        }
        EXPECT_TRUE(write_overlap(folder_ / "overlap.hdf", overlap, {}).ok());
    }
    ~Method_cli() override { fs::remove_all(folder_); }

    /// Runs "knead-<arguments>" in the folder of the case.
    Outcome run(const std::string& arguments) const {
        const std::string command = "cd " + folder_.string() + " && " + KNEAD_BIN + "/knead-" + arguments +
                                    " >stdout.txt 2>stderr.txt";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_ / "stderr.txt")};
    }
    void must_run(const std::string& arguments) const {
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.code, 0) << arguments << "\n" << outcome.message;
    }
    void must_fail(int code, const std::string& message, const std::string& arguments) const {
        const Outcome outcome = run(arguments + " -o refused.hdf");
        EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.message;
        EXPECT_THAT(outcome.message, HasSubstr(message)) << arguments;
        EXPECT_FALSE(fs::exists(folder_ / "refused.hdf")) << arguments;
    }
    void write(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    Material material(const char* name) const {
        auto object = read_material(folder_ / name);
        EXPECT_TRUE(object.ok()) << (object.ok() ? "" : object.error().text());
        return object.ok() ? object.value().material : Material{};
    }

    fs::path folder_ =
        fs::temp_directory_path() / ("knead_method_cli_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    TetMesh mesh_ = kuhn_cube(4);
};

TEST_F(Method_cli, Chain_from_mesh_to_coarse_material_runs_and_keeps_two_values) {
    must_run("material mesh.hdf -o m.hdf --scenario 1 --seed 3 --total-mass 1 --report m.json --depfile m.d");
    must_run("cluster m.hdf -o c.hdf --bins 2 --clusters 3 --report c.json");
    must_run("aggregate c.hdf -o a.hdf --report a.json");
    must_run("coarsen a.hdf mesh.hdf overlap.hdf -o k.hdf --report k.json");
    const Material fine = material("a.hdf");
    const Material coarse = material("k.hdf");
    EXPECT_EQ(coarse.youngs_modulus_pa, fine.youngs_modulus_pa);  // the overlap is that of a mesh with itself
    EXPECT_EQ(coarse.bin_of_tetrahedron, fine.bin_of_tetrahedron);
    EXPECT_EQ(std::set(fine.youngs_modulus_pa.begin(), fine.youngs_modulus_pa.end()).size(), 2U);
    EXPECT_THAT(text_of(folder_ / "m.d"), HasSubstr("m.hdf: \\\n  mesh.hdf"));
    for (const char* report : {"m.json", "c.json", "a.json", "k.json"})
        EXPECT_THAT(text_of(folder_ / report), HasSubstr("\"seconds\"")) << report;
    const auto header = read_header(folder_ / "c.hdf");
    ASSERT_TRUE(header.ok());
    EXPECT_EQ(header.value().kind, FileKind::clustering);
    EXPECT_THAT(header.value().provenance.arguments,
                testing::ElementsAre("--bins", "2", "--clusters", "3", "--binning", "equal-width",
                                     "--restarts", "5"));
    EXPECT_EQ(header.value().provenance.inputs.at(0).second,
              read_header(folder_ / "m.hdf").value().content_hash);
}

TEST_F(Method_cli, Same_arguments_give_the_same_bytes_on_any_number_of_threads) {
    must_run("material mesh.hdf -o m.hdf --scenario 9");
    must_run("material mesh.hdf -o again.hdf --scenario 9");
    EXPECT_EQ(text_of(folder_ / "m.hdf"), text_of(folder_ / "again.hdf"));
    must_run("cluster m.hdf -o one.hdf --clusters 6 -j 1");
    must_run("cluster m.hdf -o four.hdf --clusters 6 -j 4");
    EXPECT_EQ(text_of(folder_ / "one.hdf"), text_of(folder_ / "four.hdf"));
    must_run("aggregate one.hdf -o a.hdf");
    must_run("aggregate four.hdf -o b.hdf");
    EXPECT_EQ(text_of(folder_ / "a.hdf"), text_of(folder_ / "b.hdf"));
}

TEST_F(Method_cli, Every_source_of_material_is_accepted) {
    std::string values = "E,nu,density\n";
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
        values += std::to_string(1000 + t) + ",0.4,1100\n";
    write("values.csv", values);
    write("regions.csv", "region,E,nu,density\nlean,20000,0.45,1060\nfat,1000,0.49,900\n");
    must_run("material mesh.hdf -o u.hdf --uniform 22000 --poissons-ratio 0.25");
    EXPECT_EQ(material("u.hdf").poissons_ratio[7], 0.25);
    must_run("material mesh.hdf -o v.hdf --csv values.csv");
    EXPECT_EQ(material("v.hdf").youngs_modulus_pa[383], 1383);
    EXPECT_EQ(material("v.hdf").density_kg_per_m3[0], 1100);
    must_run("material mesh.hdf -o r.hdf --region fat=1000,0.49,900 --region lean=20000,0.45,1060");
    must_run("material mesh.hdf -o t.hdf --region-table regions.csv");
    EXPECT_EQ(material("r.hdf").youngs_modulus_pa, material("t.hdf").youngs_modulus_pa);
    EXPECT_EQ(material("r.hdf").poissons_ratio[0], 0.49);
    must_run("material mesh.hdf -o y.hdf --array youngs_modulus_pa");
    EXPECT_EQ(material("y.hdf").poissons_ratio[0], 0.3);
    must_run("material mesh.hdf -o f.hdf --from-mesh");
    EXPECT_EQ(material("f.hdf").poissons_ratio[0], 0.45);
    must_run("material mesh.hdf -o x.hdf --expression '1e4 + 1e5*z'");
    EXPECT_EQ(read_header(folder_ / "x.hdf").value().provenance.seed, 0U);
}

TEST_F(Method_cli, Every_binning_order_interest_and_rule_is_accepted) {
    must_run("material mesh.hdf -o m.hdf --scenario 7");
    for (const char* binning : {"equal-width", "equal-population", "equal-width-log", "kmeans"})
        must_run(std::string("cluster m.hdf -o c.hdf --binning ") + binning);
    for (const char* interest : {"combined", "distance", "direction", "membership", "mahalanobis"})
        must_run(
            std::string("aggregate c.hdf -o a.hdf --direction-weight 0.5 --order soft-first --interest ") +
            interest);
    must_run("coarsen m.hdf mesh.hdf overlap.hdf -o k.hdf --rule volume-average");
    EXPECT_EQ(material("k.hdf").youngs_modulus_pa, material("m.hdf").youngs_modulus_pa);
    EXPECT_TRUE(material("k.hdf").bin_of_tetrahedron.empty());
}

TEST_F(Method_cli, Bad_usage_exits_with_2) {
    must_run("material mesh.hdf -o m.hdf --scenario 1");
    must_fail(2, "Exactly 1", "material mesh.hdf");
    must_fail(2, "Exactly 1", "material mesh.hdf --uniform 1 --scenario 1");
    must_fail(2, "scenario", "material mesh.hdf --scenario 10");
    must_fail(2, "not positive", "material mesh.hdf --uniform 0");
    must_fail(2, "not positive", "material mesh.hdf --uniform nan");
    must_fail(2, "incompressible", "material mesh.hdf --uniform 1 --poissons-ratio 0.5");
    must_fail(2, "not positive", "material mesh.hdf --uniform 1 --total-mass -1");
    must_fail(2, "excludes", "material mesh.hdf --uniform 1 --total-mass 1 --density 1");
    must_fail(2, "NAME=E,NU,DENSITY", "material mesh.hdf --region fat=1");
    must_fail(2, "of no use", "material mesh.hdf --from-mesh --poissons-ratio 0.3");
    must_fail(2, "cannot be read", "material mesh.hdf --expression '2*('");
    must_fail(2, "bins", "cluster m.hdf --bins 0");
    must_fail(2, "clusters", "cluster m.hdf --clusters 0");
    must_fail(2, "clusters", "cluster m.hdf --clusters -1");
    must_fail(2, "restarts", "cluster m.hdf --restarts 0");
    must_fail(2, "binning", "cluster m.hdf --binning thirds");
    must_fail(2, "order", "aggregate m.hdf --order random");
    must_fail(2, "interest", "aggregate m.hdf --interest none");
    must_fail(2, "direction-weight", "aggregate m.hdf --direction-weight -1");
    must_fail(2, "rule", "coarsen m.hdf mesh.hdf overlap.hdf --rule best");
    must_fail(2, "required", "coarsen m.hdf mesh.hdf");
}

TEST_F(Method_cli, Bad_input_exits_with_3_and_names_the_place) {
    must_run("material mesh.hdf -o m.hdf --scenario 1");
    write("short.csv", "1\n2\n3\n");
    write("words.csv", "1\ntwo\n");
    must_fail(3, "none.hdf", "material none.hdf --uniform 1");
    must_fail(3, "3 rows for 384 tetrahedra", "material mesh.hdf --csv short.csv");
    must_fail(3, "words.csv: line 2: \"two\"", "material mesh.hdf --csv words.csv");
    must_fail(3, "none.csv", "material mesh.hdf --csv none.csv");
    must_fail(3, "did you mean \"fat\"", "material mesh.hdf --region fatt=1,0.3,1 --region lean=1,0.3,1");
    must_fail(3, "1 of 2 regions have no values: lean", "material mesh.hdf --region fat=1,0.3,1");
    must_fail(3, "did you mean \"poissons_ratio\"", "material mesh.hdf --array poisson_ratio");
    must_fail(3, "mesh.hdf: 384 of 384 values of Young's modulus", "material mesh.hdf --expression '0*x'");
    must_fail(3, "mesh.hdf", "cluster mesh.hdf");
    must_fail(3, "m.hdf", "aggregate m.hdf");
    must_fail(3, "m.hdf", "coarsen m.hdf mesh.hdf m.hdf");
    ASSERT_TRUE(write_tet_mesh(folder_ / "small.hdf", kuhn_cube(1), {}).ok());
    must_fail(3, "overlap.hdf: the overlap is of other meshes", "coarsen m.hdf small.hdf overlap.hdf");
}

TEST_F(Method_cli, A_missing_output_folder_exits_with_4) {
    EXPECT_EQ(run("material mesh.hdf --uniform 1 -o nowhere/m.hdf").code, 4);
    EXPECT_EQ(run("cluster mesh.hdf -o nowhere/m.hdf").code, 4);
    EXPECT_EQ(run("aggregate mesh.hdf -o nowhere/m.hdf").code, 4);
    EXPECT_EQ(run("coarsen mesh.hdf mesh.hdf overlap.hdf -o nowhere/m.hdf").code, 4);
}

}  // namespace
}  // namespace knead::test
