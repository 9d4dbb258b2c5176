// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "knead/formats/write/write.h"
#include "support/kuhn_cube.h"

/// Small valid objects of every kind, and a folder that goes away with the test.
namespace knead::test {

class Folder {
  public:
    Folder() {
        static int counter = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("knead-formats-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
        std::filesystem::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::size_t entries() const {
        const auto range = std::filesystem::directory_iterator(path_);
        return static_cast<std::size_t>(std::distance(begin(range), end(range)));
    }

  private:
    std::filesystem::path path_;
};

inline std::vector<char> bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void put_bytes(const std::filesystem::path& file, const std::vector<char>& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline Provenance sample_provenance() {
    return {"knead-test", "0.1.0", {"--size=4", "--name=a b"}, 7, {{"fine", std::string(64, 'a')}}};
}

inline TetMesh sample_mesh(std::uint32_t n = 1) {
    TetMesh mesh = kuhn_cube(n);
    const std::size_t count = mesh.tetrahedra.size();
    mesh.regions.names = {"muscle", "fat \xc3\xa9"};
    for (std::size_t i = 0; i < count; ++i)
        mesh.regions.region_of_tetrahedron.push_back(static_cast<std::uint32_t>(i % 2));
    mesh.cell_arrays.push_back({"E in/kPa", std::vector<double>(count, 22.5)});
    return mesh;
}

inline MaterialObject sample_material(std::uint32_t n = 1) {
    MaterialObject object{sample_mesh(n), {}};
    for (std::size_t i = 0; i < object.mesh.tetrahedra.size(); ++i) {
        const auto bin = static_cast<std::uint32_t>(i % 2);
        object.material.youngs_modulus_pa.push_back(bin == 0 ? 2200 : 22000);
        object.material.poissons_ratio.push_back(0.3);
        object.material.density_kg_per_m3.push_back(1000);
        object.material.bin_of_tetrahedron.push_back(bin);
    }
    return object;
}

inline ClusteredObject sample_clustering(std::uint32_t n = 1) {
    const MaterialObject object = sample_material(n);
    Clustering c;
    c.bin_of_tetrahedron = object.material.bin_of_tetrahedron;
    c.cluster_of_tetrahedron = c.bin_of_tetrahedron;
    c.bin_youngs_modulus_pa = {2200, 22000};
    c.bin_poissons_ratio = {0.3, 0.3};
    c.bin_density_kg_per_m3 = {1000, 1000};
    c.bin_of_cluster = {0, 1};
    c.cluster_barycentre_m = {{0.05, 0.04, 0.05}, {0.05, 0.06, 0.05}};
    c.cluster_volume_m3 = {5e-4, 5e-4};
    return {object.mesh, object.material, c};
}

inline OverlapMatrix sample_overlap() {
    return {2, 3, {0, 1, 3}, {1, 0, 2}, {1e-9, 2e-9, 3e-9}};
}

inline Asset sample_asset(std::uint32_t n = 1) {
    const TetMesh mesh = kuhn_cube(n);
    Asset asset;
    asset.name = "cube";
    asset.level = "k1";
    asset.nodes_m = mesh.nodes_m;
    asset.tetrahedra = mesh.tetrahedra;
    asset.free_node_count = static_cast<std::uint32_t>(mesh.nodes_m.size());
    asset.palette = {{22000, 0.3, 1000}, {2200, 0.45, 900}};
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
        asset.palette_index.push_back(static_cast<std::uint32_t>(i % 2));
    ToolSet press;
    press.name = "press";
    press.half_extents_m = {0.06, 0.06};
    press.rest_position_m = {0.05, 0.05, 0.1};
    press.nodes = {0, 2, 5};
    ToolSet ball;
    ball.name = "ball";
    ball.shape = ToolShape::sphere;
    ball.contact = ToolContact::frictionless;
    ball.radius_m = 0.01;
    ball.rest_orientation_wxyz = {0, 1, 0, 0};
    ToolSet finger;
    finger.name = "finger";
    finger.shape = ToolShape::capsule;
    finger.contact = ToolContact::coulomb;
    finger.radius_m = 0.005;
    finger.half_length_m = 0.02;
    finger.friction_coefficient = 0.3;
    finger.nodes = {1, 4};
    asset.tools = {press, ball, finger};
    asset.gravity_m_per_s2 = {0, 0, -9.81};
    asset.damping_per_s = 2.5;
    asset.surface.triangles = {{0, 1, 3}, {0, 3, 2}};
    asset.embedding.tetrahedron = {0, 5, 3};
    asset.embedding.weights = {{1, 0, 0, 0}, {0.25F, 0.25F, 0.5F, 0}, {1.5F, -0.25F, -0.25F, 0}};
    asset.embedding.still_vertices_m = {{0.05, 0.05, -0.001}};
    asset.embedding.triangles = {{0, 1, 2}, {0, 2, 3}};
    asset.requests = {{"/knead/asset/tools/000000", "tool[0]", 12},
                      {"/knead/asset/gravity", "app.gravity", 30}};
    return asset;
}

}  // namespace knead::test
