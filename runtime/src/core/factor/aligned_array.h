// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <new>
#include <utility>

namespace knead::core {

/// Numbers that start at a cache line, zero at first. Allocates in the constructor only.
template <class T>
class AlignedArray {
  public:
    AlignedArray() = default;
    explicit AlignedArray(std::size_t size)
        : size_(size), data_(static_cast<T*>(::operator new (bytes(), std::align_val_t{kAlignment}))) {
        std::memset(static_cast<void*>(data_), 0, bytes());
    }
    AlignedArray(AlignedArray&& other) noexcept
        : size_(std::exchange(other.size_, 0)), data_(std::exchange(other.data_, nullptr)) {}
    AlignedArray& operator=(AlignedArray&& other) noexcept {
        std::swap(size_, other.size_);
        std::swap(data_, other.data_);
        return *this;
    }
    ~AlignedArray() {
        if (data_ != nullptr) ::operator delete (data_, std::align_val_t{kAlignment});
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return size_ * sizeof(T); }
    [[nodiscard]] T* data() noexcept { return data_; }
    [[nodiscard]] const T* data() const noexcept { return data_; }
    T& operator[](std::size_t i) noexcept { return data_[i]; }
    const T& operator[](std::size_t i) const noexcept { return data_[i]; }

  private:
    static constexpr std::size_t kAlignment = 64;
    std::size_t size_ = 0;
    T* data_ = nullptr;
};

}  // namespace knead::core
