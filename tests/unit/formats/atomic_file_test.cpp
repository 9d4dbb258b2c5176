// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <functional>

#include "samples.h"

namespace knead::test {
namespace {

/// Runs `body` in a process of its own that may not write files beyond `bytes`, as on a full disk.
/// @return what the body returned
int with_file_size_limit(rlim_t bytes, const std::function<bool()>& body) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, bytes};
        if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(2);
        ::_exit(body() ? 1 : 0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Writer_on_a_full_disk, Reports_cannot_write_and_leaves_the_old_file_alone) {
    const Folder folder;
    const auto file = folder / "asset.hdf";
    ASSERT_TRUE(write_asset(file, sample_asset(), {}).ok());
    const std::vector<char> before = bytes_of(file);
    for (const rlim_t limit : {0, 100, 4096, 10000}) {
        const int refused = with_file_size_limit(limit, [&] {
            const Status status = write_asset(file, sample_asset(6), {});
            return !status.ok() && status.error().code == ErrorCode::cannot_write &&
                   status.error().text().find("asset.hdf") != std::string::npos;
        });
        EXPECT_EQ(refused, 1) << limit;
        EXPECT_EQ(bytes_of(file), before) << limit;
        EXPECT_EQ(folder.entries(), 1U) << limit;
    }
}

TEST(Writer_of_invalid_data, Writes_nothing) {
    const Folder folder;
    TetMesh mesh = sample_mesh();
    mesh.nodes_m.push_back({});
    const Status status = write_tet_mesh(folder / "mesh.hdf", mesh, {});
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::invalid_data);
    EXPECT_NE(status.error().text().find("mesh.hdf#/knead/mesh/nodes_m"), std::string::npos)
        << status.error().text();
    EXPECT_EQ(folder.entries(), 0U);
}

TEST(Writer, Into_a_missing_folder_reports_cannot_write) {
    const Folder folder;
    const Status status = write_text_file(folder / "none/report.json", "{}");
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::cannot_write);
}

TEST(Writer, Over_a_folder_or_device_reports_cannot_write) {
    const Folder folder;
    for (const std::filesystem::path& target : {folder.path(), std::filesystem::path("/dev/full")}) {
        const Status status = write_text_file(target, "{}");
        ASSERT_FALSE(status.ok()) << target;
        EXPECT_EQ(status.error().code, ErrorCode::cannot_write) << target;
    }
}

TEST(Writer_of_text, Replaces_the_file_and_leaves_nothing_beside_it) {
    const Folder folder;
    ASSERT_TRUE(write_text_file(folder / "a.txt", "long old text").ok());
    ASSERT_TRUE(write_text_file(folder / "a.txt", "new").ok());
    const std::vector<char> expected{'n', 'e', 'w'};
    EXPECT_EQ(bytes_of(folder / "a.txt"), expected);
    EXPECT_EQ(folder.entries(), 1U);
}

}  // namespace
}  // namespace knead::test
