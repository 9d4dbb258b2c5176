// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/error.h"
#include "common/length.h"
#include "knead/formats/read.h"

namespace knead::tools {

/// What run_tool() needs to know about a program.
struct ToolInfo {
    std::string name;                    ///< "knead-overlap"
    std::string purpose;                 ///< one line of --help
    std::string example;                 ///< one line of --help
    std::vector<std::string> libraries;  ///< versions for --version: "CGAL 5.5.1"
    bool writes_report = true;           ///< offers --report FILE
    bool writes_depfile = true;          ///< offers --depfile FILE
    bool uses_threads = false;           ///< offers -j,--threads N
    bool uses_seed = false;              ///< offers --seed N
};

/// What the common options said, and the way to speak to the user. One per run.
class ToolContext {
  public:
    unsigned threads = 1;  ///< >= 1
    std::uint64_t seed = 1;
    bool quiet = false;
    bool verbose = false;
    std::filesystem::path report_file;  ///< empty: none wanted
    std::filesystem::path depfile;      ///< empty: none wanted

    explicit ToolContext(const ToolInfo& info) : info_(info) {}

    /// "tool: text" on stderr, unless --quiet.
    void tell(std::string_view text) const;
    /// Only with --verbose.
    void detail(std::string_view text) const;
    /// "tool: warning: text" on stderr, also with --quiet.
    void warn(std::string_view text) const;

    /// Remembers a file that the result depends on, for the depfile. Call before reading it.
    void add_input(const std::filesystem::path& file) { inputs_.push_back(file); }
    /// Remembers the output that the depfile is about.
    void set_output(const std::filesystem::path& file) { output_ = file; }
    /// Writes the report where --report said; `json` is ignored when it said nothing.
    void write_report(const std::string& json) const;

    /// Provenance with tool, version and seed (if the tool has one) filled in.
    [[nodiscard]] Provenance provenance(std::vector<std::string> canonical_arguments) const;

    [[nodiscard]] const ToolInfo& info() const noexcept { return info_; }
    /// Called by run_tool() after a successful body.
    void write_depfile() const;

  private:
    const ToolInfo& info_;
    std::vector<std::filesystem::path> inputs_;
    std::filesystem::path output_;
};

/// The frame of every main(): declares the common options next to the tool's own, parses, runs, and turns
/// every outcome into a message on stderr and an exit code. Nothing escapes.
///
/// @param declare adds the tool's own options to the parser
/// @param body reads, calls the algorithm, writes; throws ToolError
int run_tool(int argc, char** argv, const ToolInfo& info, const std::function<void(CLI::App&)>& declare,
             const std::function<ExitCode(ToolContext&)>& body);

/// Refuses an output whose folder does not exist, before any work is done.
void require_writable_folder(const std::filesystem::path& output);

}  // namespace knead::tools
