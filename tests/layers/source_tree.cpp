// SPDX-License-Identifier: Apache-2.0
#include "layers/source_tree.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>

namespace knead::test {
namespace {

namespace fs = std::filesystem;

bool is_source(const fs::path& file) {
    static const std::set<std::string> kExtensions{".h",   ".hpp",   ".inl", ".c",
                                                   ".cpp", ".cmake", ".py",  ".sh"};
    return file.filename() == "CMakeLists.txt" || kExtensions.count(file.extension().string()) > 0;
}

SourceFile read_source(const fs::path& file, std::string path) {
    static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
    SourceFile source{std::move(path), {}, {}};
    std::ifstream stream(file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        if (number == 1 || (number == 2 && source.licence_line.rfind("#!", 0) == 0))
            source.licence_line = line;
        std::smatch match;
        if (std::regex_search(line, match, kInclude))
            source.includes.push_back({number, match[2].str(), match[1].str() == "<"});
    }
    return source;
}

void add_files_of(const fs::path& folder, const fs::path& top, std::vector<SourceFile>& sources) {
    if (!fs::is_directory(folder)) return;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && is_source(entry.path()))
            sources.push_back(read_source(entry.path(), fs::relative(entry.path(), top).generic_string()));
}

}  // namespace

std::vector<SourceFile> read_source_tree(const fs::path& top) {
    std::vector<SourceFile> sources;
    for (const char* folder : {"formats", "runtime", "tools", "tests", "examples", "docs"})
        add_files_of(top / folder, top, sources);
    if (fs::exists(top / "CMakeLists.txt"))
        sources.push_back(read_source(top / "CMakeLists.txt", "CMakeLists.txt"));
    std::sort(sources.begin(), sources.end(),
              [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
    return sources;
}

}  // namespace knead::test
