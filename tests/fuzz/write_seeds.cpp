// SPDX-License-Identifier: Apache-2.0
// Writes the seed corpora of the fuzz targets, OUTPUT/<target>/*: small valid files of our own writers, of
// the samples of the unit tests, and the examples.
//   fuzz_write_seeds SOURCE OUTPUT
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "unit/formats/samples.h"
#include "unit/formats/session_sample.h"
#include "unit/mesh/samples.h"

namespace knead::fuzz {
namespace {

namespace fs = std::filesystem;

class Corpora {
  public:
    Corpora(fs::path source, fs::path output) : source_(std::move(source)), output_(std::move(output)) {}

    fs::path file(const std::string& target, const std::string& name) const {
        fs::create_directories(output_ / target);
        return output_ / target / name;
    }
    void text(const std::string& target, const std::string& name, const std::string& content) const {
        std::ofstream(file(target, name), std::ios::binary) << content;
    }
    void copy(const std::string& target, const std::string& from) const {
        fs::copy_file(source_ / from, file(target, fs::path(from).filename().string()),
                      fs::copy_options::overwrite_existing);
    }

  private:
    fs::path source_, output_;
};

void require(const Status& status) {
    if (!status.ok()) throw std::runtime_error(status.error().text());
}

void write_hdf(const Corpora& seeds) {
    const Provenance made = test::sample_provenance();
    require(write_asset(seeds.file("asset", "one.hdf"), test::sample_asset(), made));
    require(write_asset(seeds.file("asset", "chunks.hdf"), test::sample_asset(4), made));
    require(write_session_log(seeds.file("session", "two_rates.hdf"), test::sample_session(), made));
    SessionLog one_rate = test::sample_session();
    one_rate.steps = {};
    one_rate.ticks.used_step.assign(one_rate.ticks.number.size(), 0);
    require(write_session_log(seeds.file("session", "one_rate.hdf"), one_rate, made));
    require(write_tet_mesh(seeds.file("stage", "mesh.hdf"), test::sample_mesh(), made));
    require(write_material(seeds.file("stage", "material.hdf"), test::sample_material(), made));
    require(write_clustering(seeds.file("stage", "clusters.hdf"), test::sample_clustering(), made));
    require(write_clustering(seeds.file("stage", "chunks.hdf"), test::sample_clustering(3), made));
    require(write_overlap(seeds.file("stage", "overlap.hdf"), test::sample_overlap(), made));
    require(write_asset(seeds.file("stage", "asset.hdf"), test::sample_asset(), made));
    require(write_session_log(seeds.file("stage", "session.hdf"), test::sample_session(), made));
    // payload: a kind, then changes of four bytes or more; the mutants do the rest.
    for (char kind = 0; kind < 6; ++kind)
        seeds.text("payload", "kind_" + std::to_string(kind),
                   std::string{kind, 1, 0, 3, 0, 0, 0, 4, 2, 7, 9, 1, 0, 5, 3});
}

void write_toml(const Corpora& seeds) {
    for (int i = 1; i <= 9; ++i)
        seeds.copy("scene", "examples/cubes/scenario" + std::to_string(i) + ".toml");
    for (const char* scene : {"examples/steak/steak.toml", "examples/pipeline/lump.toml",
                              "tests/golden/files/scene.toml", "tests/data/touch/cube.toml"})
        seeds.copy("scene", scene);
    seeds.copy("devices", "runtime/data/devices.toml");
    const std::string number = " = { value = 3.5, source = \"assumed: by me\" }\n";
    seeds.text("devices", "small.toml",
               "[[device]]\nname = \"a\"\ntitle = \"A\"\nmax_force_n" + number + "max_stiffness_n_per_m" +
                   number + "workspace_radius_m" + number + "position_resolution_m" + number +
                   "apparent_mass_kg" + number + "friction_n" + number + "damping_n_s_per_m" + number);
}

void write_meshes(const Corpora& seeds) {
    using namespace tools::test;
    seeds.text("veg", "small.veg", small_veg());
    seeds.text("veg", "include.veg", small_veg() + "*INCLUDE more\n");
    seeds.text("medit", "small.mesh", small_medit());
    seeds.text("vtk", "small.vtk", small_vtk());
    seeds.text(
        "vtk", "version5.vtk",
        "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 "
        "0 0 0 1\nMETADATA\nINFORMATION 0\n\nCELLS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY "
        "vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\nFIELD f 1\nE 1 1 double\n5\n");
    seeds.text(
        "vtk", "binary.vtk",
        std::string("# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n") +
            std::string(12, '\0') + "\nCELLS 1 2\n" + std::string("\0\0\0\1\0\0\0\0", 8) +
            "\nCELL_TYPES 1\n" + std::string("\0\0\0\1", 4) + "\n");
    seeds.text("stl", "cube.stl", cube_stl(0, 1));
    seeds.text("stl", "nested.stl", cube_stl(0, 3) + cube_stl(1, 2));
    seeds.text("stl", "binary.stl", cube_stl_binary(0, 1));
    seeds.text("ply", "cube.ply", cube_ply(0, 1));
    seeds.text("ply", "little.ply", cube_ply_binary(0, 1, false));
    seeds.text("ply", "big.ply", cube_ply_binary(0, 1, true));
    seeds.copy("outline", "tests/data/mesh/steak_outline.csv");
    seeds.copy("outline", "examples/steak/outline.csv");
    for (const char* file : {"two_boxes_v1.msh", "two_boxes_v2.2.msh", "two_boxes_v2.2b.msh",
                             "two_boxes_v4.1.msh", "two_boxes_v4.1b.msh", "box_mm.brep"})
        seeds.copy("sniff", std::string("tests/data/mesh/") + file);
    seeds.text("sniff", "small.msh", small_msh());
    seeds.text("sniff", "small.veg", small_veg());
    seeds.text("sniff", "small.mesh", small_medit());
    seeds.text("sniff", "small.vtk", small_vtk());
    seeds.text("sniff", "cube.stl", cube_stl(0, 1));
    seeds.text("sniff", "binary.stl", cube_stl_binary(0, 1));
    seeds.text("sniff", "cube.ply", cube_ply(0, 1));
    seeds.text("sniff", "a.step", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
    seeds.text("sniff", "script.geo", "Point(1) = {0, 0, 0};\nSystemCall \"id\";\n");
}

void write_tables(const Corpora& seeds) {
    seeds.text("csv", "one.csv", "E\n1000\n2e3\n+5\n");
    seeds.text("csv", "three.csv",
               "\xEF\xBB\xBF"
               "1000,0.3,1000\r\n2000, 0.45 ,900\r\n");
    seeds.text("csv", "regions.csv", "region,E,nu,density\nfat,1000,0.3,900\n\"a,b\",2,0.4,1\n");
    seeds.text("cache", "cell",
               R"({"converged":true,"applicable":true,"fitted":false,"problem":"","tets":48,"force_n":1.5,)"
               R"("reference_force_n":1.25,"displacement_error":0.1,"runtime_force_n":null})");
    seeds.text("cache", "times",
               R"({"load_ms":1.5,"asset_bytes":1000,"step":{"p50":1,"p99":2,"p999":3,"max":4,"steps":5,)"
               R"("not_ok":0}})");
    seeds.text("cache", "speed",
               R"({"runtime":{"p50":1,"p99":2,"p999":3,"max":4,"steps":5,"not_ok":0},)"
               R"("baseline":{"p50":1,"p99":2,"p999":3,"max":4,"steps":5,"not_ok":0}})");
    seeds.text("cache", "curve", R"({"time_s":[0,0.001],"force_n":[0,-1.5]})");
    std::string answer;
    for (const double value : {1.0, 2.5, 3.0, 1.0, 0.1, 0.2, 0.3})
        answer.append(reinterpret_cast<const char*>(&value), sizeof value);
    seeds.text("cache", "answer", answer + "why not");
    seeds.text("build_state", "state",
               R"({"schema":"knead-build/1","stages":{"a.mesh.hdf":{"command":"00","output":"11",)"
               R"("dependencies":[["a.toml","22"],["b","33"]]}}})");
    seeds.text("build_state", "depfile", "out\\ put.hdf: \\\n  in.hdf \\\n  a\\#b$$.csv\n");
}

}  // namespace
}  // namespace knead::fuzz

int main(int argc, char** argv) {
    using namespace knead::fuzz;
    if (argc != 3) {
        std::cerr << "Usage: fuzz_write_seeds SOURCE OUTPUT\n";
        return 2;
    }
    try {
        const Corpora seeds(argv[1], argv[2]);
        write_hdf(seeds);
        write_toml(seeds);
        write_meshes(seeds);
        write_tables(seeds);
    } catch (const std::exception& error) {
        std::cerr << "fuzz_write_seeds: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
