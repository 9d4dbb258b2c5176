// SPDX-License-Identifier: Apache-2.0
#include "layers/rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

namespace knead::test {
namespace {

using Include = SourceFile::Include;

bool starts(std::string_view text, std::string_view beginning) {
    return text.substr(0, beginning.size()) == beginning;
}

bool in(const SourceFile& file, std::string_view folder) {
    return starts(file.path, folder);
}

// ---- What an include line names ------------------------------------------------------------------------

bool names_writers(const Include& include) {
    return starts(include.name, "knead/formats/write/");
}
bool names_formats(const Include& include) {
    return starts(include.name, "knead/formats/");
}
bool names_runtime(const Include& include) {
    return starts(include.name, "knead/runtime/") || include.name == "knead/knead.h";
}
bool names_haptics(const Include& include) {
    return starts(include.name, "knead/haptics/") || include.name == "knead/knead_haptics.h";
}
bool names_hdf5(const Include& include) {
    return starts(include.name, "hdf5") || starts(include.name, "H5");
}
bool names_eigen(const Include& include) {
    return starts(include.name, "Eigen/") || starts(include.name, "unsupported/Eigen/");
}

/// <vector>, <cmath>, <stdint.h>, and what POSIX adds for files and time.
bool names_system(const Include& include) {
    static const std::set<std::string_view> kSystem{
        "errno.h",   "fcntl.h",  "float.h",  "inttypes.h", "limits.h", "math.h",
        "pthread.h", "sched.h",  "signal.h", "stdbool.h",  "stddef.h", "stdint.h",
        "stdio.h",   "stdlib.h", "string.h", "time.h",     "unistd.h"};
    if (!include.angle) return false;
    const bool plain = std::all_of(include.name.begin(), include.name.end(), [](unsigned char c) {
        return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
    });
    return plain || kSystem.count(include.name) > 0 || starts(include.name, "sys/");
}

bool names_threads(const Include& include) {
    static const std::set<std::string_view> kThreads{
        "thread",     "mutex", "shared_mutex", "condition_variable", "future", "semaphore",
        "stop_token", "latch", "barrier",      "pthread.h"};
    return include.angle && kThreads.count(include.name) > 0;
}

/// What compilers bring for a processor's own instructions.
bool names_intrinsics(const Include& include) {
    return include.angle && (include.name == "immintrin.h" || include.name == "xmmintrin.h");
}

/// "h5.h" next to the file, or a path from the src folder of its layer.
bool names_own_source(const SourceFile& file, const Include& include, const std::set<std::string>& paths,
                      const std::string& source_root) {
    if (include.angle) return false;
    const auto beside = std::filesystem::path(file.path).parent_path() / include.name;
    return paths.count(beside.lexically_normal().generic_string()) > 0 ||
           paths.count(source_root + include.name) > 0;
}

// ---- One rule each: what is wrong with this line, if anything
// ----------------------------------------------

using Complaint = std::optional<std::string>;

Complaint formats_rule(const SourceFile& file, const Include& include, const std::set<std::string>& paths) {
    if (!in(file, "formats/")) return std::nullopt;
    const bool is_public = in(file, "formats/include/");
    const bool is_writer = in(file, "formats/include/knead/formats/write/") || in(file, "formats/src/write/");
    if (names_writers(include))
        return is_writer ? Complaint() : "the read side of formats must not include its writers";
    if (names_formats(include) || names_system(include)) return std::nullopt;
    if (names_hdf5(include)) return is_public ? Complaint("public headers must not show HDF5") : Complaint();
    if (!is_public && names_own_source(file, include, paths, "formats/src/")) {
        if (!is_writer && include.name.find("write/") != std::string::npos)
            return "the read side of formats must not include its writers";
        return std::nullopt;
    }
    return "formats may include formats, the standard library and (in src) HDF5 only";
}

bool is_haptics(const SourceFile& file) {
    return in(file, "runtime/src/haptics/") || in(file, "runtime/include/knead/haptics/") ||
           file.path == "runtime/include/knead/knead_haptics.h";
}

Complaint runtime_rule(const SourceFile& file, const Include& include, const std::set<std::string>& paths) {
    if (!in(file, "runtime/")) return std::nullopt;
    const bool is_public = in(file, "runtime/include/");
    if (names_writers(include)) return "the runtime must not include the writers of formats";
    if (names_formats(include) || names_runtime(include) || names_system(include)) return std::nullopt;
    if (names_haptics(include)) {
        return is_haptics(file) ? Complaint()
                                : "the simulation must not include what is between it and the hand";
    }
    if (is_haptics(file) && !include.angle &&
        (starts(include.name, "core/") || starts(include.name, "load/")))
        return "the haptics see of the runtime what every application sees";
    if (names_eigen(include))
        return is_public ? Complaint("public headers must not show Eigen") : Complaint();
    if (!is_public && names_own_source(file, include, paths, "runtime/src/")) return std::nullopt;
    if (in(file, "runtime/src/core/") && names_intrinsics(include)) return std::nullopt;
    return "the runtime may include formats (read side), itself, the standard library and (in src) Eigen "
           "only";
}

Complaint core_rule(const SourceFile& file, const Include& include) {
    if (!in(file, "runtime/src/core/")) return std::nullopt;
    if (names_hdf5(include)) return "the core must not include HDF5";
    if (names_threads(include)) return "the core must not include threads";
    if (include.name == "knead/formats/read.h") return "the core must not include readers";
    if (!include.angle &&
        (starts(include.name, "load/") || starts(include.name, "haptics/") || starts(include.name, "capi/")))
        return "the core must not include the layers above it";
    return std::nullopt;
}

Complaint tools_rule(const SourceFile& file, const Include& include) {
    if (!in(file, "tools/") || in(file, "tools/evaluate/") || in(file, "tools/touch/") ||
        in(file, "tools/baseline/") || in(file, "tools/stability/"))
        return std::nullopt;
    if (names_runtime(include) || names_haptics(include) || starts(include.name, "runtime/"))
        return "tools must not include the runtime (except tools/baseline, tools/evaluate, tools/stability "
               "and tools/touch)";
    return std::nullopt;
}

Complaint common_rule(const SourceFile& file, const Include& include) {
    if (!in(file, "tools/") || in(file, "tools/common/")) return std::nullopt;
    // A main may keep the declaration of its options in a file beside it.
    const std::string stem = std::filesystem::path(file.path).stem().string();
    if (stem == "main" || stem == "options" || !starts(include.name, "common/")) return std::nullopt;
    for (const char* pure :
         {"common/error.h", "common/exit_code.h", "common/length.h", "common/metis_lock.h"})
        if (include.name == pure) return std::nullopt;
    return "an algorithm may include of common only error.h, exit_code.h, length.h and metis_lock.h; the "
           "rest is for mains";
}

Complaint examples_rule(const SourceFile& file, const Include& include) {
    if (!in(file, "examples/")) return std::nullopt;
    if (names_writers(include)) return "examples must not include the writers of formats";
    return std::nullopt;
}

/// Libraries that one tool has for itself (and its tests).
Complaint owner_rule(const SourceFile& file, const Include& include) {
    struct Owned {
        const char* prefix;
        const char* tool;
        const char* complaint;
    };
    static constexpr std::array<Owned, 4> kOwned{{
        {"gmsh", "mesh/", "only tools/mesh may include gmsh"},
        {"CGAL/", "overlap/", "only tools/overlap may include CGAL"},
        {"metis", "bake/", "only tools/bake may include METIS"},
        {"parmetis", "bake/", "only tools/bake may include METIS"},
    }};
    for (const Owned& owned : kOwned) {
        if (!include.angle || !starts(include.name, owned.prefix)) continue;
        if (in(file, std::string("tools/") + owned.tool)) return std::nullopt;
        if (in(file, std::string("tests/unit/") + owned.tool)) return std::nullopt;
        return owned.complaint;
    }
    return std::nullopt;
}

Complaint licence_rule(const SourceFile& file) {
    // What a consumer's build includes from our installation, and what the benchmark shares, is free of the GPL.
    const bool gpl = in(file, "tools/") && !in(file, "tools/baseline/") && !in(file, "tools/cmake/");
    const std::string licence = gpl ? "GPL-3.0-or-later" : "Apache-2.0";
    const std::string line = "SPDX-License-Identifier: " + licence;
    const std::string& found = file.licence_line;
    if (found == "// " + line || found == "# " + line || found == "/* " + line + " */") return std::nullopt;
    return "the first line must say " + line;
}

}  // namespace

std::vector<std::string> layer_violations(const std::vector<SourceFile>& sources) {
    std::set<std::string> paths;
    for (const SourceFile& file : sources)
        paths.insert(file.path);
    std::vector<std::string> violations;
    for (const SourceFile& file : sources) {
        if (const auto complaint = licence_rule(file)) violations.push_back(file.path + ":1: " + *complaint);
        for (const Include& include : file.includes)
            for (const Complaint& complaint :
                 {formats_rule(file, include, paths), runtime_rule(file, include, paths),
                  core_rule(file, include), tools_rule(file, include), common_rule(file, include),
                  examples_rule(file, include), owner_rule(file, include)})
                if (complaint)
                    violations.push_back(file.path + ":" + std::to_string(include.line) + ": " +
                                         include.name + ": " + *complaint);
    }
    return violations;
}

}  // namespace knead::test
