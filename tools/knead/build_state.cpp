// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/build_state.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "knead/formats/hash.h"
#include "knead/formats/read.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

constexpr const char* kFile = ".knead-build.json";
constexpr const char* kSchema = "knead-build/1";

/// The hash that decides whether a file changed: of the payload for Knead's own files, of the bytes for
/// others. Empty when the file cannot be read, which equals no recorded hash.
std::string hash_of(const std::filesystem::path& file) {
    if (file.extension() == ".hdf") {
        const auto header = read_header(file);
        return header.ok() ? header.value().content_hash : std::string();
    }
    const auto hash = sha256_of_file(file);
    return hash.ok() ? hash.value() : std::string();
}

}  // namespace

BuildState BuildState::load(const std::filesystem::path& folder) {
    std::ifstream stream(folder / kFile, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse(text, folder);
}

BuildState BuildState::parse(std::string_view text, const std::filesystem::path& folder) {
    BuildState state;
    state.file_ = folder / kFile;
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return state;
    try {
        if (json.value("schema", "") != kSchema) return state;
        for (const auto& [output, stage] : json.at("stages").items()) {
            Entry entry;
            entry.command_hash = stage.at("command");
            entry.output_hash = stage.at("output");
            for (const auto& dependency : stage.at("dependencies"))
                entry.dependencies.emplace_back(dependency.at(0), dependency.at(1));
            state.entries_[output] = std::move(entry);
        }
    } catch (const nlohmann::json::exception&) {
        state.entries_.clear();
    }
    return state;
}

void BuildState::save() const {
    nlohmann::ordered_json json;
    json["schema"] = kSchema;
    json["stages"] = nlohmann::ordered_json::object();
    for (const auto& [output, entry] : entries_)
        json["stages"][output] = {{"command", entry.command_hash},
                                  {"output", entry.output_hash},
                                  {"dependencies", entry.dependencies}};
    // A file name need not be UTF-8; as it then reads back as another name, that stage is made again.
    value_or_throw(
        write_text_file(file_, json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"));
}

std::string BuildState::command_hash(const Stage& stage, const std::filesystem::path& program) {
    std::string& program_hash = programs_[program];
    if (program_hash.empty()) program_hash = value_or_throw(sha256_of_file(program));
    std::string command = program_hash;
    for (const std::string& argument : stage.arguments)
        command += '\0' + argument;
    return sha256_of(command);
}

bool BuildState::up_to_date(const Stage& stage, const std::filesystem::path& program) {
    const auto found = entries_.find(stage.output.filename().string());
    if (found == entries_.end()) return false;
    const Entry& entry = found->second;
    if (entry.command_hash != command_hash(stage, program)) return false;
    for (const auto& [file, hash] : entry.dependencies)
        if (hash_of(file) != hash) return false;
    const std::string output_hash = hash_of(stage.output);
    return !output_hash.empty() && output_hash == entry.output_hash;
}

void BuildState::record(const Stage& stage, const std::filesystem::path& program,
                        const std::vector<std::filesystem::path>& dependencies) {
    Entry entry;
    entry.command_hash = command_hash(stage, program);
    entry.output_hash = hash_of(stage.output);
    for (const auto& file : dependencies)
        entry.dependencies.emplace_back(file.string(), hash_of(file));
    entries_[stage.output.filename().string()] = std::move(entry);
}

std::vector<std::filesystem::path> BuildState::dependencies(const Stage& stage) const {
    std::vector<std::filesystem::path> files;
    const auto found = entries_.find(stage.output.filename().string());
    if (found != entries_.end())
        for (const auto& [file, hash] : found->second.dependencies)
            files.emplace_back(file);
    return files;
}

std::vector<std::filesystem::path> read_depfile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse_depfile(text, file.string());
}

std::vector<std::filesystem::path> parse_depfile(std::string_view text, const std::string& name) {
    std::vector<std::string> words(1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const char next = i + 1 < text.size() ? text[i + 1] : '\n';
        if (c == '\\' && next == '\n') {
            ++i;
        } else if ((c == '\\' && (next == ' ' || next == '#' || next == '\\')) || (c == '$' && next == '$')) {
            words.back() += next;
            ++i;
        } else if (c == ' ' || c == '\n') {
            if (!words.back().empty()) words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    if (words.front().empty() || words.front().back() != ':') fail_input(name + ": not a dependency file");
    std::vector<std::filesystem::path> files;
    for (std::size_t i = 1; i < words.size(); ++i)
        if (!words[i].empty()) files.emplace_back(words[i]);
    return files;
}

}  // namespace knead::tools
