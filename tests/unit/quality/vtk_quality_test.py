# SPDX-License-Identifier: Apache-2.0
"""Compares what knead-mesh reports of random tetrahedra with VTK's vtkMeshQuality. Exit status 77: no VTK.

Angles are compared with a computation of this file: MinAngle of VTK 9.1 does not look at all six edges.

Usage: vtk_quality_test.py KNEAD_MESH
"""
import json
import math
import random
import subprocess
import sys
import tempfile

try:
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
except ImportError:
    print("skipped: VTK is not installed for this Python (Debian: python3-vtk9)")
    sys.exit(77)

COUNT = 200
FLAT = 1e-3  # volume over the cube of the longest edge: flatter ones knead-mesh may refuse
RELATIVE = 1e-9  # both compute in double; of thin tetrahedra about six digits are lost in differences


def volume(a, b, c, d):
    u, v, w = ([p[k] - a[k] for k in range(3)] for p in (b, c, d))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
            + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6


def dihedral_angles(nodes):
    """Degrees, at the six edges: what is left of the other two nodes square to the edge."""
    angles = []
    for i, j in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)):
        edge = [nodes[j][k] - nodes[i][k] for k in range(3)]
        size = math.sqrt(sum(x * x for x in edge))
        sides = []
        for other in {0, 1, 2, 3} - {i, j}:
            arm = [nodes[other][k] - nodes[i][k] for k in range(3)]
            along = sum(a * e for a, e in zip(arm, edge)) / size
            sides.append([a - along * e / size for a, e in zip(arm, edge)])
        u, v = sides
        cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        angles.append(math.degrees(math.atan2(math.sqrt(sum(x * x for x in cross)),
                                              sum(a * b for a, b in zip(u, v)))))
    return angles


def tetrahedra():
    """Of all shapes, some thin; each with nodes of its own, beside the others."""
    draw = random.Random(1)
    found = []
    while len(found) < COUNT:
        thin = draw.choice([1, 1, 0.1, 0.02])
        nodes = [[draw.random() + 2 * len(found), draw.random(), thin * draw.random()] for _ in range(4)]
        size = volume(*nodes)
        if abs(size) < FLAT * thin:
            continue
        found.append(nodes if size > 0 else [nodes[1], nodes[0], nodes[2], nodes[3]])
    return found


def measure(found, name):
    points, grid = vtkPoints(), vtkUnstructuredGrid()
    points.SetDataTypeToDouble()
    for nodes in found:
        for node in nodes:
            points.InsertNextPoint(node)
    grid.SetPoints(points)
    for t in range(len(found)):
        grid.InsertNextCell(VTK_TETRA, 4, [4 * t + k for k in range(4)])
    quality = vtkMeshQuality()
    quality.SetInputData(grid)
    getattr(quality, "SetTetQualityMeasureTo" + name)()
    quality.Update()
    values = quality.GetOutput().GetCellData().GetArray("Quality")
    return [values.GetValue(t) for t in range(len(found))]


def close(name, found, expected):
    print(name, found, expected)
    assert abs(found - expected) <= RELATIVE * abs(expected), name


with tempfile.TemporaryDirectory() as folder:
    found = tetrahedra()
    with open(folder + "/t.vtk", "w", encoding="ascii") as file:
        file.write("# vtk DataFile Version 3.0\ntetrahedra\nASCII\nDATASET UNSTRUCTURED_GRID\n")
        file.write(f"POINTS {4 * COUNT} double\n")
        for nodes in found:
            for node in nodes:
                file.write("%r %r %r\n" % tuple(node))
        file.write(f"CELLS {COUNT} {5 * COUNT}\n")
        for t in range(COUNT):
            file.write("4 %d %d %d %d\n" % tuple(4 * t + k for k in range(4)))
        file.write(f"CELL_TYPES {COUNT}\n" + "10\n" * COUNT)
    subprocess.run([sys.argv[1], "import", folder + "/t.vtk", "--length-unit", "m", "-o", folder + "/t.hdf",
                    "--report", folder + "/t.json", "--quiet"], check=True)
    with open(folder + "/t.json", encoding="utf-8") as file:
        report = json.load(file)["quality"]
    ratios = [1 / value for value in measure(found, "RadiusRatio")]  # VTK's is circumscribed / (3 inscribed)
    shapes = measure(found, "Shape")  # Verdict's name of the mean ratio
    angles = [min(dihedral_angles(nodes)) for nodes in found]
    close("lowest radius ratio", report["radius_ratio"]["min"], min(ratios))
    close("mean radius ratio", report["radius_ratio"]["mean"], sum(ratios) / COUNT)
    close("lowest mean ratio", report["mean_ratio"]["min"], min(shapes))
    close("mean mean ratio", report["mean_ratio"]["mean"], sum(shapes) / COUNT)
    close("sharpest dihedral angle", report["dihedral_deg"]["min"], min(angles))
    close("widest dihedral angle", report["dihedral_deg"]["max"], max(max(dihedral_angles(n)) for n in found))
    close("worst tetrahedron", report["worst"][0]["tetrahedron"], ratios.index(min(ratios)))
    histogram = [sum(min(int(r * 10), 9) == k for r in ratios) for k in range(10)]
    assert report["radius_ratio"]["histogram"] == histogram, histogram
    sharpest = [sum(int(a / 10) == k for a in angles) for k in range(8)]
    assert report["dihedral_deg"]["sharpest_histogram"] == sharpest, sharpest
