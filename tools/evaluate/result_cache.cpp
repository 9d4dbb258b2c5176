// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "common/error.h"
#include "evaluate/evaluation.h"
#include "knead/formats/hash.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

constexpr std::size_t kDigestDigits = 64;

}  // namespace

ResultCache::ResultCache(std::filesystem::path folder, std::string salt)
    : folder_(std::move(folder)), salt_(std::move(salt)) {
    if (folder_.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error || !std::filesystem::is_directory(folder_))
        throw ToolError(ExitCode::cannot_write, folder_.string() + ": cannot make the folder of the cache");
}

std::filesystem::path ResultCache::file_of(const std::string& key) const {
    const std::string digest = sha256_of(salt_ + '\n' + key);
    return folder_ / digest.substr(0, 2) / digest;
}

/// A file holds the digest of its content, then the content: one that is not whole is not believed.
std::optional<std::string> ResultCache::find(const std::string& key) const {
    if (folder_.empty()) return std::nullopt;
    std::ifstream stream(file_of(key), std::ios::binary);
    if (!stream) return std::nullopt;
    std::string content{std::istreambuf_iterator<char>(stream), {}};
    if (content.size() < kDigestDigits) return std::nullopt;
    const std::string digest = content.substr(0, kDigestDigits);
    content.erase(0, kDigestDigits);
    if (sha256_of(content) != digest) return std::nullopt;
    return content;
}

void ResultCache::keep(const std::string& key, const std::string& content) const {
    if (folder_.empty()) return;
    const std::filesystem::path file = file_of(key);
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    value_or_throw(write_text_file(file, sha256_of(content) + content));
}

}  // namespace knead::tools
