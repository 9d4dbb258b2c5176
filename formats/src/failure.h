// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "knead/formats/result.h"

namespace knead {

/// Private exception of this library; guarded() turns it into the Error of a public function.
struct Failure {
    Error error;
};

[[noreturn]] inline void fail(ErrorCode code, std::string message, std::string where) {
    throw Failure{Error{code, std::move(message), std::move(where)}};
}

/// With words and place if there is memory for them, and else without: this itself never throws.
inline Error out_of_memory(const std::filesystem::path& where) noexcept {
    Error error;
    error.code = ErrorCode::out_of_memory;
    try {
        error.message = "no memory";  // short: needs none itself
        error.where = where.string();
        error.message = "not enough memory";
    } catch (const std::bad_alloc&) {
    }
    return error;
}

/// Runs `body` so that nothing it throws crosses the public interface. `where`: a file, or a place in one; a
/// text of its own is made of it only when it is needed, because making it may fail.
template <class Where, class Body>
auto guarded(const Where& where, Body&& body) noexcept -> Result<decltype(body())> {
    try {
        try {
            return body();
        } catch (Failure& failure) {
            return std::move(failure.error);
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::length_error&) {
            throw std::bad_alloc();
        } catch (const std::exception& error) {
            return Error{ErrorCode::io_error, error.what(), std::filesystem::path(where).string()};
        }
    } catch (const std::bad_alloc&) {
        if constexpr (std::is_same_v<Where, std::filesystem::path>) return out_of_memory(where);
        try {
            return out_of_memory(std::filesystem::path(where));
        } catch (const std::bad_alloc&) {
            return Error{ErrorCode::out_of_memory, "no memory", {}};
        }
    }
}

/// The value of an inner result, or its error thrown on.
template <class T>
T value_or_fail(Result<T> result) {
    if (!result.ok()) throw Failure{result.error()};
    return std::move(result).value();
}

}  // namespace knead
