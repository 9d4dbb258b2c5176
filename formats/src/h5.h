// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "payload.h"

/// Owning handles and checked calls over the HDF5 C API. Every function here needs a live h5::Session.
namespace knead::h5 {

/// Takes the process-wide lock, silences HDF5's printing and forbids filter plugins; puts everything back as
/// the application had it. One per public call that touches HDF5.
class Session {
  public:
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

  private:
    std::unique_lock<std::mutex> lock_;
    H5E_auto2_t print_ = nullptr;
    void* print_data_ = nullptr;
    unsigned plugins_ = 0;
};

/// Owns one identifier of HDF5.
class Handle {
  public:
    using CloseFunction = herr_t (*)(hid_t);
    Handle() = default;
    Handle(hid_t id, CloseFunction close_function) : id_(id), close_(close_function) {}
    Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    [[nodiscard]] hid_t get() const noexcept { return id_; }
    [[nodiscard]] bool ok() const noexcept { return id_ >= 0; }
    /// Gives up the identifier and says whether HDF5 closed it without error.
    [[nodiscard]] bool close() {
        const hid_t id = id_;
        id_ = -1;
        return close_(id) >= 0;
    }

  private:
    hid_t id_ = -1;
    CloseFunction close_ = nullptr;
};

/// HDF5's name of an element type; text needs a type of its own. Borrowed: not to be closed.
[[nodiscard]] hid_t numeric_type(ScalarType type);
/// A type for the elements of `value`, to be closed.
[[nodiscard]] Handle stored_type(const Value& value);

/// Opens a file for reading: io_error when it cannot be read, not_knead when it is not HDF5, corrupt when it
/// only starts like one. Throws Failure.
[[nodiscard]] Handle open_file(const std::filesystem::path& file);

struct Link {
    std::string name;
    H5L_type_t type;
};
/// The links of a group in the order of their names. Throws too_large beyond `limit`.
[[nodiscard]] std::vector<Link> links_of(hid_t group, std::size_t limit, const std::string& where);

/// Opens what a hard link leads to; refuses every other kind of link as `forbidden`, and its absence as
/// `missing`.
[[nodiscard]] Handle open_child(hid_t group, const std::string& name, const std::string& where);

/// Type and extents of a dataset or attribute, not its data. Throws wrong_type, wrong_extent.
[[nodiscard]] Value describe(const Handle& type, const Handle& space, std::uint64_t max_text_bytes,
                             const std::string& where);

/// One attribute with its data. Throws too_large, wrong_type, wrong_extent, corrupt.
[[nodiscard]] Value read_attribute(hid_t object, const std::string& name, const ReadLimits& limits,
                                   const std::string& where);

/// All attributes of an object with their data. Throws too_large, wrong_type, wrong_extent, corrupt.
[[nodiscard]] std::map<std::string, Value> read_attributes(hid_t object, const ReadLimits& limits,
                                                           const std::string& where);

/// Refuses external storage, virtual layout and unknown filters (forbidden).
/// @return the most bytes that what the file holds of the dataset can become
[[nodiscard]] std::uint64_t check_storage(hid_t dataset, const std::string& where);

/// Bytes of a dataset's data, unless they stand in its header.
[[nodiscard]] std::uint64_t bytes_outside_header(hid_t dataset);

/// Reads the elements of a dataset that is no larger than check_storage() allows. Throws corrupt.
void read_elements(hid_t dataset, Value& value, const std::string& where);

/// Where an object's header is in the file, and how long it is.
struct ObjectHeader {
    std::uint64_t address = 0;
    std::uint64_t bytes = 0;
};
[[nodiscard]] ObjectHeader header_of(hid_t object, const std::string& where);

}  // namespace knead::h5
