// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/shared_options.h"

#include <cstdlib>

#include "knead/formats/hash.h"
#include "knead/formats/version.h"
#include "material/csv.h"

namespace knead::tools {
namespace {

/// Results belong to the program that made them.
std::string program_hash() {
    const Result<std::string> hash = sha256_of_file("/proc/self/exe");
    return hash.ok() ? hash.value() : std::string(kLibraryVersion);
}

/// Empty: nowhere.
std::filesystem::path folder_of(const CacheOptions& options) {
    if (options.none) return {};
    if (!options.folder.empty()) return options.folder;
    if (const char* caches = std::getenv("XDG_CACHE_HOME"); caches != nullptr && *caches != '\0')
        return std::filesystem::path(caches) / "knead" / "evaluate";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
        return std::filesystem::path(home) / ".cache" / "knead" / "evaluate";
    return {};
}

void declare_counts(CLI::App& app, const char* name, std::vector<std::uint32_t>& values, const char* what,
                    const char* type) {
    app.add_option(name, values, what)
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(1U, 1000000U))
        ->type_name(type);
}

}  // namespace

void declare_options(CLI::App& app, CacheOptions& options) {
    auto* folder =
        app.add_option("--cache", options.folder,
                       "folder in which results are kept [the user's cache folder, knead/evaluate]");
    folder->type_name("FOLDER");
    app.add_flag("--no-cache", options.none, "keep nothing, use nothing kept")->excludes(folder);
}

ResultCache open_cache(const CacheOptions& options) {
    return {folder_of(options), program_hash()};
}

void declare_paper_method(CLI::App& app, std::vector<std::uint32_t>& bins,
                          std::vector<std::uint32_t>& clusters) {
    declare_counts(app, "--bins", bins, "elasticity bins of the paper's method", "N,...");
    declare_counts(app, "--clusters", clusters, "clusters in each bin of the paper's method", "K,...");
}

std::optional<double> share_of(std::string text) {
    const bool percent = !text.empty() && text.back() == '%';
    if (percent) text.pop_back();
    const std::optional<double> number = parse_number(text);
    if (!number) return std::nullopt;
    return percent ? *number / 100 : *number;
}

}  // namespace knead::tools
