// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>
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

/// Runs `body` so that nothing it throws crosses the public interface.
template <class Body>
auto guarded(const std::string& where, Body&& body) -> Result<decltype(body())> {
    try {
        return body();
    } catch (Failure& failure) {
        return std::move(failure.error);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "not enough memory", where};
    } catch (const std::length_error&) {
        return Error{ErrorCode::out_of_memory, "not enough memory", where};
    } catch (const std::exception& error) {
        return Error{ErrorCode::io_error, error.what(), where};
    }
}

/// The value of an inner result, or its error thrown on.
template <class T>
T value_or_fail(Result<T> result) {
    if (!result.ok()) throw Failure{result.error()};
    return std::move(result).value();
}

}  // namespace knead
