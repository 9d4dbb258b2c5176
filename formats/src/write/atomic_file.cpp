// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "encode.h"

namespace knead {
namespace {

[[noreturn]] void fail_write(const std::filesystem::path& file, const std::string& what, int error) {
    fail(ErrorCode::cannot_write, what + ": " + std::generic_category().message(error), file.string());
}

/// A file beside the target that is removed unless it was renamed to the target.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& target) : target_(target) {
        static std::atomic<unsigned> counter{0};
        // O_EXCL makes the name ours alone; a leftover of a killed process only costs another try.
        for (int attempt = 0; attempt < 1000 && descriptor_ < 0; ++attempt) {
            std::string name(".");
            name.append(target.filename().string()).append(".").append(std::to_string(::getpid()));
            name.append(".").append(std::to_string(counter++)).append(".tmp");
            path_ = target.parent_path() / name;
            descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno != EEXIST) break;
        }
        if (descriptor_ < 0) fail_write(target_, "cannot be created", errno);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!renamed_) ::unlink(path_.c_str());
    }

    void write(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
            const ssize_t written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), kMostAtOnce));
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) fail_write(target_, "cannot be written", written < 0 ? errno : ENOSPC);
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
    }

    void rename_to_target() {
        if (::fsync(descriptor_) != 0) fail_write(target_, "cannot be flushed to the disk", errno);
        const int descriptor = descriptor_;
        descriptor_ = -1;
        if (::close(descriptor) != 0) fail_write(target_, "cannot be closed", errno);
        if (::rename(path_.c_str(), target_.c_str()) != 0) fail_write(target_, "cannot be replaced", errno);
        renamed_ = true;
        flush_folder();
    }

  private:
    /// The new name itself should survive a power cut; where folders cannot be flushed that is no error.
    void flush_folder() const {
        const auto folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
        const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (descriptor < 0) return;
        (void)::fsync(descriptor);
        ::close(descriptor);
    }

    std::filesystem::path target_;
    std::filesystem::path path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

}  // namespace

void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    std::error_code ignored;
    if (!file.has_filename()) fail(ErrorCode::cannot_write, "is not the name of a file", file.string());
    const auto status = std::filesystem::status(file, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        fail(ErrorCode::cannot_write, "exists and is not a file", file.string());
    TemporaryFile temporary(file);
    temporary.write(bytes);
    temporary.rename_to_target();
}

Status write_text_file(const std::filesystem::path& file, const std::string& text) {
    return guarded(file, [&] {
        replace_file(file, std::as_bytes(std::span<const char>(text)));
        return Unit{};
    });
}

}  // namespace knead
