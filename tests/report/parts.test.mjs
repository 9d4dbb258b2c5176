// SPDX-License-Identifier: Apache-2.0
// The parts of the page that compute: meshes cut to solids, sections, levels, the front, the data's two forms.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { cube } from "./generate.mjs";

const part = (name) => import(pathToFileURL(join(process.env.KNEAD_PAGE_MODULES, name)).href);
const { boundary, bounds, centroids, neighbours, section } = await part("tetmesh.js");
const { deviation, levelsOf, median, paretoFront } = await part("levels.js");
const { readEvaluation } = await part("data.js");
const format = await part("format.js");

/** Sums over some 10,000 doubles near 1 leave some 1e-13; a lost or doubled face shows at 1e-3. */
const kSum = 1e-9;

function mesh(n) {
    const { nodes_m, tetrahedra } = cube(n);
    return { nodes: Float64Array.from(nodes_m), tetrahedra: Uint32Array.from(tetrahedra) };
}

const at = ({ nodes }, i) => [nodes[3 * i], nodes[3 * i + 1], nodes[3 * i + 2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

/** Volume inside a closed surface that looks outwards (divergence theorem). */
function enclosed(object, corners) {
    let volume = 0;
    for (let i = 0; i < corners.length; i += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => at(object, corners[i + k]));
        volume += dot(a, cross(b, c)) / 6;
    }
    return volume;
}

function tetVolume(object, tet) {
    const [a, b, c, d] = [0, 1, 2, 3].map((k) => at(object, object.tetrahedra[4 * tet + k]));
    return Math.abs(dot(minus(b, a), cross(minus(c, a), minus(d, a)))) / 6;
}

test("Boundary_of_a_whole_cube_is_its_six_sides", () => {
    const object = mesh(4);
    const { corners } = boundary(object, neighbours(object.tetrahedra), () => true);
    assert.equal(corners.length / 3, 6 * 4 * 4 * 2);
    assert.ok(Math.abs(enclosed(object, corners) / 1e-3 - 1) < kSum);
});

test("Boundary_of_a_cut_cube_encloses_the_tetrahedra_that_stay", () => {
    const object = mesh(5),
        behind = neighbours(object.tetrahedra),
        middles = centroids(object, 1);
    for (const position of [0.01, 0.037, 0.05, 0.0999]) {
        const kept = (t) => middles[t] <= position;
        const { corners, owners } = boundary(object, behind, kept);
        let volume = 0;
        for (let t = 0; t < middles.length; ++t) if (kept(t)) volume += tetVolume(object, t);
        assert.ok(Math.abs(enclosed(object, corners) - volume) < kSum * volume, `at ${position}`);
        assert.ok(owners.every(kept));
        assert.equal(owners.length, corners.length / 3);
    }
});

test("Section_of_a_cube_fills_its_square_without_overlap", () => {
    const object = mesh(4);
    const area = (points) =>
        Math.abs(
            points.reduce((sum, p, i) => {
                const q = points[(i + 1) % points.length];
                return sum + (p[0] * q[1] - q[0] * p[1]) / 2;
            }, 0),
        );
    // 0.05 and 0.025 run along mesh faces, where a careless section shows tetrahedra of both sides or of none.
    for (const axis of [0, 1, 2])
        for (const position of [0.0123, 0.025, 0.05, 0.0999]) {
            const total = section(object, axis, position).reduce(
                (sum, polygon) => sum + area(polygon.points),
                0,
            );
            assert.ok(Math.abs(total / 0.01 - 1) < kSum, `axis ${axis} at ${position}: ${total}`);
        }
});

test("Section_outside_of_the_object_is_empty", () => {
    assert.equal(section(mesh(2), 2, 0.2).length, 0);
    assert.deepEqual(bounds(mesh(2).nodes), { low: [0, 0, 0], high: [0.1, 0.1, 0.1] });
});

const run = (more) => ({
    method: "paper",
    bins: 2,
    clusters: 3,
    tets: 1296,
    seed: 1,
    load: "press10",
    converged: true,
    force_error: 0.05,
    step_us: { p50: 100 },
    ...more,
});

test("Level_of_several_seeds_has_mean_spread_and_range", () => {
    const [level] = levelsOf([run({ force_error: 0.05 }), run({ seed: 2, force_error: -0.15 })], 0.1);
    assert.ok(Math.abs(level.signed + 0.05) < kSum && Math.abs(level.error - 0.1) < kSum);
    assert.ok(Math.abs(level.spread - Math.sqrt(0.02)) < kSum);
    assert.deepEqual([level.lowest, level.highest, level.inside, level.seeds], [0.05, 0.15, 1, 2]);
});

test("Level_with_a_run_that_did_not_converge_counts_it_as_a_miss", () => {
    const [level] = levelsOf(
        [run({}), run({ seed: 2, converged: false, force_error: 0.01 }), run({ seed: 3, force_error: null })],
        0.1,
    );
    assert.deepEqual([level.failed, level.inside, level.error], [2, 1, 0.05]);
});

test("Levels_differ_by_method_bins_clusters_and_mesh_and_leave_the_reference_out", () => {
    const runs = [
        run({}),
        run({ method: "hill" }),
        run({ bins: 3 }),
        run({ clusters: 6 }),
        run({ tets: 6000 }),
        run({ seed: 9 }),
        run({ method: "reference" }),
    ];
    assert.equal(levelsOf(runs, 0.1).length, 5);
});

test("Front_holds_the_levels_that_none_beats_in_time_and_error", () => {
    const level = (step, error) => ({ step, error });
    const a = level(100, 0.3),
        b = level(101, 0.2),
        c = level(200, 0.25),
        d = level(300, 0.01),
        e = level(150, 0.2);
    assert.deepEqual(paretoFront([d, a, c, e, b]), [b, d]);
    assert.deepEqual(paretoFront([level(1, 1), level(1, 1)]).length, 2);
});

test("Median_and_deviation_are_those_of_the_textbook", () => {
    assert.equal(median([5, 1, 3]), 3);
    assert.equal(median([4, 1, 3, 2]), 2.5);
    assert.ok(Number.isNaN(median([])));
    assert.ok(Math.abs(deviation([2, 4, 4, 4, 5, 5, 7, 9]) - Math.sqrt(32 / 7)) < kSum);
    assert.equal(deviation([3]), 0);
});

test("Evaluation_in_its_short_form_reads_as_in_its_long_one", () => {
    const long = {
        scenes: [
            {
                name: "a",
                results: [
                    { method: "hill", tets: 6, step_us: { p50: 1, max: 3 } },
                    { method: "paper", seed: 4 },
                ],
                states: [
                    {
                        name: "C1",
                        nodes_m: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1],
                        tetrahedra: [0, 1, 2, 3],
                        youngs_modulus_pa: [5],
                    },
                ],
            },
        ],
    };
    const short = {
        scenes: [
            {
                name: "a",
                results: {
                    columns: ["method", "seed", "step_us.max", "step_us.p50", "tets"],
                    rows: [
                        ["hill", null, 3, 1, 6],
                        ["paper", 4, null, null, null],
                    ],
                },
                states: [{ name: "C1", mesh: 0, youngs_modulus_pa: { palette: [5], index: [0] } }],
            },
        ],
        meshes: [
            {
                nodes_m: [
                    [0, 0, 0],
                    [1, 0, 0],
                    [0, 1, 0],
                    [0, 0, 1],
                ],
                tetrahedra: [[0, 1, 2, 3]],
            },
        ],
    };
    const read = (data) => readEvaluation(JSON.stringify(data)).scenes;
    assert.deepEqual(read(short), read(long));
});

