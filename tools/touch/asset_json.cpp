// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/asset_json.h"

#include "knead/formats/tool_names.h"

namespace knead::tools {
namespace {}  // namespace

nlohmann::ordered_json asset_json(const Asset& asset, const std::string& content_hash, std::size_t tool) {
    const ToolSet& set = asset.tools[tool];
    return {{"name", asset.name},
            {"level", asset.level},
            {"content_hash", content_hash},
            {"nodes", asset.nodes_m.size()},
            {"tetrahedra", asset.tetrahedra.size()},
            {"tool",
             {{"index", tool},
              {"name", set.name},
              {"shape", name_of(set.shape)},
              {"contact", name_of(set.contact)},
              {"nodes", set.nodes.size()}}}};
}

}  // namespace knead::tools
