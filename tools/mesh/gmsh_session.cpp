// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_session.h"

#include <fcntl.h>
#include <gmsh.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <vector>

#include "common/error.h"

namespace knead::tools {
namespace {

/// OpenCASCADE reports on std::cout, which belongs to the tool's result.
class QuietStdout {
  public:
    QuietStdout() : saved_(std::cout.rdbuf(nullptr)) {}
    ~QuietStdout() {
        std::cout.rdbuf(saved_);
        std::cout.clear();
    }
    QuietStdout(const QuietStdout&) = delete;
    QuietStdout& operator=(const QuietStdout&) = delete;

  private:
    std::streambuf* saved_;
};

/// gmsh keeps what it says while one of these lives.
class Log {
  public:
    Log() { gmsh::logger::start(); }
    ~Log() { gmsh::logger::stop(); }
    Log(const Log&) = delete;
    Log& operator=(const Log&) = delete;
};

std::string first_logged_error() {
    std::vector<std::string> log;
    gmsh::logger::get(log);
    for (const std::string& line : log)
        if (line.starts_with("Error")) return line;
    return {};
}

}  // namespace

GmshSession::GmshSession() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("General.SaveSession", 0);
    gmsh::option::setNumber("General.SaveOptions", 0);
    gmsh::option::setNumber("Geometry.OCCParallel", 0);
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
    gmsh::option::setNumber("Mesh.Algorithm", 6);    // frontal Delaunay
    gmsh::option::setNumber("Mesh.Algorithm3D", 1);  // Delaunay
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.ElementOrder", 1);
    gmsh::option::setNumber("Mesh.Optimize", 1);
    // One size everywhere, the one asked for.
    gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
    gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", 0);
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
}

GmshSession::~GmshSession() {
    try {
        gmsh::finalize();
    } catch (...) {  // nothing left to save
    }
}

void call_gmsh(ExitCode code, const std::string& what, const std::function<void()>& calls) {
    const auto fail = [&](const std::string& words) {
        throw ToolError(code, what + (words.empty() ? "" : ": " + words));
    };
    const QuietStdout quiet;
    const Log log;
    try {
        calls();
    } catch (const ToolError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail(error.what());
    } catch (const std::string& words) {
        fail(words);
    } catch (...) {
        fail(first_logged_error());
    }
    const std::string error = first_logged_error();
    if (!error.empty()) fail(error);
}

void require_no_crash(const std::function<void()>& calls) {
    const pid_t child = fork();
    if (child < 0) fail_result("cannot start a process to read the file in");
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        const rlimit no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        try {
            calls();
        } catch (...) {  // the real run says what it is
        }
        _exit(0);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) fail_input("the file is damaged: gmsh crashes on it");
}

std::string gmsh_version() {
    return "gmsh API " GMSH_API_VERSION;
}

PrivateCopy::PrivateCopy(std::string_view content, const std::string& extension) {
    std::string pattern = (std::filesystem::temp_directory_path() / "knead-mesh-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
        throw ToolError(ExitCode::cannot_write, pattern + ": cannot make a folder for temporary files");
    folder_ = pattern;
    file_ = folder_ / ("content" + extension);
    std::ofstream stream(file_, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
        throw ToolError(ExitCode::cannot_write, file_.string() + ": cannot write a temporary file");
    }
}

PrivateCopy::~PrivateCopy() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

}  // namespace knead::tools
