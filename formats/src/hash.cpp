// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/hash.h"

#include <fstream>
#include <vector>

#include "failure.h"
#include "sha256.h"

namespace knead {

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.update(bytes.data(), bytes.size());
    return hash.hex_digest();
}

Result<std::string> sha256_of_file(const std::filesystem::path& file) {
    return guarded(file, [&] {
        std::ifstream stream(file, std::ios::binary);
        if (!stream) fail(ErrorCode::io_error, "cannot open", file.string());
        Sha256 hash;
        std::vector<char> buffer(std::size_t{1} << 16);
        do {
            stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
            hash.update(buffer.data(), static_cast<std::size_t>(stream.gcount()));
        } while (stream);
        if (stream.bad()) fail(ErrorCode::io_error, "cannot read", file.string());
        return hash.hex_digest();
    });
}

}  // namespace knead
