// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/inspect.h"

namespace knead::tools {

/// What `knead-asset info` shows: the file's nodes, and for an asset what it holds and which line of the
/// scene asked for each group.
struct Description {
    FileInfo file;
    std::optional<Asset> asset;  ///< assets only
};

/// The request of the scene that explains `path`: the one for the path itself, or for the nearest group above
/// it; nullptr when none does.
[[nodiscard]] const Asset::Request* request_for(const Asset& asset, const std::string& path);

[[nodiscard]] std::string info_text(const Description& description);
[[nodiscard]] std::string info_json(const Description& description);

}  // namespace knead::tools