test("Evaluation_with_a_state_that_points_outside_of_its_mesh_leaves_it_out", () => {
    const state = (tetrahedra, e) => ({
        nodes_m: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1],
        tetrahedra,
        youngs_modulus_pa: e,
    });
    const states = [state([0, 1, 2, 4], [5]), state([0, 1, 2, 3], [5, 6]), state([0, 1, 2, 3], [5])];
    assert.equal(readEvaluation(JSON.stringify({ scenes: [{ states }] })).scenes[0].states.length, 1);
});

test("Numbers_are_written_with_sign_unit_and_no_exponent", () => {
    assert.equal(format.signedPercent(-0.0512), "\u22125.1\u202f%");
    assert.equal(format.signedPercent(0.0004), "0.0\u202f%");
    assert.equal(format.duration(128.4), "128\u202f\u00b5s");
    assert.equal(format.duration(13000), "13.0\u202fms");
    assert.equal(format.durationTick(1000), "1\u202fms");
    assert.equal(format.bytes(1234567), "1.23\u202fMB");
    assert.equal(format.signedPercent(NaN), "\u2013");
    assert.deepEqual(format.logTicks(1e-3, 0.02), [0.001, 0.002, 0.005, 0.01, 0.02]);
    assert.deepEqual(format.logTicks(11, 42), [15, 20, 30, 40]);
});
