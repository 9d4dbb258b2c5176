// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>

#include "knead/formats/read_stored.h"
#include "load.h"
#include "schema.h"

namespace knead {

/// The frame of every public reader: loads the file and lets `take` decode and validate it; messages of
/// validate() get the file's name.
template <class T, class Take>
Result<Stored<T>> read_kind(const std::filesystem::path& file, const ReadLimits& limits,
                            std::initializer_list<FileKind> accepted, Take&& take) {
    return guarded(file, [&]() -> Stored<T> {
        LoadedFile loaded = load_file(file, limits, accepted);
        try {
            Schema schema(loaded.payload, file.string(), limits);
            if constexpr (std::is_invocable_v<Take, Schema&, LoadedFile&>)
                return {take(schema, loaded), loaded.header.content_hash};
            else
                return {take(schema), loaded.header.content_hash};
        } catch (Failure& failure) {
            failure.error.where = file.string() + "#" + failure.error.where;
            throw;
        }
    });
}

/// The value alone.
template <class T>
Result<T> value_of(Result<Stored<T>> stored) {
    if (!stored.ok()) return stored.error();
    return std::move(stored.value().value);
}

}  // namespace knead
