// SPDX-License-Identifier: Apache-2.0
// write_cube FILE: writes the cube of the press tests as an asset file, for the tests of C and of consumers.
#include <cstdio>

#include "knead/formats/write/write.h"
#include "unit/runtime/block_asset.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    knead::Provenance provenance;
    provenance.tool = "write_cube";
    provenance.tool_version = "test";
    const auto asset = knead::test::cube_asset(6, knead::ToolShape::plate, knead::ToolContact::bonded);
    const knead::Status status = knead::write_asset(argv[1], asset, provenance);
    if (!status) std::fprintf(stderr, "%s\n", status.error().text().c_str());
    return status ? 0 : 1;
}
