// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/clustering.h"
#include "knead/formats/material.h"
#include "knead/formats/overlap.h"
#include "knead/formats/session_log.h"
#include "knead/formats/tet_mesh.h"

namespace knead {

/// Upper bounds that a reader accepts before it allocates anything.
struct ReadLimits {
    std::uint64_t max_nodes = 100'000'000;
    std::uint64_t max_tetrahedra = 400'000'000;
    std::uint64_t max_overlap_entries = 4'000'000'000;
    std::uint64_t max_names = 4096;                     ///< regions, cell arrays, tools, requests: each
    std::uint64_t max_string_bytes = 65536;             ///< any one string
    std::uint64_t max_bytes = std::uint64_t{64} << 30;  ///< memory of all arrays of one file together
};

enum class FileKind : std::uint8_t { tet_mesh, material, clustering, overlap, asset, session };

/// Name of a kind as the file's `kind` attribute spells it.
[[nodiscard]] const char* to_string(FileKind kind);

/// Who made a file from what; never a clock, host, user, path or thread count (docs/format.md).
struct Provenance {
    std::string tool;          ///< "knead-cluster"
    std::string tool_version;  ///< Knead's version
    std::vector<std::string>
        arguments;           ///< canonical: every option that changes the result, defaults included
    std::uint64_t seed = 0;  ///< 0 when the tool draws no random numbers
    /// Role ("fine", "coarse") and content hash of every input, in the order of the command line.
    std::vector<std::pair<std::string, std::string>> inputs;
};

/// What stands in front of the data of any Knead file.
struct FileHeader {
    FileKind kind = FileKind::tet_mesh;
    std::array<std::int32_t, 2> format_version{};  ///< major, minor
    std::vector<std::string> required_features;
    std::string content_hash;  ///< lowercase hex SHA-256 of the payload
    Provenance provenance;
};

// Every reader checks, in this order: magic, version, features, kind, presence, type, extents, data, content
// hash, invariants. It never trusts a size beyond `limits`, never follows a link out of the file, and never
// repairs. A function for a kind also accepts a later kind that holds the same group (read_tet_mesh reads a
// material file). Thread-safety: safe from several threads; HDF5 itself is serialised by a process-wide lock.
// Allocation: as much as the file's data needs, at most limits.max_bytes.

Result<FileHeader> read_header(const std::filesystem::path& file, const ReadLimits& limits = {});
Result<TetMesh> read_tet_mesh(const std::filesystem::path& file, const ReadLimits& limits = {});
Result<MaterialObject> read_material(const std::filesystem::path& file, const ReadLimits& limits = {});
Result<ClusteredObject> read_clustering(const std::filesystem::path& file, const ReadLimits& limits = {});
Result<OverlapMatrix> read_overlap(const std::filesystem::path& file, const ReadLimits& limits = {});
Result<Asset> read_asset(const std::filesystem::path& file, const ReadLimits& limits = {});
/// At most limits.max_nodes ticks, and as many steps.
Result<SessionLog> read_session_log(const std::filesystem::path& file, const ReadLimits& limits = {});

}  // namespace knead
