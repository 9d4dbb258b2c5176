// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "common/exit_code.h"

namespace knead::tools {

/// gmsh is one global state. A session starts it fresh, silent, without the user's configuration files, on
/// one thread and with fixed algorithms and seeds, so that the same input gives the same mesh; and ends it.
/// At most one at a time in a process.
class GmshSession {
  public:
    GmshSession();
    ~GmshSession();
    GmshSession(const GmshSession&) = delete;
    GmshSession& operator=(const GmshSession&) = delete;
};

/// Runs calls to gmsh and turns everything it throws or logs as an error into a ToolError: `what` and gmsh's
/// words.
void call_gmsh(ExitCode code, const std::string& what, const std::function<void()>& calls);

/// Tries calls out in a child process first and refuses the input (bad_input) when they crash it: the readers
/// of gmsh and OpenCASCADE fall over some damaged files. Other failures of the child are left for the real
/// run to report. Call outside of a GmshSession.
void require_no_crash(const std::function<void()>& calls);

/// Version for --version: "gmsh API 4.8.0".
[[nodiscard]] std::string gmsh_version();

/// A copy of content in a private folder, under a name of our choice: what gmsh reads is what was recognised,
/// and it finds none of the files beside the original (gmsh runs FILE.opt as a script when it reads FILE).
class PrivateCopy {
  public:
    PrivateCopy(std::string_view content, const std::string& extension);
    ~PrivateCopy();
    PrivateCopy(const PrivateCopy&) = delete;
    PrivateCopy& operator=(const PrivateCopy&) = delete;
    [[nodiscard]] std::string path() const { return file_.string(); }

  private:
    std::filesystem::path folder_;
    std::filesystem::path file_;
};

}  // namespace knead::tools
