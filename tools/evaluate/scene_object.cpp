// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/scene_object.h"

#include <array>
#include <map>
#include <utility>

#include "common/error.h"
#include "common/length.h"
#include "material/csv.h"
#include "material/request.h"
#include "mesh/geometry.h"
#include "mesh/gmsh_primitives.h"
#include "mesh/import.h"
#include "mesh/outline.h"

namespace knead::tools {
namespace {

/// Puts the file's name in front of what is complained about.
template <class Call>
auto naming(const std::filesystem::path& file, const Call& call) {
    try {
        return call();
    } catch (const ToolError& error) {
        throw ToolError(error.code(), file.string() + ": " + error.what());
    }
}

template <class T>
std::array<T, 3> three(const std::vector<T>& values) {
    if (values.size() == 1) return {values[0], values[0], values[0]};
    return {values.at(0), values.at(1), values.at(2)};
}

MeshSize size_of(const MeshSource& source) {
    MeshSize size;
    if (source.target_tetrahedra > 0) size.target_tetrahedra = source.target_tetrahedra;
    if (source.edge_length_m > 0) size.edge_length_m = source.edge_length_m;
    return size;
}

OutlineSlab slab_of(const MeshSource& source, const FileReader& read) {
    OutlineSlab slab;
    slab.corners_m = naming(source.file, [&] { return read_outline(read(source.file)); });
    const double unit = source.length_unit.empty() ? 1.0 : metres_per_unit(source.length_unit);
    for (auto& corner : slab.corners_m)
        for (double& x : corner)
            x *= unit;
    slab.thickness_m = source.thickness_m;
    slab.round_m = source.round_m;
    slab.polygon = source.polygon;
    return slab;
}

TetMesh import_file(const MeshSource& source, const FileReader& read) {
    ImportRequest request;
    request.extension = source.file.extension().string();
    if (!source.length_unit.empty()) request.metres_per_unit = metres_per_unit(source.length_unit);
    request.size = size_of(source);
    request.merge_duplicate_nodes = source.merge_duplicate_nodes;
    request.repair_orientation = source.repair_orientation;
    request.include = [&](const std::string& name) { return read(source.file.parent_path() / name); };
    return naming(source.file, [&] { return import_mesh(read(source.file), request).mesh; });
}

}  // namespace

TetMesh make_mesh(const MeshSource& source, const FileReader& read) {
    const MeshSize size = size_of(source);
    if (source.kind == "cubes") return make_cubes(three(source.divisions), three(source.size_m));
    if (source.kind == "box") return finish(mesh_box(three(source.size_m), size), "a box").mesh;
    if (source.kind == "sphere") return finish(mesh_sphere(source.radius_m, size), "a sphere").mesh;
    if (source.kind == "cylinder")
        return finish(mesh_cylinder(source.radius_m, source.height_m, size), "a cylinder").mesh;
    if (source.kind == "ellipsoid")
        return finish(mesh_ellipsoid(three(source.size_m), size), "an ellipsoid").mesh;
    if (source.kind == "outline") return finish(mesh_outline(slab_of(source, read), size), "an outline").mesh;
    return import_file(source, read);
}

Material make_scene_material(const Scene& scene, const TetMesh& mesh, std::uint64_t seed,
                             const FileReader& read) {
    const MaterialSource& source = scene.material;
    MaterialRequest request;
    request.uniform_pa = source.uniform_pa;
    if (source.scenario) request.scenario = static_cast<int>(*source.scenario);
    request.expression = source.expression_pa;
    request.from_mesh = source.from_mesh;
    if (!source.csv.empty())
        request.table = naming(source.csv, [&] { return parse_value_csv(read(source.csv)); });
    if (!source.regions.empty()) request.regions.emplace();
    for (const auto& [name, region] : source.regions)
        request.regions->push_back(
            {name, region.youngs_modulus_pa, region.poissons_ratio, region.density_kg_per_m3});
    request.seed = seed;
    request.poissons_ratio = source.poissons_ratio;
    request.density_kg_per_m3 = source.density_kg_per_m3;
    request.total_mass_kg = source.total_mass_kg;
    return naming(scene.file, [&] { return make_material(mesh, request).material; });
}

namespace {

/// Nodes of a mesh and the middles of its edges, each made once.
class Middles {
  public:
    explicit Middles(std::vector<Point>& nodes_m) : nodes_m_(nodes_m) {}
    std::uint32_t of(std::uint32_t a, std::uint32_t b) {
        const auto key = std::minmax(a, b);
        const auto [at, is_new] = known_.try_emplace(key, static_cast<std::uint32_t>(nodes_m_.size()));
        if (is_new) {
            Point middle;
            for (std::size_t axis = 0; axis < 3; ++axis)
                middle[axis] = (nodes_m_[a][axis] + nodes_m_[b][axis]) / 2;
            nodes_m_.push_back(middle);
        }
        return at->second;
    }

