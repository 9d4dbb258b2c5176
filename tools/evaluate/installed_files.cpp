// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/installed_files.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/error.h"
#include "evaluate/html_report.h"

namespace knead::tools {
namespace {

std::filesystem::path template_file() {
    return html_template_path(std::filesystem::read_symlink("/proc/self/exe"));
}

}  // namespace

std::string page_template() {
    std::ifstream stream(template_file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string required_page_template() {
    std::string text = page_template();
    if (text.empty())
        fail_result(template_file().string() +
                    ": the page is not there, so --html cannot be written: it is made by the target "
                    "knead_report_page, which needs npm");
    return text;
}

nlohmann::ordered_json papers_numbers() {
    const auto file = template_file().replace_filename("paper.json");
    std::ifstream stream(file);
    auto json = nlohmann::ordered_json::parse(stream, nullptr, false);
    if (!json.is_object()) fail_result(file.string() + ": the paper's numbers are not there");
    return json;
}

}  // namespace knead::tools
