// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <type_traits>

#include "read_kind.h"
#include "session_parts.h"

namespace knead {
namespace {

template <class T>
struct Row {
    using Element = T;
    static std::vector<std::uint64_t> extents(std::uint64_t rows) { return {rows}; }
};
template <class T, std::size_t N>
struct Row<std::array<T, N>> {
    using Element = T;
    static std::vector<std::uint64_t> extents(std::uint64_t rows) { return {rows, N}; }
};
template <class Array>
using RowOf = Row<typename std::decay_t<Array>::value_type>;

/// Rows are as many as the first array has, which `what` are counted by.
template <class Part>
void check_part(Schema& schema, const std::string& group, const char* what) {
    schema.group(group);
    std::uint64_t rows = kAnyExtent;
    Part part;
    for_each_array(part, [&](const char* name, const auto& array, const char* units) {
        using R = RowOf<decltype(array)>;
        const std::string path = group + "/" + name;
        rows = schema.dataset(path, scalar_type_of<typename R::Element>(), R::extents(rows), units);
        schema.limit(rows, schema.limits().max_nodes, what, path);
    });
}

template <class Part>
Part take_part(Schema& schema, const std::string& group) {
    Part part;
    if (!schema.has(group)) return part;
    for_each_array(part, [&](const char* name, auto& array, const char*) {
        array = schema.take<typename std::decay_t<decltype(array)>::value_type>(group + "/" + name);
    });
    return part;
}

}  // namespace

void check_session_shape(Schema& schema) {
    schema.group(kSession);
    schema.text_attribute(kSession, "asset_content_hash");
    schema.number_attribute(kSession, "lost_ticks", ScalarType::u64);
    schema.number_attribute(kSession, "lost_steps", ScalarType::u64);
    schema.group(kSettings);
    const std::uint64_t names = schema.text_dataset(kSettings + "/names");
    schema.dataset(kSettings + "/values", ScalarType::f64, {names}, "as named");
    check_part<SessionLog::Ticks>(schema, kTicks, "ticks");
    if (schema.has(kSteps)) check_part<SessionLog::Steps>(schema, kSteps, "steps");
}

SessionLog take_session(Schema& schema) {
    SessionLog log;
    log.asset_content_hash = schema.text_of(kSession, "asset_content_hash");
    log.lost_ticks = schema.number_of<std::uint64_t>(kSession, "lost_ticks");
    log.lost_steps = schema.number_of<std::uint64_t>(kSession, "lost_steps");
    const std::vector<std::string> names = schema.take_texts(kSettings + "/names");
    const std::vector<double> values = schema.take<double>(kSettings + "/values");
    for (std::size_t i = 0; i < names.size(); ++i)
        log.settings.push_back({names[i], values[i]});
    log.ticks = take_part<SessionLog::Ticks>(schema, kTicks);
    log.steps = take_part<SessionLog::Steps>(schema, kSteps);
    return log;
}

template <>
Result<Stored<SessionLog>> read_stored<SessionLog>(const std::filesystem::path& file,
                                                   const ReadLimits& limits) {
    return read_kind<SessionLog>(file, limits, {FileKind::session}, [](Schema& schema) {
        SessionLog log = take_session(schema);
        value_or_fail(validate(log));
        return log;
    });
}

Result<SessionLog> read_session_log(const std::filesystem::path& file, const ReadLimits& limits) {
    return value_of(read_stored<SessionLog>(file, limits));
}

}  // namespace knead
