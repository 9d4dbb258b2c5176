// SPDX-License-Identifier: Apache-2.0
// Writes one file of each kind into the folder given, for vtk_test.py.
#include <cstdio>

#include "samples.h"

int main(int argc, char** argv) {
    using namespace knead;
    using namespace knead::test;
    constexpr std::uint32_t kCells = 4;
    if (argc != 2) return 2;
    const std::filesystem::path folder = argv[1];
    const Provenance provenance = sample_provenance();
    for (const Status& status :
         {write_tet_mesh(folder / "mesh.hdf", sample_mesh(kCells), provenance),
          write_material(folder / "material.hdf", sample_material(kCells), provenance),
          write_clustering(folder / "clustering.hdf", sample_clustering(kCells), provenance),
          write_overlap(folder / "overlap.hdf", sample_overlap(), provenance),
          write_asset(folder / "asset.hdf", sample_asset(kCells), provenance)})
        if (!status.ok()) {
            std::fprintf(stderr, "%s\n", status.error().text().c_str());
            return 1;
        }
    return 0;
}
