// SPDX-License-Identifier: Apache-2.0
#include "../session_parts.h"
#include "encode.h"

namespace knead {
namespace {

template <class T>
Value view_rows(const std::vector<T>& rows) {
    if constexpr (std::is_arithmetic_v<T>)
        return view_1d(rows);
    else
        return view_2d(rows);
}

template <class Part>
void encode_part(Payload& payload, const std::string& group, const Part& part) {
    payload.add_group(group);
    for_each_array(part, [&](const char* name, const auto& array, const char* units) {
        payload.add_dataset(group + "/" + name, view_rows(array), units);
    });
}

void encode_settings(Payload& payload, const std::vector<SessionLog::Setting>& settings) {
    std::vector<std::string> names;
    std::vector<double> values;
    for (const SessionLog::Setting& setting : settings) {
        names.push_back(setting.name);
        values.push_back(setting.value);
    }
    payload.add_group(kSettings);
    payload.add_dataset(kSettings + "/names", text_array(names), "none");
    payload.add_dataset(kSettings + "/values", copy_of(std::span<const double>(values), {values.size()}),
                        "as named");
}

}  // namespace

Status write_session_log(const std::filesystem::path& file, const SessionLog& log,
                         const Provenance& provenance) {
    return write_kind(file, FileKind::session, provenance, [&](FilePlan& plan) {
        value_or_fail(validate(log));
        Node& node = plan.payload.add_group(kSession);
        node.attributes["asset_content_hash"] = text_value(log.asset_content_hash);
        node.attributes["lost_ticks"] = scalar(log.lost_ticks);
        node.attributes["lost_steps"] = scalar(log.lost_steps);
        encode_settings(plan.payload, log.settings);
        encode_part(plan.payload, kTicks, log.ticks);
        if (!log.steps.number.empty()) encode_part(plan.payload, kSteps, log.steps);
    });
}

}  // namespace knead
