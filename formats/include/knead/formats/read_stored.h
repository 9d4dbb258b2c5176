// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "knead/formats/read.h"

namespace knead {

/// What a file holds, and the content hash that names it in the provenance of what is made from it.
template <class T>
struct Stored {
    T value;
    std::string content_hash;
};

/// The readers of read.h for whoever also needs the content hash: both come from one opening of the file, so
/// that they belong together even while somebody replaces it. T: TetMesh, MaterialObject, ClusteredObject,
/// OverlapMatrix, Asset or SessionLog. Errors, allocation and thread-safety as the readers.
template <class T>
Result<Stored<T>> read_stored(const std::filesystem::path& file, const ReadLimits& limits = {});

template <>
Result<Stored<TetMesh>> read_stored<TetMesh>(const std::filesystem::path& file, const ReadLimits& limits);
template <>
Result<Stored<MaterialObject>> read_stored<MaterialObject>(const std::filesystem::path& file,
                                                           const ReadLimits& limits);
template <>
Result<Stored<ClusteredObject>> read_stored<ClusteredObject>(const std::filesystem::path& file,
                                                             const ReadLimits& limits);
template <>
Result<Stored<OverlapMatrix>> read_stored<OverlapMatrix>(const std::filesystem::path& file,
                                                         const ReadLimits& limits);
template <>
Result<Stored<SessionLog>> read_stored<SessionLog>(const std::filesystem::path& file,
                                                   const ReadLimits& limits);
template <>
Result<Stored<Asset>> read_stored<Asset>(const std::filesystem::path& file, const ReadLimits& limits);

}  // namespace knead
