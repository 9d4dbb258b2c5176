// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/source_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>

#include "common/error.h"
#include "knead/formats/hash.h"
#include "mesh/text_reader.h"

namespace knead::tools {

std::string SourceFiles::read(const std::filesystem::path& file, const std::string& role) {
    on_read_(file);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) fail_input("no such file");
    if (!std::filesystem::is_regular_file(file, ignored)) fail_input("is not a file");
    std::ifstream stream(file, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) fail_input("cannot be read");
    hashes_.emplace_back(role, sha256_of(content));
    return content;
}

IncludeReader SourceFiles::include_reader(const std::filesystem::path& file) {
    return [this, file](const std::string& name) {
        std::error_code error;
        const auto folder =
            std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path(), error);
        const auto target = std::filesystem::canonical(folder / name, error);
        if (error) fail_input("*INCLUDE " + in_quotes(name) + ": no such file");
        const auto [in_folder, rest] =
            std::mismatch(folder.begin(), folder.end(), target.begin(), target.end());
        if (in_folder != folder.end())
            fail_input("*INCLUDE " + in_quotes(name) + " lies outside of the folder of the file: refused");
        return read(target, "include");
    };
}

}  // namespace knead::tools
