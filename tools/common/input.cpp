// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input.h"

#include <fstream>
#include <iterator>
#include <system_error>

#include "knead/formats/hash.h"

namespace knead::tools {

Input<std::string> read_input_bytes(ToolContext& context, const std::filesystem::path& file) {
    context.add_input(file);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) fail_input(file.string() + ": no such file");
    if (!std::filesystem::is_regular_file(file, ignored)) fail_input(file.string() + ": is not a file");
    std::ifstream stream(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) fail_input(file.string() + ": cannot be read");
    const std::string hash = sha256_of(bytes);
    return {std::move(bytes), hash};
}

}  // namespace knead::tools
