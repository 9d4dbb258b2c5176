// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include "payload.h"

namespace knead {

/// A file's header and payload, as far as the generic reading goes.
struct LoadedFile {
    FileHeader header;
    Payload payload;     ///< "/knead/...", every value loaded, content hash checked, shape checked
    Payload provenance;  ///< "/provenance/...", every value loaded
    std::uint64_t file_bytes = 0;
};

/// Opens a file and goes through the checks in the order that read.h promises, up to and with the content
/// hash; the caller decodes and checks the invariants. `accepted`: kinds that the caller can use. Throws
/// Failure.
[[nodiscard]] LoadedFile load_file(const std::filesystem::path& file, const ReadLimits& limits,
                                   std::initializer_list<FileKind> accepted);

/// Header and provenance only.
[[nodiscard]] LoadedFile load_header(const std::filesystem::path& file, const ReadLimits& limits);

inline constexpr std::initializer_list<FileKind> kEveryKind = {FileKind::tet_mesh,   FileKind::material,
                                                               FileKind::clustering, FileKind::overlap,
                                                               FileKind::asset,      FileKind::session};

}  // namespace knead
