// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace knead::test {

/// One source file as far as the rules look at it.
struct SourceFile {
    struct Include {
        int line = 0;        ///< counted from 1
        std::string name;    ///< what stands between the quotes or angle brackets
        bool angle = false;  ///< <name> rather than "name"
    };

    std::string path;          ///< from the top of the repository, with '/'
    std::string licence_line;  ///< the first line, or the second one after "#!"
    std::vector<Include> includes;
};

/// Every C, C++, CMake, Python and shell source under the six top-level folders and the top itself, by path.
[[nodiscard]] std::vector<SourceFile> read_source_tree(const std::filesystem::path& top);

}  // namespace knead::test
