# SPDX-License-Identifier: Apache-2.0
"""Opens one file of each kind with VTK's own VTKHDF reader. Exit status 77: VTK is not installed.

Usage: vtk_test.py PROGRAM, where PROGRAM writes the samples into the folder that it is given.
"""
import subprocess
import sys
import tempfile

try:
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError:
    print("skipped: VTK with vtkHDFReader is not installed for this Python (Debian: python3-vtk9)")
    sys.exit(77)

MATERIAL = ["youngs_modulus_pa", "poissons_ratio", "density_kg_per_m3"]
MESH = ["region", "E_in_kPa"]
EXPECTED = {
    "mesh.hdf": MESH,
    "material.hdf": MESH + MATERIAL + ["bin"],
    "clustering.hdf": MESH + MATERIAL + ["material_bin", "bin", "cluster"],
    "asset.hdf": ["material_index"],
}
SIDE, NODES, CELLS, TETRAHEDRON = 4, 125, 384, 10
VOLUME_M3, TOLERANCE = 0.1**3, 1e-12  # sum of 384 float64 volumes


def volume(grid):
    total = 0.0
    for i in range(grid.GetNumberOfCells()):
        ids = grid.GetCell(i).GetPointIds()
        a, b, c, d = (grid.GetPoint(ids.GetId(k)) for k in range(4))
        u, v, w = ([p[x] - a[x] for x in range(3)] for p in (b, c, d))
        total += (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
                  + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6
    return total


def check(path, names):
    reader = vtkHDFReader()
    assert reader.CanReadFile(path), path
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfPoints() == NODES, grid.GetNumberOfPoints()
    assert grid.GetNumberOfCells() == CELLS, grid.GetNumberOfCells()
    assert all(grid.GetCellType(i) == TETRAHEDRON for i in range(CELLS))
    assert abs(volume(grid) / VOLUME_M3 - 1) < TOLERANCE, volume(grid)
    data = grid.GetCellData()
    found = sorted(data.GetArrayName(i) for i in range(data.GetNumberOfArrays()))
    assert found == sorted(names), (path, found)
    for name in names:
        assert data.GetArray(name).GetNumberOfTuples() == CELLS, name
    return data


with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.argv[1], folder], check=True)
    for file, names in EXPECTED.items():
        data = check(folder + "/" + file, names)
        if file == "material.hdf":
            assert [data.GetArray("youngs_modulus_pa").GetValue(i) for i in range(2)] == [2200.0, 22000.0]
            assert [data.GetArray("bin").GetValue(i) for i in range(2)] == [0, 1]
    assert not vtkHDFReader().CanReadFile(folder + "/overlap.hdf")
print("VTK reads", ", ".join(EXPECTED))
