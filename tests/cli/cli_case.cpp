// SPDX-License-Identifier: Apache-2.0
#include "cli/cli_case.h"

#include <toml++/toml.h>
#include <algorithm>
#include <stdexcept>

namespace knead::test {
namespace {

namespace fs = std::filesystem;

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
        text.replace(at, what.size(), with);
    return text;
}

[[noreturn]] void fail(const std::string& subject, const std::string& what) {
    throw std::runtime_error(subject + ": " + what);
}

std::string text_of(const toml::node& node, const std::string& subject) {
    const auto text = node.value<std::string>();
    if (!text) fail(subject, "a string is expected");
    return replaced(*text, "@SOURCE@", KNEAD_SOURCE_DIR);
}

std::vector<std::string> texts_of(const toml::node& node, const std::string& subject) {
    const toml::array* array = node.as_array();
    if (array == nullptr) fail(subject, "an array of strings is expected");
    std::vector<std::string> texts;
    for (const toml::node& element : *array)
        texts.push_back(text_of(element, subject));
    return texts;
}

CliCase case_of(const toml::table& table) {
    CliCase result;
    result.name = table["name"].value_or(std::string("unnamed case"));
    bool has_exit = false;
    for (const auto& [key, node] : table) {
        const std::string field(key.str());
        const std::string subject = result.name + ": " + field;
        if (field == "name") continue;
        if (field == "files") {
            for (const auto& [file, content] : *node.as_table())
                result.files[std::string(file.str())] = text_of(content, subject);
        } else if (field == "setup") {
            result.setup = texts_of(node, subject);
        } else if (field == "command") {
            result.command = text_of(node, subject);
        } else if (field == "exit") {
            result.exit_code = static_cast<int>(node.value<std::int64_t>().value());
            has_exit = true;
        } else if (field == "stderr") {
            result.stderr_patterns = texts_of(node, subject);
        } else if (field == "stdout") {
            result.stdout_patterns = texts_of(node, subject);
        } else if (field == "creates") {
            const auto files = texts_of(node, subject);
            result.creates.insert(files.begin(), files.end());
        } else {
            fail(subject, "no such field");
        }
    }
    if (!has_exit || result.command.empty()) fail(result.name, "command and exit are needed");
    return result;
}

/// What the cases of one [[tool]] are made from.
struct ToolUnderTest {
    std::string name;
    std::string subject;  ///< "Overlap", the beginning of the names of its cases
    std::map<std::string, std::string> files;
    std::vector<std::string> setup;
    std::string good;
    std::string input;
    bool writes_report = true;
};

/// Every write beyond a few bytes fails, as on a full disk, instead of ending the program with a signal.
std::string on_full_disk(const std::string& command) {
    return "trap '' XFSZ; ulimit -f 1; " + command;
}

CliCase make_case(const ToolUnderTest& tool, const std::string& what, const std::string& command,
                  int exit_code) {
    CliCase result;
    result.name = tool.subject + "_" + what;
    result.files = tool.files;
    result.setup = tool.setup;
    result.command = command;
    result.exit_code = exit_code;
    return result;
}

std::vector<CliCase> usage_cases_of(const ToolUnderTest& tool) {
    CliCase help = make_case(tool, "asked_for_help_prints_it", tool.name + " --help", 0);
    help.stdout_patterns = {"^" + tool.name + ": ",
                            "Usage: " + tool.name,
                            "-h,--help",
                            "--version",
                            "Example: knead",
                            "Exit status: 0 done, .*2 bad usage, 3 bad input, 4 cannot write"};
    CliCase version = make_case(tool, "asked_for_its_version_prints_it", tool.name + " --version", 0);
    version.stdout_patterns = {"^" + tool.name +
                               " [0-9]+\\.[0-9]+\\.[0-9]+ \\(file format [0-9]+\\.[0-9]+\\)"};
    CliCase nothing = make_case(tool, "without_arguments_is_bad_usage", tool.name, 2);
    nothing.stderr_patterns = {"--help"};
    CliCase unknown = make_case(tool, "with_an_unknown_option_is_bad_usage", tool.good + " --frobnicate", 2);
    unknown.stderr_patterns = {"--frobnicate"};
    return {help, version, nothing, unknown};
}

std::vector<CliCase> output_cases_of(const ToolUnderTest& tool) {
    const std::string again = replaced(tool.good, "out.hdf", "again.hdf");
    CliCase good = make_case(tool, "of_good_input_writes_the_same_bytes_twice",
                             tool.good + " && " + again + " && cmp out.hdf again.hdf", 0);
    good.creates = {"out.hdf", "again.hdf"};
    CliCase nowhere = make_case(tool, "into_a_missing_folder_cannot_write",
                                replaced(tool.good, "out.hdf", "nowhere/out.hdf"), 4);
    nowhere.stderr_patterns = {"nowhere"};
    CliCase full = make_case(tool, "on_a_full_disk_leaves_nothing", on_full_disk(tool.good), 4);
    full.stderr_patterns = {"cannot write|cannot be written|out\\.hdf"};
    CliCase old = make_case(tool, "on_a_full_disk_keeps_the_older_output", on_full_disk(tool.good), 4);
    old.files["out.hdf"] = "older output\n";
    std::vector<CliCase> cases{good, nowhere, full, old};
    if (tool.writes_report) {
        CliCase report =
            make_case(tool, "asked_for_report_and_depfile_writes_both",
                      tool.good + " --report r.json --depfile d.mk && head -c1 r.json && cat d.mk", 0);
        report.stdout_patterns = {"^\\{", "out\\.hdf:"};
        report.creates = {"out.hdf", "r.json", "d.mk"};
        cases.push_back(report);
    }
    return cases;
}

std::vector<CliCase> input_cases_of(const ToolUnderTest& tool) {
    if (tool.input.empty()) return {};
    CliCase missing =
        make_case(tool, "of_a_missing_file_is_refused", replaced(tool.good, tool.input, "missing.in"), 3);
    missing.stderr_patterns = {"missing\\.in"};
    CliCase folder =
        make_case(tool, "of_a_folder_is_refused", replaced(tool.good, tool.input, "folder.in"), 3);
    folder.setup.push_back("mkdir folder.in");
    folder.stderr_patterns = {"folder\\.in"};
    CliCase wrong = make_case(tool, "of_a_file_of_another_format_is_refused",
                              replaced(tool.good, tool.input, "wrong.in"), 3);
    wrong.files["wrong.in"] = "This is a letter to grandmother.\n";
    wrong.stderr_patterns = {"wrong\\.in"};
    CliCase empty =
        make_case(tool, "of_an_empty_file_is_refused", replaced(tool.good, tool.input, "empty.in"), 3);
    empty.files["empty.in"] = "";
    empty.stderr_patterns = {"empty\\.in"};
    return {missing, folder, wrong, empty};
}

ToolUnderTest tool_of(const toml::table& table) {
    ToolUnderTest tool;
    tool.name = table["name"].value_or(std::string());
    tool.subject = table["subject"].value_or(tool.name);
    tool.good = table["good"].value_or(std::string());
    tool.input = table["input"].value_or(std::string());
    tool.writes_report = table["writes_report"].value_or(true);
    if (const toml::node* setup = table.get("setup")) tool.setup = texts_of(*setup, tool.name + ": setup");
    if (const toml::table* files = table["files"].as_table())
        for (const auto& [file, content] : *files)
            tool.files[std::string(file.str())] = text_of(content, tool.name);
    if (tool.name.empty() || tool.good.empty()) fail(tool.name, "a [[tool]] needs name and good");
    return tool;
}

void append(std::vector<CliCase>& cases, const std::vector<CliCase>& more) {
    cases.insert(cases.end(), more.begin(), more.end());
}

}  // namespace

std::vector<CliCase> read_cases(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<CliCase> cases;
    for (const fs::path& file : files) {
        const toml::table table = toml::parse_file(file.string());
        if (const toml::array* tools = table["tool"].as_array())
            for (const toml::node& node : *tools) {
                const ToolUnderTest tool = tool_of(*node.as_table());
                append(cases, usage_cases_of(tool));
                append(cases, output_cases_of(tool));
                append(cases, input_cases_of(tool));
            }
        if (const toml::array* array = table["case"].as_array())
            for (const toml::node& node : *array)
                cases.push_back(case_of(*node.as_table()));
    }
    return cases;
}

}  // namespace knead::test
