// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "knead/formats/read.h"
#include "unit/mesh/samples.h"

// The program as its users run it.
namespace knead {
namespace {

using namespace tools::test;
namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class MeshProgram : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "knead-test-mesh-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& content) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << content;
    }

    /// Runs knead-mesh in the test's folder. @return its exit code
    int run(const std::string& arguments) {
        const std::string command = "cd '" + folder_.string() + "' && '" KNEAD_BIN "/knead-mesh' " +
                                    arguments + " > stdout 2> stderr";
        const int status = std::system(command.c_str());
        stdout_ = read_text(folder_ / "stdout");
        stderr_ = read_text(folder_ / "stderr");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    [[nodiscard]] TetMesh result(const std::string& name = "out.hdf") const {
        auto mesh = read_tet_mesh(folder_ / name);
        EXPECT_TRUE(mesh.ok()) << mesh.error().text();
        return mesh.ok() ? std::move(mesh).value() : TetMesh{};
    }

    [[nodiscard]] bool exists(const std::string& name) const { return fs::exists(folder_ / name); }

    fs::path folder_;
    std::string stdout_;
    std::string stderr_;
};

TEST_F(MeshProgram, Makes_the_cubes_of_the_paper_with_the_same_bytes_each_time) {
    ASSERT_EQ(run("cubes --divisions 6 --size 0.1 -o out.hdf --report r.json --depfile d"), 0) << stderr_;
    EXPECT_EQ(result().tetrahedra.size(), 1296U);
    EXPECT_EQ(stdout_, "");
    EXPECT_NE(read_text(folder_ / "r.json").find("\"tetrahedra\": 1296"), std::string::npos);
    EXPECT_NE(read_text(folder_ / "d").find("out.hdf:"), std::string::npos);
    ASSERT_EQ(run("cubes --size 10cm 100mm 0.1 --divisions 6 6 6 -o again.hdf"), 0) << stderr_;
    EXPECT_EQ(read_text(folder_ / "out.hdf"), read_text(folder_ / "again.hdf"));
}

TEST_F(MeshProgram, Writes_what_it_did_into_the_provenance_but_no_path) {
    write("shape.msh", small_msh());
    ASSERT_EQ(run("import shape.msh --length-unit cm -o out.hdf"), 0) << stderr_;
    const auto header = read_header(folder_ / "out.hdf");
    ASSERT_TRUE(header.ok());
    EXPECT_EQ(header.value().provenance.arguments,
              (std::vector<std::string>{"import", "--length-unit", "cm"}));
    ASSERT_EQ(header.value().provenance.inputs.size(), 1U);
    EXPECT_EQ(header.value().provenance.inputs[0].first, "source");
    EXPECT_EQ(header.value().provenance.inputs[0].second.size(), 64U);
    EXPECT_EQ(result().nodes_m[1], (Point{0.01, 0, 0}));
    EXPECT_EQ(result().regions.names, (std::vector<std::string>{"physical_7"}));
}

TEST_F(MeshProgram, Never_runs_a_script_whatever_its_name) {
    const std::string script = "SystemCall \"touch " + (folder_ / "ran").string() + "\";\n";
    for (const char* extension :
         {".msh", ".stl", ".vtk", ".mesh", ".ply", ".step", ".brep", ".veg", ".geo", ".opt", ""}) {
        write(std::string("script") + extension, script);
        EXPECT_EQ(run(std::string("import script") + extension + " --length-unit mm -o out.hdf"), 3)
            << extension;
        EXPECT_NE(stderr_.find(std::string("script") + extension + ": "), std::string::npos) << stderr_;
    }
    for (const auto& [name, content] :
         std::vector<std::pair<std::string, std::string>>{{"a.msh", small_msh()},
                                                          {"a.mesh", small_medit()},
                                                          {"a.vtk", small_vtk()},
                                                          {"a.stl", cube_stl(0, 1)},
                                                          {"a.ply", cube_ply(0, 1)},
                                                          {"a.veg", small_veg()}}) {
        write(name, content + script);
        EXPECT_EQ(run("import " + name + " --length-unit m -o out.hdf"), 3) << name;
        write(name, script + content);
        EXPECT_EQ(run("import " + name + " --length-unit m -o out.hdf"), 3) << name;
    }
    EXPECT_FALSE(exists("ran"));
    EXPECT_FALSE(exists("out.hdf"));
}

TEST_F(MeshProgram, Does_not_run_the_option_file_that_gmsh_looks_for_beside_a_mesh) {
    write("a.msh", small_msh());
    write("a.msh.opt", "SystemCall \"touch " + (folder_ / "ran").string() + "\";\n");
    EXPECT_EQ(run("import a.msh --length-unit m -o out.hdf"), 0) << stderr_;
    EXPECT_FALSE(exists("ran"));
}

TEST_F(MeshProgram, Refuses_a_name_that_contradicts_the_content) {
    write("mesh.stl", small_msh());
    EXPECT_EQ(run("import mesh.stl --length-unit m -o out.hdf"), 3);
    EXPECT_NE(stderr_.find("holds a gmsh MSH file, but its name ends in .stl"), std::string::npos) << stderr_;
}

TEST_F(MeshProgram, Refuses_bad_input_with_exit_code_3_and_leaves_no_output) {
    EXPECT_EQ(run("import missing.msh --length-unit m -o out.hdf"), 3);
    EXPECT_NE(stderr_.find("missing.msh: no such file"), std::string::npos) << stderr_;
    write("hole.stl", cube_stl(0, 1, 1));
    EXPECT_EQ(run("import hole.stl --length-unit m -o out.hdf"), 3);
    EXPECT_NE(stderr_.find("hole"), std::string::npos) << stderr_;
    std::string inverted = small_medit();
    inverted.replace(inverted.find("2 3 4 5 20"), 10, "3 2 4 5 20");
    write("inverted.mesh", inverted);
    EXPECT_EQ(run("import inverted.mesh --length-unit m -o out.hdf"), 3);
    EXPECT_NE(stderr_.find("1 of 2 tetrahedra are inverted (2; numbered from 1)"), std::string::npos)
        << stderr_;
    EXPECT_FALSE(exists("out.hdf"));
    EXPECT_EQ(run("import inverted.mesh --length-unit m --repair-orientation -o out.hdf"), 0);
    EXPECT_NE(stderr_.find("orientation repaired"), std::string::npos) << stderr_;
}

TEST_F(MeshProgram, Refuses_bad_usage_with_exit_code_2) {
    write("a.msh", small_msh());
    for (const char* arguments :
         {"", "cubes", "cubes --divisions 0 --size 1 -o out.hdf", "cubes --divisions 1 2 --size 1 -o out.hdf",
          "cubes --divisions 2 --size 1 -1 1 -o out.hdf", "cubes --divisions 2 --size 4parsec -o out.hdf",
          "cubes --divisions 2 --size 1", "sphere --radius 0 -o out.hdf", "sphere -o out.hdf",
          "box --size 1 --target-tetrahedra 10 --edge-length 1 -o out.hdf",
          "box --size 1 --target-tetrahedra 0 -o out.hdf", "box --size 1 --edge-length 0 -o out.hdf",
          "import a.msh -o out.hdf", "import a.msh --length-unit mile -o out.hdf",
          "import a.msh --length-unit m --edge-length 1 -o out.hdf", "cube --size 1"})
        EXPECT_EQ(run(arguments), 2) << arguments << "\n" << stderr_;
    EXPECT_FALSE(exists("out.hdf"));
}

TEST_F(MeshProgram, Refuses_an_output_whose_folder_is_missing_with_exit_code_4) {
    EXPECT_EQ(run("cubes --divisions 1 --size 1 -o no/such/out.hdf"), 4) << stderr_;
}

TEST_F(MeshProgram, Warns_of_millimetres_called_metres) {
    std::string large = small_msh();
    large.replace(large.find("2 1 0 0"), 7, "2 150 0 0");
    write("a.msh", large);
    EXPECT_EQ(run("import a.msh --length-unit m -q -o out.hdf"), 0);
    EXPECT_NE(stderr_.find("warning: the mesh is 150 m across: this looks like millimetres"),
              std::string::npos)
        << stderr_;
    EXPECT_EQ(run("import a.msh --length-unit mm -q -o out.hdf"), 0);
    EXPECT_EQ(stderr_.find("millimetres"), std::string::npos) << stderr_;
}

TEST_F(MeshProgram, Reads_includes_of_a_veg_file_from_its_folder_only) {
    std::string text = small_veg();
    text.replace(text.find("*SET inner\n2\n"), 13, "*SET inner\n*INCLUDE lists/inner.txt\n");
    write("object/a.veg", text);
    write("object/lists/inner.txt", "2\n");
    EXPECT_EQ(run("import object/a.veg --length-unit m -o out.hdf --depfile d"), 0) << stderr_;
    EXPECT_NE(read_text(folder_ / "d").find("inner.txt"), std::string::npos);
    write("secret.txt", "2\n");
    fs::create_symlink(folder_ / "secret.txt", folder_ / "object" / "link.txt");
    for (const std::string& escape : {std::string("../secret.txt"), (folder_ / "secret.txt").string(),
                                      std::string("link.txt"), std::string("lists/../../secret.txt")}) {
        std::string escaping = text;
        escaping.replace(escaping.find("lists/inner.txt"), 15, escape);
        write("object/b.veg", escaping);
        EXPECT_EQ(run("import object/b.veg --length-unit m -o out2.hdf"), 3) << escape;
        EXPECT_NE(stderr_.find("outside of the folder"), std::string::npos) << stderr_;
    }
}

TEST_F(MeshProgram, Imports_the_turtle_with_its_regions_and_materials) {
    const char* given = std::getenv("KNEAD_TURTLE");
    const fs::path turtle = given != nullptr ? given
                                             : KNEAD_TEST_DATA
                                "/../../../shared/data/turtle/turtle-volumetric-heterogeneous.veg";
    if (!fs::exists(turtle))
        GTEST_SKIP() << "the turtle of VegaFEM is not here: set KNEAD_TURTLE to its .veg file";
    ASSERT_EQ(run("import '" + turtle.string() + "' --length-unit cm -o out.hdf"), 0) << stderr_;
    const TetMesh mesh = result();
    EXPECT_EQ(mesh.nodes_m.size(), 347U);
    EXPECT_EQ(mesh.tetrahedra.size(), 1185U);
    ASSERT_EQ(mesh.regions.names, (std::vector<std::string>{"backshell", "theRest"}));
    ASSERT_EQ(mesh.cell_arrays.size(), 3U);
    const auto& region = mesh.regions.region_of_tetrahedron;
    EXPECT_EQ(region[31], 0U);  // element 32 is the first of the shell's list
    EXPECT_EQ(region[0], 1U);
    for (std::size_t t = 0; t < region.size(); ++t) {
        EXPECT_EQ(mesh.cell_arrays[0].values[t], region[t] == 0 ? 25e6 : 25e4);
        EXPECT_EQ(mesh.cell_arrays[1].values[t], region[t] == 0 ? 0.45 : 0.35);
        EXPECT_EQ(mesh.cell_arrays[2].values[t], 1000);
    }
}

}  // namespace
}  // namespace knead
