// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "knead/formats/read.h"

namespace knead {

/// One group or dataset of the payload as it stands in a file.
struct NodeInfo {
    std::string path;  ///< "/knead/mesh/nodes_m"
    bool is_group = false;
    std::string type;                    ///< "float64", "text"; empty for groups
    std::vector<std::uint64_t> extents;  ///< empty for groups
    std::string units;                   ///< empty for groups
    /// Bytes in the file, headers included: of the dataset, or of the group with everything below it.
    std::uint64_t bytes_on_disk = 0;
    std::vector<std::pair<std::string, std::string>>
        attributes;  ///< name and value as text, `units` excepted
};

/// What is in a file, without its kind's meaning.
struct FileInfo {
    FileHeader header;
    std::uint64_t file_bytes = 0;
    std::vector<NodeInfo> nodes;  ///< below /knead, parents before children, sorted by path
    /// Bytes that are not below /knead: HDF5's own, provenance, and what /VTKHDF adds to the shared arrays.
    std::uint64_t other_bytes = 0;
};

/// Reads a file of any kind through all checks of its reader except the invariants of its values.
/// Errors and thread-safety as the readers.
Result<FileInfo> inspect_file(const std::filesystem::path& file, const ReadLimits& limits = {});

/// Reads a file of any kind through all checks of its reader. @return its kind
Result<FileKind> validate_file(const std::filesystem::path& file, const ReadLimits& limits = {});

}  // namespace knead
