// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>

#include "common/error.h"
#include "common/length.h"
#include "knead/formats/tool_names.h"
#include "scene/toml_table.h"

namespace knead::tools {
namespace {

const std::vector<std::string> kLengthUnits{"m", "dm", "cm", "mm", "um", "in", "ft"};
constexpr double kUnitQuaternionTolerance = 1e-6;  // a hand-typed quaternion has six digits or more

/// Names become parts of file names.
std::string required_name(TomlTable& table, std::string_view key) {
    const auto name = table.text(key);
    if (!name) table.fail_missing(key);
    const bool plain = !name->empty() && std::all_of(name->begin(), name->end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
    });
    if (!plain) table.fail(key, "must be made of letters, digits, '-' and '_'");
    return *name;
}

double positive(TomlTable& table, std::string_view key, std::optional<double> value) {
    if (value && !(*value > 0)) table.fail(key, "must be positive");
    return value.value_or(0);
}

void all_positive(const TomlTable& table, std::string_view key, const std::vector<double>& values) {
    if (std::any_of(values.begin(), values.end(), [](double v) { return !(v > 0); }))
        table.fail(key, "must be positive");
}

std::filesystem::path path_beside(const Scene& scene, const std::optional<std::string>& name) {
    if (!name) return {};
    return scene.file.parent_path() / *name;
}

std::vector<std::uint32_t> read_divisions(TomlTable& table) {
    std::vector<std::uint32_t> divisions;
    for (const double value : table.numbers("divisions")) {
        if (value != std::floor(value) || value < 1 || value > 1000)
            table.fail("divisions", "must be whole numbers from 1 to 1000");
        divisions.push_back(static_cast<std::uint32_t>(value));
    }
    if (!divisions.empty() && divisions.size() != 1 && divisions.size() != 3)
        table.fail("divisions", "must be one number or three");
    return divisions;
}

void require(const TomlTable& table, bool given, const std::string& key, const std::string& kind) {
    if (!given) table.fail_missing(key, fmt::format("is required for kind = \"{}\"", kind));
}

void check_mesh_source(TomlTable& table, const MeshSource& mesh) {
    const std::string& kind = mesh.kind;
    if (kind == "cubes" || kind == "box") require(table, !mesh.size_m.empty(), "size", kind);
    if (kind == "cubes") require(table, !mesh.divisions.empty(), "divisions", kind);
    if (kind == "ellipsoid") require(table, mesh.size_m.size() == 3, "radii", kind);
    if (kind == "sphere" || kind == "cylinder") require(table, mesh.radius_m > 0, "radius", kind);
    if (kind == "cylinder") require(table, mesh.height_m > 0, "height", kind);
    if (kind == "outline") {
        require(table, !mesh.file.empty(), "points", kind);
        require(table, mesh.thickness_m > 0, "thickness", kind);
    }
    if (kind == "file") require(table, !mesh.file.empty(), "file", kind);
    if (mesh.target_tetrahedra > 0 && mesh.edge_length_m > 0)
        table.fail("edge_length", "and target_tetrahedra exclude each other");
}

/// @param inherited the object's own mesh for a level's: a level says only what differs
MeshSource read_mesh_source(const Scene& scene, TomlTable table, const MeshSource* inherited) {
    MeshSource mesh;
    if (inherited != nullptr && !table.has("kind")) {
        mesh = *inherited;
        // A new resolution replaces the inherited one, however that was given.
        mesh.target_tetrahedra = 0;
        mesh.edge_length_m = 0;
    } else {
        const auto kind =
            table.choice("kind", {"cubes", "box", "sphere", "cylinder", "ellipsoid", "outline", "file"});
        if (!kind) table.fail_missing("kind");
        mesh.kind = *kind;
    }
    if (auto divisions = read_divisions(table); !divisions.empty()) mesh.divisions = std::move(divisions);
    for (const char* key : {"size", "radii"}) {
        if (auto size = table.lengths_m(key); !size.empty()) {
            if (size.size() != 1 && size.size() != 3) table.fail(key, "must be one length or three");
            all_positive(table, key, size);
            mesh.size_m = std::move(size);
        }
    }
    if (table.has("radius")) mesh.radius_m = positive(table, "radius", table.length_m("radius"));
    if (table.has("height")) mesh.height_m = positive(table, "height", table.length_m("height"));
    if (table.has("thickness")) mesh.thickness_m = positive(table, "thickness", table.length_m("thickness"));
    if (table.has("round")) mesh.round_m = positive(table, "round", table.length_m("round"));
    for (const auto& [key, target] : {std::pair{"polygon", &mesh.polygon},
                                      std::pair{"merge_duplicate_nodes", &mesh.merge_duplicate_nodes},
                                      std::pair{"repair_orientation", &mesh.repair_orientation}})
        if (table.has(key)) *target = *table.flag(key);
    for (const char* key : {"file", "points"})
        if (table.has(key)) mesh.file = path_beside(scene, table.text(key));
    if (table.has("length_unit")) mesh.length_unit = *table.choice("length_unit", kLengthUnits);
    if (table.has("target_tetrahedra")) {
        const auto target = table.count("target_tetrahedra");
        if (*target < 1 || *target > 100'000'000)
            table.fail("target_tetrahedra", "must be from 1 to 100,000,000");
        mesh.target_tetrahedra = static_cast<std::uint32_t>(*target);
    }
    if (table.has("edge_length"))
        mesh.edge_length_m = positive(table, "edge_length", table.length_m("edge_length"));
    check_mesh_source(table, mesh);
    table.finish();
    return mesh;
}

/// Refuses here, with the line, what knead-material would refuse later.
double physical_value(const TomlTable& table, std::string_view key, double value) {
    if (key == "poissons_ratio") {
        if (!(value > -1 && value < 0.5))
            table.fail(key, "must be greater than -1 and less than 0.5: at 0.5 a material is incompressible");
    } else if (!(value > 0)) {
        table.fail(key, "must be positive");
    }
    return value;
}

std::optional<double> optional_physical(TomlTable& table, std::string_view key) {
    const auto value = table.number(key);
    return value ? std::optional(physical_value(table, key, *value)) : std::nullopt;
}

RegionMaterial read_region(TomlTable table) {
    RegionMaterial region;
    const std::pair<const char*, double*> fields[] = {{"youngs_modulus_pa", &region.youngs_modulus_pa},
                                                      {"poissons_ratio", &region.poissons_ratio},
                                                      {"density_kg_per_m3", &region.density_kg_per_m3}};
    for (const auto& [key, target] : fields) {
        const auto value = table.number(key);
        if (!value) table.fail_missing(key);
        *target = physical_value(table, key, *value);
    }
    table.finish();
    return region;
}

MaterialSource read_material_source(const Scene& scene, TomlTable table) {
    MaterialSource material;
    material.uniform_pa = optional_physical(table, "uniform_pa");
    if (const auto scenario = table.count("scenario")) {
        if (*scenario < 1 || *scenario > 9) table.fail("scenario", "must be from 1 to 9");
        material.scenario = static_cast<std::uint32_t>(*scenario);
    }
    material.expression_pa = table.text("expression_pa");
    material.csv = path_beside(scene, table.text("csv"));
    material.from_mesh = table.flag("from_mesh").value_or(false);
    if (auto regions = table.table("regions")) {
        for (const std::string& name : regions->keys())
            material.regions[name] = read_region(*regions->table(name));
        if (material.regions.empty()) table.fail("regions", "is empty");
    }
    const int ways = int(material.uniform_pa.has_value()) + int(material.scenario.has_value()) +
                     int(material.expression_pa.has_value()) + int(!material.csv.empty()) +
                     int(material.from_mesh) + int(!material.regions.empty());
    if (ways != 1)
        table.fail("", "needs exactly one of uniform_pa, scenario, expression_pa, csv, from_mesh, regions");
    material.poissons_ratio = optional_physical(table, "poissons_ratio");
    material.density_kg_per_m3 = optional_physical(table, "density_kg_per_m3");
    material.total_mass_kg = optional_physical(table, "total_mass_kg");
    if (const auto seed = table.count("seed")) material.seed = *seed;
    table.finish();
    return material;
}

std::uint32_t required_count(TomlTable& table, std::string_view key) {
    const auto value = table.count(key);
    if (!value) table.fail_missing(key, "is required beside bins");
    if (*value < 1 || *value > 1'000'000) table.fail(key, "must be from 1 to 1,000,000");
    return static_cast<std::uint32_t>(*value);
}

Level read_level(const Scene& scene, TomlTable table) {
    Level level;
    level.line = table.line();
    level.name = required_name(table, "name");
    if (table.has("object")) {
        level.object = path_beside(scene, table.text("object"));
        for (const char* key : {"bins", "clusters", "binning", "restarts", "seed", "order", "interest",
                                "direction_weight", "rule", "mesh"})
            if (table.has(key)) table.fail(key, "says how to make what object = \"...\" brings ready made");
        table.finish();
        return level;
    }
    if (table.has("bins")) {
        level.bins = required_count(table, "bins");
        level.clusters = required_count(table, "clusters");
    } else if (table.has("clusters")) {
        table.fail("clusters", "needs bins beside it");
    }
    if (auto v = table.choice("binning", {"equal-width", "equal-population", "equal-width-log", "kmeans"}))
        level.binning = *v;
    if (table.has("restarts")) level.restarts = required_count(table, "restarts");
    if (auto v = table.count("seed")) level.seed = *v;
    if (auto v = table.choice("order", {"stiff-first", "soft-first"})) level.order = *v;
    if (auto v = table.choice("interest", {"combined", "distance", "direction", "membership", "mahalanobis"}))
        level.interest = *v;
    if (auto v = table.number("direction_weight")) level.direction_weight = *v;
    if (auto v = table.choice("rule", {"dominant", "volume-average"})) level.rule = *v;
    if (auto mesh = table.table("mesh")) level.mesh = read_mesh_source(scene, *mesh, &scene.mesh);
    table.finish();
    return level;
}

/// Reads the keys of a selection that stand in `table`; the caller finishes the table.
Selection read_selection(TomlTable& table, const std::string& scene_key) {
    Selection selection;
    selection.line = table.line();
    selection.scene_key = scene_key;
    if (auto side = table.choice("side", {"bottom", "top", "left", "right", "front", "back", "all"}))
        selection.side = *side;
    if (const toml::array* box = table.array("box")) {
        std::vector<Point> corners;
        if (box->size() == 2 && box->get(0)->is_array() && box->get(1)->is_array()) {
            for (std::size_t i = 0; i < 2; ++i) {
                toml::table corner;
                corner.insert("corner", *box->get(i)->as_array());
                corners.push_back(*TomlTable(corner, scene_key, "box").point_m("corner"));
            }
        }
        if (corners.size() != 2 || corners[0][0] > corners[1][0] || corners[0][1] > corners[1][1] ||
            corners[0][2] > corners[1][2])
            table.fail("box", "must be [[x, y, z], [x, y, z]]: the lower and the upper corner");
        selection.box_m = {corners[0], corners[1]};
    }
    if (auto centre = table.point_m("centre")) {
        const double radius = positive(table, "within", table.length_m("within"));
        if (radius == 0) table.fail("centre", "needs within = <distance> beside it");
        selection.ball_m = {*centre, radius};
    }
    if (selection.side.empty() && !selection.box_m && !selection.ball_m)
        table.fail("", "needs a side, a box, or a centre with a distance");
    return selection;
}

void read_shape(TomlTable& table, SceneTool& tool) {
    const auto shape = table.choice("shape", {kToolShapes.begin(), kToolShapes.end()});
    if (!shape) table.fail_missing("shape");
    const auto required_length = [&](const char* key) {
        const double length = positive(table, key, table.length_m(key));
        if (length == 0) table.fail_missing(key, fmt::format("is required for a {}", *shape));
        return length;
    };
    if (*shape != "plate") {
        tool.shape = *shape == "sphere" ? ToolShape::sphere : ToolShape::capsule;
        tool.radius_m = required_length("radius");
        if (tool.shape == ToolShape::capsule) tool.half_length_m = required_length("half_length");
        return;
    }
    if (const auto extents = table.lengths_m("half_extents"); !extents.empty()) {
        if (extents.size() != 2) table.fail("half_extents", "must be two lengths");
        all_positive(table, "half_extents", extents);
        tool.half_extents_m = {extents[0], extents[1]};
    }
}

void read_contact(TomlTable& table, SceneTool& tool) {
    const std::vector<std::string> contacts(kToolContacts.begin(), kToolContacts.end());
    const auto contact = table.choice("contact", contacts);
    if (!contact) table.fail_missing("contact");
    const auto place = std::find(contacts.begin(), contacts.end(), *contact);
    tool.contact = static_cast<ToolContact>(place - contacts.begin());
    if (tool.contact != ToolContact::coulomb) {
        if (table.has("friction")) table.fail("friction", "belongs to contact = \"coulomb\" only");
        return;
    }
    const auto friction = table.number("friction");
    if (!friction) table.fail_missing("friction", "is required for contact = \"coulomb\"");
    if (!(*friction > 0 && *friction <= kMaxFrictionCoefficient))
        table.fail("friction",
                   fmt::format("must be greater than 0 and at most {}; without friction a contact is "
                               "\"frictionless\"",
                               kMaxFrictionCoefficient));
    tool.friction_coefficient = *friction;
}

SceneTool read_scene_tool(TomlTable table, std::size_t index) {
    SceneTool tool;
    tool.line = table.line();
    tool.name = required_name(table, "name");
    read_shape(table, tool);
    read_contact(table, tool);
    tool.position_m = table.point_m("position");
    if (const auto q = table.numbers("orientation_wxyz"); !q.empty()) {
        double norm = 0;
        for (const double v : q)
            norm += v * v;
        norm = std::sqrt(norm);
        if (q.size() != 4 || std::abs(norm - 1) > kUnitQuaternionTolerance)
            table.fail("orientation_wxyz", "must be a unit quaternion [w, x, y, z]");
        for (std::size_t i = 0; i < 4; ++i)
            tool.orientation_wxyz[i] = q[i] / norm;
    }
    auto touches = table.table("touches");
    if (!touches) table.fail_missing("touches", "is required: which part of the surface the tool may touch");
    tool.touches = read_selection(*touches, fmt::format("tool[{}].touches", index));
    touches->finish();
    table.finish();
    return tool;
}

void read_simulation(Scene& scene, TomlTable table) {
    if (const auto gravity = table.numbers("gravity_m_per_s2"); !gravity.empty()) {
        if (gravity.size() != 3) table.fail("gravity_m_per_s2", "must be three numbers");
        scene.gravity_m_per_s2 = {gravity[0], gravity[1], gravity[2]};
        scene.gravity_line = table.line_of("gravity_m_per_s2");
    }
    if (const auto damping = table.number("damping_per_s")) {
        if (*damping < 0) table.fail("damping_per_s", "must not be negative");
        scene.damping_per_s = *damping;
        scene.damping_line = table.line_of("damping_per_s");
    }
    table.finish();
}

EmbeddingSource read_embedding(const Scene& scene, TomlTable table) {
    EmbeddingSource embedding;
    embedding.line = table.line();
    embedding.file = path_beside(scene, table.text("file"));
    if (embedding.file.empty()) table.fail_missing("file");
    const auto unit = table.choice("length_unit", kLengthUnits);
    if (!unit) table.fail_missing("length_unit", "is required: STL and PLY files have no unit");
    embedding.metres_per_unit = metres_per_unit(*unit);
    embedding.max_distance_m = positive(table, "max_distance", table.length_m("max_distance"));
    table.finish();
    return embedding;
}

template <class Item>
void require_unique_names(const std::vector<Item>& items, const std::string& file, const char* what) {
    for (std::size_t i = 0; i < items.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (items[i].name == items[j].name)
                fail_input(fmt::format("{}:{}: a {} named \"{}\" stands already at line {}", file,
                                       items[i].line, what, items[i].name, items[j].line));
}

void read_body(Scene& scene, TomlTable& root) {
    auto mesh = root.table("mesh");
    if (!mesh) root.fail_missing("mesh");
    scene.mesh_line = mesh->line();
    scene.mesh = read_mesh_source(scene, *mesh, nullptr);
    auto material = root.table("material");
    if (!material) root.fail_missing("material");
    scene.material_line = material->line();
    scene.material = read_material_source(scene, *material);
    for (TomlTable& table : root.tables("level"))
        scene.levels.push_back(read_level(scene, table));
    if (scene.levels.empty()) root.fail_missing("level", "is required: at least one [[level]]");
    for (TomlTable& table : root.tables("held")) {
        scene.held.push_back(read_selection(table, fmt::format("held[{}]", scene.held.size())));
        table.finish();
    }
    for (TomlTable& table : root.tables("tool"))
        scene.tools.push_back(read_scene_tool(table, scene.tools.size()));
    if (scene.tools.empty()) root.fail_missing("tool", "is required: at least one [[tool]]");
    if (auto simulation = root.table("simulation")) read_simulation(scene, *simulation);
    if (auto app = root.table("app")) {
        scene.needs_surface = app->flag("surface").value_or(false);
        scene.surface_line = app->line_of("surface");
        app->finish();
    }
    if (auto embedding = root.table("embedding")) scene.embedding = read_embedding(scene, *embedding);
}

}  // namespace

const Level& Scene::level(const std::string& level_name) const {
    std::vector<std::string> names;
    for (const Level& candidate : levels) {
        if (candidate.name == level_name) return candidate;
        names.push_back(candidate.name);
    }
    const std::string near = nearest_word(level_name, names);
    fail_usage(fmt::format("{}: no level is named \"{}\"{}", file.string(), level_name,
                           near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

Scene parse_scene(std::string_view text, const std::filesystem::path& file) {
    const toml::table parsed = parse_toml(text, file.string());
    Scene scene;
    scene.file = file;
    TomlTable root(parsed, file.string(), "");
    scene.name = required_name(root, "name");
    read_body(scene, root);
    root.finish();
    require_unique_names(scene.levels, file.string(), "level");
    require_unique_names(scene.tools, file.string(), "tool");
    return scene;
}

Scene read_scene(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) fail_input(file.string() + ": no such file");
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) fail_input(file.string() + ": cannot be read");
    return parse_scene(text, file);
}

}  // namespace knead::tools
