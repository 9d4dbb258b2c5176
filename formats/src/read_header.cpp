// SPDX-License-Identifier: Apache-2.0
#include "load.h"
#include "schema.h"

namespace knead {
namespace {

const std::string kProvenance = "/provenance";
const std::string kArguments = kProvenance + "/arguments";
const std::string kInputs = kProvenance + "/inputs";
const std::string kRequests = kProvenance + "/requests";

void check_same_length(Schema& schema, std::uint64_t a, std::uint64_t b, const std::string& path) {
    if (a != b)
        schema.refuse(ErrorCode::wrong_extent,
                      std::to_string(a) + " and " + std::to_string(b) + " entries side by side", path);
}

}  // namespace

void check_provenance(Schema& schema) {
    schema.group(kProvenance);
    schema.text_attribute(kProvenance, "tool");
    schema.text_attribute(kProvenance, "tool_version");
    schema.number_attribute(kProvenance, "seed", ScalarType::u64);
    if (schema.has(kArguments)) schema.text_dataset(kArguments);
    if (schema.has(kInputs)) {
        schema.group(kInputs);
        const std::uint64_t roles = schema.text_dataset(kInputs + "/roles");
        check_same_length(schema, roles, schema.text_dataset(kInputs + "/content_hashes"), kInputs);
    }
    if (schema.has(kRequests)) {
        schema.group(kRequests);
        const std::uint64_t groups = schema.text_dataset(kRequests + "/groups");
        check_same_length(schema, groups, schema.text_dataset(kRequests + "/scene_keys"), kRequests);
        schema.dataset(kRequests + "/scene_lines", ScalarType::u32, {groups}, "1");
    }
}

Provenance take_provenance(Schema& schema) {
    Provenance provenance;
    provenance.tool = schema.text_of(kProvenance, "tool");
    provenance.tool_version = schema.text_of(kProvenance, "tool_version");
    provenance.seed = schema.number_of<std::uint64_t>(kProvenance, "seed");
    if (schema.has(kArguments)) provenance.arguments = schema.take_texts(kArguments);
    if (schema.has(kInputs)) {
        const auto roles = schema.take_texts(kInputs + "/roles");
        const auto hashes = schema.take_texts(kInputs + "/content_hashes");
        for (std::size_t i = 0; i < roles.size(); ++i)
            provenance.inputs.emplace_back(roles[i], hashes[i]);
    }
    return provenance;
}

std::vector<Asset::Request> take_requests(Schema& schema) {
    std::vector<Asset::Request> requests;
    if (!schema.has(kRequests)) return requests;
    const auto groups = schema.take_texts(kRequests + "/groups");
    const auto keys = schema.take_texts(kRequests + "/scene_keys");
    const auto lines = schema.take<std::uint32_t>(kRequests + "/scene_lines");
    for (std::size_t i = 0; i < groups.size(); ++i)
        requests.push_back({groups[i], keys[i], lines[i]});
    return requests;
}

Result<FileHeader> read_header(const std::filesystem::path& file, const ReadLimits& limits) {
    return guarded(file, [&] { return load_header(file, limits).header; });
}

}  // namespace knead
