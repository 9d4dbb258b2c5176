// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/level_writer.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <vector>

#include "tune/mesh_range.h"

namespace knead::tools {
namespace {

std::string free_name(const Scene& scene) {
    const auto taken = [&](const std::string& name) {
        return std::any_of(scene.levels.begin(), scene.levels.end(),
                           [&](const Level& level) { return level.name == name; });
    };
    std::string name = "tuned";
    for (int k = 2; taken(name); ++k)
        name = fmt::format("tuned-{}", k);
    return name;
}

/// Whether the keys of a level make it, but for the mesh.
bool has_keys(const Recipe& recipe) {
    if (recipe.kind != RecipeKind::method) return recipe.kind == RecipeKind::fine;
    switch (recipe.method.kind) {
        case MethodKind::paper:
        case MethodKind::homogenised:
        case MethodKind::voigt:
        case MethodKind::raw_dominant:
            return true;
        default:
            return false;
    }
}

std::string keys_of(const Recipe& recipe, std::uint64_t seed) {
    std::string keys;
    if (recipe.method.bins > 0)
        keys += fmt::format("bins = {}\nclusters = {}\n", recipe.method.bins, recipe.method.clusters);
    if (recipe.method.kind == MethodKind::paper && recipe.kind == RecipeKind::method) {
        keys += fmt::format("seed = {}\n", seed);
        if (recipe.order == BinOrder::soft_first) keys += "order = \"soft-first\"\n";
        if (recipe.rule == CoarsenRule::volume_average) keys += "rule = \"volume-average\"\n";
    }
    if (recipe.method.kind == MethodKind::voigt) keys += "rule = \"volume-average\"\n";
    return keys;
}

struct Replacement {
    toml::source_region where;
    std::string file;
};

/// Values of these keys name files beside the scene.
void find_files(const toml::table& table, std::vector<Replacement>& found) {
    for (const auto& [key, node] : table) {
        if (const auto* inner = node.as_table()) find_files(*inner, found);
        if (const auto* array = node.as_array())
            for (const toml::node& item : *array)
                if (const auto* inner = item.as_table()) find_files(*inner, found);
        const bool names_file =
            key.str() == "file" || key.str() == "points" || key.str() == "csv" || key.str() == "object";
        if (const auto* text = node.as_string(); names_file && text != nullptr)
            found.push_back({node.source(), text->get()});
    }
}

/// Bytes before a place that TOML counts in lines and in characters.
std::size_t offset_of(const std::string& text, const toml::source_position& place) {
    std::size_t at = 0;
    for (toml::source_index line = 1; line < place.line; ++line)
        at = text.find('\n', at) + 1;
    for (toml::source_index column = 1; column < place.column; ++column) {
        ++at;
        while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U)
            ++at;
    }
    return at;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

}  // namespace

WrittenLevel level_for(const TunedScene& scene, std::size_t mesh, const Recipe& recipe,
                       const std::string& object_file) {
    const TunedMesh& tuned = scene.meshes()[mesh];
    WrittenLevel level;
    level.name = free_name(scene.scene());
    level.toml = fmt::format("[[level]]\nname = \"{}\"\n", level.name);
    const std::string mesh_toml =
        tuned.is_fine ? std::string() : level_mesh_toml(tuned.prepared.source, scene.scene().mesh);
    level.needs_object = !has_keys(recipe) || (!tuned.is_fine && mesh_toml.empty());
    if (level.needs_object) {
        level.toml += fmt::format("object = {}  # {}\n", quoted(object_file), recipe.text());
        return level;
    }
    level.toml += keys_of(recipe, scene.own_seed());
    if (!tuned.is_fine) level.toml += fmt::format("mesh = {}\n", mesh_toml);
    return level;
}

std::string scene_with_level(const std::string& text, const std::filesystem::path& scene_file,
                             const std::string& level_toml, const std::filesystem::path& new_file) {
    const auto folder = std::filesystem::absolute(scene_file).parent_path().lexically_normal();
    const auto new_folder = std::filesystem::absolute(new_file).parent_path().lexically_normal();
    std::string result = text;
    if (folder != new_folder) {
        const toml::table table = toml::parse(text);
        std::vector<Replacement> files;
        find_files(table, files);
        std::sort(files.begin(), files.end(), [](const Replacement& a, const Replacement& b) {
            return b.where.begin < a.where.begin;  // from the end, so that places stay
        });
        for (const Replacement& file : files) {
            const std::size_t from = offset_of(result, file.where.begin);
            const std::size_t to = offset_of(result, file.where.end);
            const auto path = (folder / file.file).lexically_normal().lexically_relative(new_folder);
            result.replace(from, to - from, quoted(path.generic_string()));
        }
    }
    if (!result.empty() && result.back() != '\n') result += '\n';
    return result + "\n" + level_toml;
}

}  // namespace knead::tools
