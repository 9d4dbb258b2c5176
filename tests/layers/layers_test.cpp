// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "layers/rules.h"
#include "layers/source_tree.h"

namespace knead::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kApache = "// SPDX-License-Identifier: Apache-2.0\n";
constexpr const char* kGpl = "// SPDX-License-Identifier: GPL-3.0-or-later\n";

/// A tree of small files in a folder of its own, removed afterwards.
class SmallTree {
  public:
    explicit SmallTree(const std::map<std::string, std::string>& files)
        : top_(fs::path(testing::TempDir()) /
               ("knead_layers_" +
                std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
        fs::remove_all(top_);
        for (const auto& [path, text] : files) {
            fs::create_directories((top_ / path).parent_path());
            std::ofstream(top_ / path) << text;
        }
    }
    ~SmallTree() { fs::remove_all(top_); }
    SmallTree(const SmallTree&) = delete;
    SmallTree& operator=(const SmallTree&) = delete;

    [[nodiscard]] std::vector<std::string> violations() const {
        return layer_violations(read_source_tree(top_));
    }

  private:
    fs::path top_;
};

TEST(Layers_of_this_repository, follow_the_architecture) {
    EXPECT_THAT(layer_violations(read_source_tree(KNEAD_SOURCE_DIR)), testing::IsEmpty());
}

TEST(Layers_of_this_repository, are_really_read) {
    const auto sources = read_source_tree(KNEAD_SOURCE_DIR);
    EXPECT_GT(sources.size(), 50U);
    const auto file = std::find_if(sources.begin(), sources.end(), [](const SourceFile& source) {
        return source.path == "tools/overlap/exact.cpp";
    });
    ASSERT_NE(file, sources.end());
    EXPECT_THAT(file->includes, testing::Contains(testing::Field(&SourceFile::Include::name,
                                                                 testing::Eq("CGAL/Exact_rational.h"))));
}

TEST(Layers_of_a_good_tree, have_no_violation) {
    const SmallTree tree({
        {"formats/include/knead/formats/a.h", std::string(kApache) + "#include <vector>\n"},
        {"formats/include/knead/formats/write/w.h",
         std::string(kApache) + "#include \"knead/formats/a.h\"\n"},
        {"formats/src/h5.h", std::string(kApache) + "#include <hdf5.h>\n#include <unistd.h>\n"},
        {"formats/src/write/w.cpp",
         std::string(kApache) +
             "#include \"knead/formats/write/w.h\"\n#include \"h5.h\"\n#include <sys/stat.h>\n"},
        {"runtime/src/core/c.h",
         std::string(kApache) + "#include <Eigen/Core>\n#include \"knead/formats/a.h\"\n"},
        {"runtime/src/core/simd/k.inl",
         std::string(kApache) + "#include <immintrin.h>\n#include <xmmintrin.h>\n#include \"core/c.h\"\n"},
        {"runtime/src/haptics/l.cpp",
         std::string(kApache) + "#include <thread>\n#include \"knead/runtime/simulation.h\"\n"},
        {"tools/touch/t.cpp", std::string(kGpl) + "#include \"knead/haptics/haptic_loop.h\"\n"},
        {"tools/mesh/m.cpp", std::string(kGpl) + "#include <gmsh.h>\n#include \"common/error.h\"\n"},
        {"tools/mesh/main.cpp", std::string(kGpl) + "#include \"common/run_tool.h\"\n"},
        {"tools/evaluate/e.cpp", std::string(kGpl) + "#include \"knead/runtime/simulation.h\"\n"},
        {"tests/unit/overlap/o.cpp", std::string(kApache) + "#include <CGAL/version.h>\n"},
        {"examples/steak/run.py", "#!/usr/bin/env python3\n# SPDX-License-Identifier: Apache-2.0\n"},
        {"runtime/include/knead/knead.h", "/* SPDX-License-Identifier: Apache-2.0 */\n#include <stdint.h>\n"},
    });
    EXPECT_THAT(tree.violations(), testing::IsEmpty());
}

/// A file, an offending include line in it, and a part of the complaint.
struct Offence {
    const char* path;
    const char* include;
    const char* complaint;
};

class Layers_with_one_offence : public testing::TestWithParam<Offence> {};

TEST_P(Layers_with_one_offence, name_the_file_the_line_and_the_rule) {
    const Offence& offence = GetParam();
    const bool gpl = std::string_view(offence.path).substr(0, 6) == "tools/";
    const SmallTree tree(
        {{offence.path, std::string(gpl ? kGpl : kApache) + "\n#include " + offence.include + "\n"},
         {"formats/src/write/atomic_file.h", kApache}});
    EXPECT_THAT(tree.violations(),
                testing::ElementsAre(testing::AllOf(testing::StartsWith(std::string(offence.path) + ":3: "),
                                                    testing::HasSubstr(offence.complaint))));
}

constexpr Offence kOffences[] = {
    {"formats/src/a.cpp", "\"knead/runtime/simulation.h\"", "formats may include"},
    {"formats/src/a.cpp", "\"knead/formats/write/write.h\"", "its writers"},
    {"formats/src/a.cpp", "\"write/atomic_file.h\"", "its writers"},
    {"formats/src/a.cpp", "\"common/error.h\"", "formats may include"},
    {"formats/src/a.cpp", "<Eigen/Core>", "formats may include"},
    {"formats/src/a.cpp", "<boost/version.hpp>", "formats may include"},
    {"formats/include/knead/formats/a.h", "<hdf5.h>", "must not show HDF5"},
    {"runtime/src/load/a.cpp", "\"knead/formats/write/write.h\"", "the writers"},
    {"runtime/src/load/a.cpp", "\"cluster/kmeans.h\"", "the runtime may include"},
    {"runtime/src/load/a.cpp", "<hdf5.h>", "the runtime may include"},
    {"runtime/src/load/a.cpp", "<fmt/format.h>", "the runtime may include"},
    {"runtime/include/knead/runtime/a.h", "<Eigen/Core>", "must not show Eigen"},
    {"runtime/src/core/a.cpp", "<thread>", "must not include threads"},
    {"runtime/src/core/a.cpp", "<mutex>", "must not include threads"},
    {"runtime/src/core/a.cpp", "\"knead/formats/read.h\"", "must not include readers"},
    {"runtime/src/core/a.inl", "<thread>", "must not include threads"},
    {"runtime/src/core/a.inl", "<fmt/format.h>", "the runtime may include"},
    {"formats/src/a.inl", "\"common/error.h\"", "formats may include"},
    {"runtime/src/core/simd/a.h", "\"immintrin.h\"", "the runtime may include"},
    {"runtime/src/core/simd/a.h", "<arm_neon.h>", "the runtime may include"},
    {"runtime/src/haptics/a.cpp", "\"core/step.h\"", "the haptics see of the runtime"},
    {"runtime/src/simulation.cpp", "\"knead/haptics/haptic_loop.h\"", "the simulation must not include"},
    {"runtime/src/haptics/a.cpp", "<immintrin.h>", "the runtime may include"},
    {"runtime/src/a.cpp", "<xmmintrin.h>", "the runtime may include"},
    {"runtime/include/knead/runtime/a.h", "<immintrin.h>", "the runtime may include"},
    {"formats/src/a.cpp", "<immintrin.h>", "formats may include"},
    {"tools/bake/a.cpp", "\"knead/runtime/simulation.h\"", "tools must not include the runtime"},
    {"tools/bake/a.cpp", "\"knead/haptics/device.h\"", "tools must not include the runtime"},
    {"tools/bake/main.cpp", "\"knead/knead.h\"", "tools must not include the runtime"},
    {"tools/bake/a.cpp", "\"common/run_tool.h\"", "of common only"},
    {"tools/bake/a.h", "<gmsh.h>", "only tools/mesh"},
    {"tools/coarsen/a.cpp", "<CGAL/Epick.h>", "only tools/overlap"},
    {"tools/overlap/a.cpp", "<metis.h>", "only tools/bake"},
    {"tests/unit/coarsen/a.cpp", "<CGAL/Epick.h>", "only tools/overlap"},
    {"examples/steak/a.cpp", "\"knead/formats/write/write.h\"", "examples must not"},
    {"formats/src/a.cpp", "\"../src/write/atomic_file.h\"", "its writers"},
};

INSTANTIATE_TEST_SUITE_P(each, Layers_with_one_offence, testing::ValuesIn(kOffences));

TEST(Layers_with_a_core_file_that_includes_hdf5, break_two_rules) {
    const SmallTree tree({{"runtime/src/core/a.cpp", std::string(kApache) + "#include <hdf5.h>\n"}});
    EXPECT_THAT(tree.violations(),
                testing::UnorderedElementsAre(testing::HasSubstr("the core must not include HDF5"),
                                              testing::HasSubstr("the runtime may include")));
}

TEST(Layers_with_a_wrong_licence_line, name_the_file) {
    const SmallTree tree({
        {"formats/src/gpl.cpp", kGpl},
        {"tools/mesh/apache.cpp", kApache},
        {"tests/none.cpp", "#include <vector>\n"},
        {"examples/empty/CMakeLists.txt", ""},
        {"tools/mesh/CMakeLists.txt", "# SPDX-License-Identifier: GPL-3.0-or-later\n"},
    });
    EXPECT_THAT(tree.violations(),
                testing::ElementsAre(testing::StartsWith("examples/empty/CMakeLists.txt:1: "),
                                     testing::StartsWith("formats/src/gpl.cpp:1: "),
                                     testing::StartsWith("tests/none.cpp:1: "),
                                     testing::StartsWith("tools/mesh/apache.cpp:1: ")));
}

}  // namespace
}  // namespace knead::test
