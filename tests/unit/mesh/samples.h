// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <string>

#include "common/error.h"

namespace knead::tools::test {

/// Expects a ToolError with this code whose message holds `text`.
#define KNEAD_EXPECT_REFUSAL(statement, expected_code, text)                                \
    try {                                                                                   \
        (void)(statement);                                                                  \
        ADD_FAILURE() << "not refused: " #statement;                                        \
    } catch (const ::knead::tools::ToolError& error) {                                      \
        EXPECT_EQ(error.code(), ::knead::tools::ExitCode::expected_code) << error.what();   \
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what(); \
    }

/// The corners and the twelve outward triangles of the cube [low, high]^3.
inline constexpr int kCubeTriangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                              {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                              {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
inline double cube_corner(int corner, int axis, double low, double high) {
    return (corner >> axis & 1) != 0 ? high : low;
}

/// Text STL of the cube; `leave_out` of its triangles are missing.
inline std::string cube_stl(double low, double high, int leave_out = 0) {
    std::string text = "solid cube\n";
    for (int t = 0; t < 12 - leave_out; ++t) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const int corner : kCubeTriangles[t]) {
            text += "  vertex";
            for (int axis = 0; axis < 3; ++axis)
                text += " " + std::to_string(cube_corner(corner, axis, low, high));
            text += "\n";
        }
        text += " endloop\nendfacet\n";
    }
    return text + "endsolid cube\n";
}

inline void append_float(std::string& bytes, float value) {
    char buffer[4];
    std::memcpy(buffer, &value, 4);
    bytes.append(buffer, 4);
}

inline std::string cube_stl_binary(float low, float high) {
    std::string bytes(80, 's');
    const std::uint32_t count = 12;
    bytes.append(reinterpret_cast<const char*>(&count), 4);
    for (const auto& triangle : kCubeTriangles) {
        for (int i = 0; i < 3; ++i)
            append_float(bytes, 0);
        for (const int corner : triangle)
            for (int axis = 0; axis < 3; ++axis)
                append_float(bytes, static_cast<float>(cube_corner(corner, axis, low, high)));
        bytes.append(2, '\0');
    }
    return bytes;
}

/// PLY of the cube with quadrangular faces.
inline std::string cube_ply(double low, double high) {
    std::string text =
        "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\n"
        "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
    for (int corner = 0; corner < 8; ++corner) {
        for (int axis = 0; axis < 3; ++axis)
            text += std::to_string(cube_corner(corner, axis, low, high)) + " ";
        text += "\n";
    }
    return text + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
}

/// The same, binary, big- or little-endian.
inline std::string cube_ply_binary(float low, float high, bool big_endian) {
    std::string bytes =
        std::string("ply\nformat ") + (big_endian ? "binary_big_endian" : "binary_little_endian") +
        " 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 12\n"
        "property list uchar int vertex_index\nend_header\n";
    const auto append = [&](const void* value, std::size_t size) {
        std::string raw(static_cast<const char*>(value), size);
        if (big_endian) raw.assign(raw.rbegin(), raw.rend());
        bytes += raw;
    };
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
            const auto x = static_cast<float>(cube_corner(corner, axis, low, high));
            append(&x, 4);
        }
    for (const auto& triangle : kCubeTriangles) {
        bytes += '\3';
        for (const std::int32_t corner : triangle)
            append(&corner, 4);
    }
    return bytes;
}

/// One tetrahedron and a triangle, version 2.2, in physical volume 7.
inline std::string small_msh() {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
           "$Elements\n2\n1 2 2 3 3 1 2 3\n2 4 2 7 7 1 2 3 4\n$EndElements\n";
}

inline std::string small_medit() {
    return "MeshVersionFormatted 2\n# a comment\nDimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 "
           "0\n1 1 1 0\n"
           "Triangles\n1\n1 2 3 0\nTetrahedra\n2\n1 2 3 4 10\n2 3 4 5 20\nEnd\n";
}

inline std::string small_vtk() {
    return "# vtk DataFile Version 3.0\nsmall\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 "
           "0 1 0\n"
           "0 0 1 1 1 1\nCELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 3\n5\n10\n10\n"
           "CELL_DATA 3\nSCALARS stiffness double 1\nLOOKUP_TABLE default\n1 2 3\nVECTORS fibre float\n1 0 0 "
           "1 0 0 1 0 0\n"
           "POINT_DATA 5\nSCALARS height float\nLOOKUP_TABLE default\n0 0 0 1 1\n";
}

inline std::string small_veg() {
    return "# a comment\n*VERTICES\n5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n"
           "*ELEMENTS\nTET\n2 4 0\n1 1 2 3 4\n2 2 3 4 5\n"
           "*SET inner\n2\n*SET outer\n1,\n*MATERIAL soft # beside a line\nENU, 1000, 5000, 0.3\n"
           "*MATERIAL hard\nENU, 1100, 40000, 0.45\n*REGION\nouter, hard\n*REGION\ninner, soft\n";
}

}  // namespace knead::tools::test