  private:
    std::vector<Point>& nodes_m_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known_;
};

double squared_distance(const Point& a, const Point& b) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    return sum;
}

/// The octahedron that is left between the corners, along its shortest diagonal.
void cut_octahedron(const std::array<std::array<std::uint32_t, 2>, 3>& opposite, const TetMesh& mesh,
                    std::vector<Tetrahedron>& children) {
    constexpr double kEqual = 1e-9;
    std::size_t shortest = 0;
    const auto length = [&](std::size_t k) {
        return squared_distance(mesh.nodes_m[opposite[k][0]], mesh.nodes_m[opposite[k][1]]);
    };
    for (std::size_t k = 1; k < 3; ++k)
        if (length(k) < length(shortest) * (1 - kEqual)) shortest = k;
    const auto& axis = opposite[shortest];
    const auto& p = opposite[(shortest + 1) % 3];
    const auto& q = opposite[(shortest + 2) % 3];
    const std::array<std::uint32_t, 4> ring{p[0], q[0], p[1], q[1]};
    for (std::size_t k = 0; k < 4; ++k)
        children.push_back({axis[0], axis[1], ring[k], ring[(k + 1) % 4]});
}

}  // namespace

MaterialObject split_in_eight(const MaterialObject& object) {
    MaterialObject fine;
    fine.mesh.nodes_m = object.mesh.nodes_m;
    Middles middles(fine.mesh.nodes_m);
    std::vector<Tetrahedron>& children = fine.mesh.tetrahedra;
    for (const Tetrahedron& t : object.mesh.tetrahedra) {
        const auto m01 = middles.of(t[0], t[1]), m02 = middles.of(t[0], t[2]), m03 = middles.of(t[0], t[3]);
        const auto m12 = middles.of(t[1], t[2]), m13 = middles.of(t[1], t[3]), m23 = middles.of(t[2], t[3]);
        children.push_back({t[0], m01, m02, m03});
        children.push_back({m01, t[1], m12, m13});
        children.push_back({m02, m12, t[2], m23});
        children.push_back({m03, m13, m23, t[3]});
        cut_octahedron({{{m01, m23}, {m02, m13}, {m03, m12}}}, fine.mesh, children);
    }
    for (Tetrahedron& child : children)
        if (signed_volume_m3(fine.mesh.nodes_m[child[0]], fine.mesh.nodes_m[child[1]],
                             fine.mesh.nodes_m[child[2]], fine.mesh.nodes_m[child[3]]) < 0)
            std::swap(child[2], child[3]);
    const Material& coarse = object.material;
    Material& material = fine.material;
    for (std::size_t child = 0; child < children.size(); ++child) {
        material.youngs_modulus_pa.push_back(coarse.youngs_modulus_pa[child / 8]);
        material.poissons_ratio.push_back(coarse.poissons_ratio[child / 8]);
        material.density_kg_per_m3.push_back(coarse.density_kg_per_m3[child / 8]);
    }
    return fine;
}

}  // namespace knead::tools
