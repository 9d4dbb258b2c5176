// SPDX-License-Identifier: GPL-3.0-or-later
// What the pictures need of a tetrahedral mesh: the boundary of a part of it, and its section by a plane.

/** Corners of the faces, each opposite the corner of the same index, seen counter-clockwise from outside. */
const kFaces = [
    [1, 2, 3],
    [0, 3, 2],
    [0, 1, 3],
    [0, 2, 1],
];
const kEdges = [
    [0, 1],
    [0, 2],
    [0, 3],
    [1, 2],
    [1, 3],
    [2, 3],
];

/** For each tetrahedron and face the tetrahedron behind it, or -1 on the surface. */
export function neighbours(tetrahedra) {
    const behind = new Int32Array(tetrahedra.length).fill(-1);
    const open = new Map();
    for (let face = 0; face < tetrahedra.length; ++face) {
        const tet = face >> 2;
        const key = kFaces[face & 3]
            .map((c) => tetrahedra[4 * tet + c])
            .sort((a, b) => a - b)
            .join();
        const other = open.get(key);
        if (other === undefined) {
            open.set(key, face);
        } else {
            behind[face] = other >> 2;
            behind[other] = tet;
            open.delete(key);
        }
    }
    return behind;
}

export function centroids(mesh, axis) {
    const result = new Float64Array(mesh.tetrahedra.length / 4);
    for (let t = 0; t < result.length; ++t)
        for (let c = 0; c < 4; ++c) result[t] += mesh.nodes[3 * mesh.tetrahedra[4 * t + c] + axis] / 4;
    return result;
}

export function bounds(nodes) {
    const low = [Infinity, Infinity, Infinity],
        high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < nodes.length; ++i) {
        low[i % 3] = Math.min(low[i % 3], nodes[i]);
        high[i % 3] = Math.max(high[i % 3], nodes[i]);
    }
    return { low, high };
}

/**
 * The boundary of the tetrahedra that `kept(t)` says: whole tetrahedra go, and the faces that this lays open are
 * drawn, so the rest stays solid. Returns node indices, three per triangle, and the tetrahedron of each triangle.
 */
export function boundary(mesh, behind, kept) {
    const corners = [],
        owners = [];
    for (let face = 0; face < behind.length; ++face) {
        const tet = face >> 2;
        if (!kept(tet) || (behind[face] >= 0 && kept(behind[face]))) continue;
        const nodes = kFaces[face & 3].map((c) => mesh.tetrahedra[4 * tet + c]);
        if (pointsInwards(mesh, nodes, mesh.tetrahedra[4 * tet + (face & 3)])) nodes.reverse();
        corners.push(...nodes);
        owners.push(tet);
    }
    return { corners, owners };
}

function pointsInwards({ nodes }, [a, b, c], inside) {
    const at = (i, from) => [0, 1, 2].map((k) => nodes[3 * i + k] - nodes[3 * from + k]);
    const u = at(b, a),
        v = at(c, a),
        w = at(inside, a);
    return (
        (u[1] * v[2] - u[2] * v[1]) * w[0] +
            (u[2] * v[0] - u[0] * v[2]) * w[1] +
            (u[0] * v[1] - u[1] * v[0]) * w[2] >
        0
    );
}

/**
 * The polygons in which the plane `axis` = `position` meets the tetrahedra. A node on the plane counts as above,
 * so a plane along mesh faces shows the tetrahedra below it, each once. Points are the two other coordinates.
 */
export function section(mesh, axis, position) {
    const [u, v] = [0, 1, 2].filter((k) => k !== axis);
    const polygons = [];
    const { nodes, tetrahedra } = mesh;
    for (let tet = 0; tet < tetrahedra.length / 4; ++tet) {
        const points = [];
        for (const [a, b] of kEdges) {
            const i = 3 * tetrahedra[4 * tet + a],
                j = 3 * tetrahedra[4 * tet + b];
            const da = nodes[i + axis] - position,
                db = nodes[j + axis] - position;
            if (da < 0 === db < 0) continue;
            const s = da / (da - db);
            points.push([
                nodes[i + u] + s * (nodes[j + u] - nodes[i + u]),
                nodes[i + v] + s * (nodes[j + v] - nodes[i + v]),
            ]);
        }
        if (points.length >= 3) polygons.push({ tet, points: aroundTheirMiddle(points) });
    }
    return polygons.filter((polygon) => polygon.points.length > 0);
}

/** The points in clockwise order, or none where they span no area. */
function aroundTheirMiddle(points) {
    const middle = [0, 1].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
    const angle = (p) => Math.atan2(p[1] - middle[1], p[0] - middle[0]);
    points.sort((a, b) => angle(b) - angle(a));
    let twice = 0,
        size = 0;
    points.forEach((p, i) => {
        const q = points[(i + 1) % points.length];
        twice += (p[0] - middle[0]) * (q[1] - middle[1]) - (q[0] - middle[0]) * (p[1] - middle[1]);
        size = Math.max(size, Math.hypot(p[0] - middle[0], p[1] - middle[1]));
    });
    return Math.abs(twice) > 1e-9 * size * size ? points : [];
}
