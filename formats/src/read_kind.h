// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>

#include "load.h"
#include "schema.h"

namespace knead {

/// The frame of every public reader: loads the file and lets `take` decode and validate it; messages of
/// validate() get the file's name.
template <class Take>
auto read_kind(const std::filesystem::path& file, const ReadLimits& limits,
               std::initializer_list<FileKind> accepted, Take&& take) {
    return guarded(file.string(), [&] {
        LoadedFile loaded = load_file(file, limits, accepted);
        try {
            Schema schema(loaded.payload, file.string(), limits);
            if constexpr (std::is_invocable_v<Take, Schema&, LoadedFile&>)
                return take(schema, loaded);
            else
                return take(schema);
        } catch (Failure& failure) {
            failure.error.where = file.string() + "#" + failure.error.where;
            throw;
        }
    });
}

}  // namespace knead
