// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/specimen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/bake.h"
#include "knead/formats/asset_object.h"
#include "stability/criteria.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

constexpr double kBallRadius = 0.4, kCapsuleRadius = 0.3, kCapsuleHalfLength = 0.3;  // over the side
constexpr double kFriction = 0.4;

/// Of the slowest elastic wave, in the softest matter.
double slowest_m_per_s(const Material& material) {
    double slowest = HUGE_VAL;
    for (std::size_t t = 0; t < material.youngs_modulus_pa.size(); ++t) {
        const double shear_pa = material.youngs_modulus_pa[t] / (2 * (1 + material.poissons_ratio[t]));
        slowest = std::min(slowest, std::sqrt(shear_pa / material.density_kg_per_m3[t]));
    }
    return slowest;
}

double extent_m(const std::vector<Point>& nodes_m) {
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const Point& node : nodes_m) {
            low = std::min(low, node[axis]);
            high = std::max(high, node[axis]);
        }
        extent = std::max(extent, high - low);
    }
    return extent;
}

/// Twice the circular frequency of the first shear mode of a block that stands on its lower side.
double critical_damping_per_s(const MaterialObject& object) {
    return M_PI * slowest_m_per_s(object.material) / extent_m(object.mesh.nodes_m);
}

}  // namespace

double Specimen::settle_s() const {
    return criteria::kRestTimes * size_m / shear_speed_m_per_s;
}

MaterialObject homogeneous(TetMesh mesh, const Matter& matter) {
    const std::size_t count = mesh.tetrahedra.size();
    MaterialObject object;
    object.mesh = std::move(mesh);
    object.material.youngs_modulus_pa.assign(count, matter.youngs_modulus_pa);
    object.material.poissons_ratio.assign(count, matter.poissons_ratio);
    object.material.density_kg_per_m3.assign(count, matter.density_kg_per_m3);
    return object;
}

Selection side_of_box(const char* side) {
    Selection selection;
    selection.side = side;
    selection.scene_key = side;
    return selection;
}

SceneTool bonded_plate() {
    SceneTool plate;
    plate.name = "plate";
    plate.touches = side_of_box("top");
    return plate;
}

SceneTool tool_above(ToolShape shape, ToolContact contact, double side_m) {
    SceneTool tool;
    tool.name = "tool";
    tool.shape = shape;
    tool.contact = contact;
    if (shape == ToolShape::sphere) tool.radius_m = kBallRadius * side_m;
    if (shape == ToolShape::capsule) {
        tool.radius_m = kCapsuleRadius * side_m;
        tool.half_length_m = kCapsuleHalfLength * side_m;
        tool.orientation_wxyz = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};  // it lies along y
    }
    if (contact == ToolContact::coulomb) tool.friction_coefficient = kFriction;
    tool.touches = side_of_box("top");
    return tool;
}

Specimen specimen_of(Asset asset) {
    Specimen specimen;
    MaterialObject object = object_of(asset);
    specimen.mesh = std::move(object.mesh);
    specimen.material = std::move(object.material);
    for (auto n = asset.free_node_count; n < asset.nodes_m.size(); ++n)
        specimen.held.nodes.push_back(n);
    specimen.held.displacement_m.assign(specimen.held.nodes.size(), Point{});
    specimen.size_m = extent_m(asset.nodes_m);
    specimen.shear_speed_m_per_s = slowest_m_per_s(specimen.material);
    specimen.asset = std::move(asset);
    return specimen;
}

Specimen make_specimen(const MaterialObject& object, const Setting& setting) {
    Scene scene;
    scene.file = "stability.toml";
    scene.name = "cell";
    if (setting.held_bottom) scene.held.push_back(side_of_box("bottom"));
    scene.tools = setting.tools;
    scene.gravity_m_per_s2 = setting.gravity_m_per_s2;
    if (setting.damped) scene.damping_per_s = critical_damping_per_s(object);
    scene.levels.emplace_back();
    scene.levels.back().name = "fine";
    return specimen_of(bake(scene, scene.levels.front(), object));
}

Specimen plain_cube(const Matter& matter, std::uint32_t cells, double side_m) {
    Setting setting;
    setting.tools = {bonded_plate()};
    return make_specimen(homogeneous(box_mesh({cells, cells, cells}, {side_m, side_m, side_m}), matter),
                         setting);
}

}  // namespace knead::tools::stability
