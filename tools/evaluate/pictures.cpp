// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pictures.h"

#include <algorithm>
#include <array>

#include "aggregate/aggregate.h"
#include "cluster/cluster.h"
#include "common/error.h"
#include "knead/formats/inspect.h"

namespace knead::tools {
namespace {

/// Groups of an asset that exist only where the scene asks for them, and the key that would.
struct OptionalGroup {
    const char* group;
    const char* key;
};
constexpr std::array<OptionalGroup, 4> kOptional{{{"/knead/asset/gravity", "simulation.gravity_m_per_s2"},
                                                  {"/knead/asset/damping", "simulation.damping_per_s"},
                                                  {"/knead/asset/surface", "app.surface"},
                                                  {"/knead/asset/embedding", "[embedding]"}}};

const Asset::Request* request_for(const Asset& asset, const std::string& group) {
    const auto at = std::find_if(asset.requests.begin(), asset.requests.end(),
                                 [&](const Asset::Request& request) { return request.group == group; });
    return at == asset.requests.end() ? nullptr : &*at;
}

Material binned(const Material& raw, const Clustering& clustering) {
    Material material = raw;
    material.bin_of_tetrahedron = clustering.bin_of_tetrahedron;
    for (std::size_t t = 0; t < raw.youngs_modulus_pa.size(); ++t) {
        const std::uint32_t bin = clustering.bin_of_tetrahedron[t];
        material.youngs_modulus_pa[t] = clustering.bin_youngs_modulus_pa[bin];
        material.poissons_ratio[t] = clustering.bin_poissons_ratio[bin];
        material.density_kg_per_m3[t] = clustering.bin_density_kg_per_m3[bin];
    }
    return material;
}

}  // namespace

std::vector<ObjectState> fine_states(const MaterialObject& fine, std::uint32_t bins, std::uint32_t clusters,
                                     std::uint64_t seed) {
    ClusterOptions options;
    options.bins = bins;
    options.clusters = clusters;
    options.seed = seed;
    const Clustering clustering = cluster_object(fine.mesh, fine.material, options).clustering;
    Material clustered = fine.material;
    clustered.bin_of_tetrahedron = clustering.bin_of_tetrahedron;
    return {
        {"C1 initial", fine, {}},
        {"C2 clustered", {fine.mesh, std::move(clustered)}, clustering.cluster_of_tetrahedron},
        {"C3 homogenised", {fine.mesh, binned(fine.material, clustering)}, clustering.cluster_of_tetrahedron},
        {"C4 aggregated", {fine.mesh, aggregate({fine.mesh, fine.material, clustering}, {}).material}, {}}};
}

std::vector<AssetGroup> asset_groups(const Asset& asset, const std::filesystem::path& file) {
    const FileInfo info = value_or_throw(inspect_file(file));
    std::vector<AssetGroup> groups;
    for (const NodeInfo& node : info.nodes) {
        const Asset::Request* request = request_for(asset, node.path);
        if (request == nullptr) continue;
        groups.push_back({node.path, node.bytes_on_disk,
                          request->scene_key + ", line " + std::to_string(request->scene_line), false,
                          "the scene asks for it"});
    }
    groups.push_back({"(header, provenance, HDF5)", info.other_bytes, "", false, "every file has it"});
    for (const OptionalGroup& optional : kOptional)
        if (request_for(asset, optional.group) == nullptr)
            groups.push_back(
                {optional.group, 0, "", true, std::string("no ") + optional.key + " in the scene"});
    return groups;
}

}  // namespace knead::tools
