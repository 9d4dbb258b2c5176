// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.h"
#include "stability/cells.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

TetMesh cube_mesh(std::uint32_t cells = kCells) {
    return box_mesh({cells, cells, cells}, {kSide_m, kSide_m, kSide_m});
}

Setting pressed_by(const SceneTool& tool, bool held = true) {
    Setting setting;
    setting.tools = {tool};
    setting.held_bottom = held;
    return setting;
}

// ---- What must be refused -------------------------------------------------------------------------------

Cell refused_when_baked(const std::string& name, const std::function<void()>& bake) {
    return {"object", name, [=](const StabilityRequest&, CellResult& result) {
                std::string message;
                try {
                    bake();
                } catch (const ToolError& error) {
                    message = error.what();
                }
                result.checks.push_back(must_be("refused", !message.empty(), "it was taken"));
                if (!message.empty()) result.checks.back().note = message;
            }};
}

Cell refused_when_loaded(const std::string& name, const std::function<void(Asset&)>& spoil) {
    return {"object", name, [=](const StabilityRequest&, CellResult& result) {
                Asset asset = plain_cube().asset;
                spoil(asset);
                const Result<Simulation> created = Simulation::create(asset);
                result.checks.push_back(must_be("refused", !created.ok(), "it was taken"));
                if (!created.ok()) result.checks.back().note = created.error().text();
            }};
}

void add_refused(Cells& cells) {
    cells.push_back(refused_when_baked("every node held", [] {
        TetMesh sheet = box_mesh({2, 2, 1}, {kSide_m, kSide_m, kSide_m});
        for (Point& node : sheet.nodes_m)
            node[2] *= 1e-9;  // all of it lies in the lowest side
        (void)make_specimen(homogeneous(std::move(sheet)), pressed_by(bonded_plate()));
    }));
    cells.push_back(refused_when_loaded("no free node", [](Asset& asset) { asset.free_node_count = 0; }));
    cells.push_back(refused_when_loaded("all tetrahedra inside out at rest", [](Asset& asset) {
        for (Tetrahedron& t : asset.tetrahedra)
            std::swap(t[0], t[1]);
    }));
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInf = std::numeric_limits<double>::infinity();
    cells.push_back(refused_when_loaded("a node at NaN", [=](Asset& asset) { asset.nodes_m[3][1] = kNan; }));
    cells.push_back(
        refused_when_loaded("a node at infinity", [=](Asset& asset) { asset.nodes_m[3][1] = kInf; }));
    cells.push_back(
        refused_when_loaded("E NaN", [=](Asset& asset) { asset.palette[0].youngs_modulus_pa = kNan; }));
    cells.push_back(
        refused_when_loaded("E zero", [](Asset& asset) { asset.palette[0].youngs_modulus_pa = 0; }));
    cells.push_back(
        refused_when_loaded("nu 0.5", [](Asset& asset) { asset.palette[0].poissons_ratio = 0.5; }));
    cells.push_back(refused_when_loaded("density infinite",
                                        [=](Asset& asset) { asset.palette[0].density_kg_per_m3 = kInf; }));
    cells.push_back(refused_when_loaded("a tetrahedron without volume", [](Asset& asset) {
        asset.tetrahedra[0][3] = asset.tetrahedra[0][0];
    }));
}

// ---- Small and strange ones -----------------------------------------------------------------------------

/// Two tetrahedra that share `shared` nodes, the first one standing on three nodes.
TetMesh two_tetrahedra(int shared) {
    TetMesh mesh;
    const double s = kSide_m;
    mesh.nodes_m = {{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0.3 * s, 0.3 * s, s}};
    mesh.tetrahedra = {{0, 1, 2, 3}};
    if (shared == 0) return mesh;
    if (shared == 1) {  // hangs on the top
        mesh.nodes_m.insert(mesh.nodes_m.end(), {{s, 0.3 * s, 1.5 * s}, {0, s, 1.6 * s}, {0, 0, 2 * s}});
        mesh.tetrahedra.push_back({3, 4, 5, 6});
    } else {  // hinged on an upper edge
        mesh.nodes_m.insert(mesh.nodes_m.end(), {{-s, 0, 1.2 * s}, {-s, s, 1.5 * s}});
        mesh.tetrahedra.push_back({0, 3, 4, 5});
    }
    for (Tetrahedron& t : mesh.tetrahedra)
        if (signed_volume_m3(mesh.nodes_m[t[0]], mesh.nodes_m[t[1]], mesh.nodes_m[t[2]], mesh.nodes_m[t[3]]) <
            0)
            std::swap(t[2], t[3]);
    return mesh;
}

Cell small_cell(const std::string& name, const TetMesh& mesh, ToolContact contact, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    const bool bonded = contact == ToolContact::bonded;
    cell.press.leaves = !bonded;
    cell.demands.contact_law = !bonded;
    cell.specimen = [=] {
        const SceneTool tool = bonded ? bonded_plate() : tool_above(ToolShape::plate, contact);
        return make_specimen(homogeneous(mesh), pressed_by(tool));
    };
    return press_cell("object",
                      fmt::format("{}, {}, dt {} ms", name, bonded ? "bonded" : "frictionless", 1e3 * dt_s),
                      cell);
}

