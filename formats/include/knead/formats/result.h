// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace knead {

/// What went wrong, as a number that is never reused or renumbered. docs/errors.md lists them for users.
enum class ErrorCode : int {
    io_error = 1,             ///< cannot open, read or find the file
    not_knead = 2,            ///< not an HDF5 file, or one without Knead's header
    version_unsupported = 3,  ///< format_version is newer than this reader
    feature_unsupported = 4,  ///< required_features names one this reader does not know
    wrong_kind = 5,           ///< a Knead file of another kind (an overlap where a mesh is wanted)
    missing = 6,              ///< a group, dataset or attribute is absent
    wrong_type = 7,           ///< stored type class or size differs from the format's
    wrong_extent = 8,         ///< rank or extents disagree with the format or with each other
    too_large = 9,            ///< an extent passes the reader's limits
    forbidden = 10,           ///< soft or external link, external storage, virtual layout, unknown filter
    corrupt = 11,             ///< checksum or content hash does not match
    invalid_data = 12,        ///< values break an invariant (index out of range, E <= 0, ...)
    cannot_write = 13,        ///< output could not be created, written or renamed
    out_of_memory = 14,       ///< an allocation inside the limits failed
    invalid_argument = 15,    ///< the caller passed something outside the documented range
};

/// A failure: code for programs, message and place for people.
struct Error {
    ErrorCode code = ErrorCode::io_error;
    std::string message;  ///< what is wrong, how much of it, ids of the first offenders
    std::string where;    ///< "file#/group/dataset", or empty

    /// "where: message", the form every tool prints.
    [[nodiscard]] std::string text() const { return where.empty() ? message : where + ": " + message; }
};

/// A value or an Error. No exception crosses a public function of formats or runtime.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
    Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] bool ok() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return ok(); }

    /// Precondition: ok().
    [[nodiscard]] const T& value() const& { return *checked(std::get_if<T>(&state_)); }
    [[nodiscard]] T& value() & { return *checked(std::get_if<T>(&state_)); }
    [[nodiscard]] T&& value() && { return std::move(*checked(std::get_if<T>(&state_))); }

    /// Precondition: !ok().
    [[nodiscard]] const Error& error() const { return *checked(std::get_if<Error>(&state_)); }

  private:
    template <class P>
    static P* checked(P* pointer) {
        assert(pointer != nullptr && "Result: value() of an error, or error() of a value");
        return pointer;
    }
    std::variant<T, Error> state_;
};

/// The result of something that yields no value.
struct Unit {};
using Status = Result<Unit>;

}  // namespace knead
