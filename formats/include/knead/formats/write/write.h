// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "knead/formats/read.h"

namespace knead {

// Writers. Each validates its data first, writes a temporary file in the folder of `file`, flushes it to the
// disk and renames it over `file`: a file that exists is a complete file, and an error leaves an existing
// `file` as it was. The same data and provenance give the same bytes. Errors: invalid_data, cannot_write.
// Thread-safety: as the readers.

Status write_tet_mesh(const std::filesystem::path& file, const TetMesh& mesh, const Provenance& provenance);
Status write_material(const std::filesystem::path& file, const MaterialObject& object,
                      const Provenance& provenance);
Status write_clustering(const std::filesystem::path& file, const ClusteredObject& object,
                        const Provenance& provenance);
Status write_overlap(const std::filesystem::path& file, const OverlapMatrix& overlap,
                     const Provenance& provenance);
Status write_asset(const std::filesystem::path& file, const Asset& asset, const Provenance& provenance);
Status write_session_log(const std::filesystem::path& file, const SessionLog& log,
                         const Provenance& provenance);

/// Replaces `file` with `text` in the same atomic way; for reports, depfiles and exports.
Status write_text_file(const std::filesystem::path& file, const std::string& text);

}  // namespace knead