/// Nothing but nodes that are held or bonded.
Cell nothing_to_solve() {
    PressCell cell;
    cell.demands.forces = false;  // the reference wants something to solve
    cell.demands.force_at_rest = false;
    cell.specimen = [] { return plain_cube({}, 1); };
    cell.demands.about = "recovery";
    return press_cell("object", "every free node bonded to the tool", cell);
}

// ---- Two parts ------------------------------------------------------------------------------------------

/// Only the first part is under the plate; the second must not feel it.
Cell two_parts(bool second_is_held) {
    PressCell cell;
    cell.demands.about = "untouched_part";
    const double lift_m = second_is_held ? 0.0 : 0.5 * kSide_m;
    cell.specimen = [=] {
        SceneTool plate = bonded_plate();
        plate.touches.side.clear();
        plate.touches.box_m = std::array<Point, 2>{Point{0, 0, kSide_m * (1 - 1e-9)},
                                                   Point{kSide_m, kSide_m, kSide_m * (1 + 1e-9)}};
        return make_specimen(homogeneous(side_by_side(cube_mesh(), cube_mesh(2), {2 * kSide_m, 0, lift_m})),
                             pressed_by(plate));
    };
    cell.also = [](const Specimen& specimen, const Record&, CellResult& result) {
        Simulation simulation = simulation_of(specimen, config_for(specimen, 1e-3));
        double farthest_m = 0;
        for (int k = 1; k <= 300; ++k) {
            Pose pose = simulation.tool_rest_pose();
            pose.position_m[2] -= 0.1 * kSide_m * std::min(1.0, k / 100.0);
            (void)simulation.step(pose, 1e-3);
        }
        for (std::size_t n = 0; n < simulation.node_count(); ++n)
            if (specimen.asset.nodes_m[n][0] > 1.5 * kSide_m)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    farthest_m = std::max(farthest_m, std::abs(simulation.positions_m()[3 * n + axis] -
                                                               specimen.asset.nodes_m[n][axis]));
        // Rounding of a double sum of a rest position and a displacement.
        Check check = at_most("untouched_part", farthest_m, 1e-15, "m moved");
        result.checks.insert(result.checks.begin(), check);
    };
    return press_cell("object", second_is_held ? "two parts, both held" : "two parts, one afloat", cell);
}

// ---- Inside out -----------------------------------------------------------------------------------------

std::size_t inverted(const Specimen& specimen, const double* x) {
    std::size_t count = 0;
    for (const Tetrahedron& t : specimen.mesh.tetrahedra) {
        std::array<Point, 4> p{};
        for (std::size_t k = 0; k < 4; ++k)
            std::copy_n(x + std::size_t{3} * t[k], 3, p[k].data());
        count += signed_volume_m3(p[0], p[1], p[2], p[3]) < 0 ? 1 : 0;
    }
    return count;
}

/// The first step mirrors the object: the plate is as far below the held side as it was above.
Cell mirrored_cell(std::uint32_t across, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, -2 * kSide_m};
    cell.press.ramp_s = 0.5 * dt_s;
    cell.demands.about = "recovery";
    cell.specimen = [=] { return plain_cube({}, across); };
    cell.also = [=](const Specimen& specimen, const Record&, CellResult& result) {
        Simulation simulation = simulation_of(specimen, config_for(specimen, dt_s));
        Pose pose = simulation.tool_rest_pose();
        pose.position_m[2] -= 2 * kSide_m;
        std::size_t most = 0;
        for (int k = 0; k < 200; ++k) {
            (void)simulation.step(pose, dt_s);
            most = std::max(most, inverted(specimen, simulation.positions_m()));
        }
        const double share = static_cast<double>(most) / static_cast<double>(specimen.mesh.tetrahedra.size());
        Check check = must_be("inside_out", share > 0.5, "fewer than half of the tetrahedra were inside out");
        check.note = fmt::format("{:.0f} % of the tetrahedra were", 100 * share);
        result.checks.push_back(check);
    };
    return press_cell("object",
                      fmt::format("mirrored in one step, {} tetrahedra, dt {} ms",
                                  6 * across * across * across, 1e3 * dt_s),
                      cell);
}

}  // namespace

void add_odd_object_cells(Cells& cells) {
    add_refused(cells);
    cells.push_back(small_cell("one tetrahedron", two_tetrahedra(0), ToolContact::bonded, 1e-3));
    cells.push_back(small_cell("one tetrahedron", two_tetrahedra(0), ToolContact::frictionless, 1e-3));
    cells.push_back(
        small_cell("two tetrahedra with one node in common", two_tetrahedra(1), ToolContact::bonded, 1e-3));
    cells.push_back(
        small_cell("two tetrahedra with an edge in common", two_tetrahedra(2), ToolContact::bonded, 1e-3));
    cells.push_back(nothing_to_solve());
    cells.push_back(two_parts(true));
    cells.push_back(two_parts(false));
    cells.push_back(mirrored_cell(2, 1e-3));
    cells.push_back(mirrored_cell(4, 1e-3));
    cells.push_back(mirrored_cell(4, 10e-3));
}

}  // namespace knead::tools::stability
