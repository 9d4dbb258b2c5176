// SPDX-License-Identifier: Apache-2.0
// Makes an evaluation as knead-evaluate would write it, with plausible numbers and no solver:
//   node generate.mjs [--fine N] [--coarse N] > evaluation.json
// Nine scenes, the methods, ten seeds, curves, and the states of a cube of N^3 cells of six tetrahedra.
import { pathToFileURL } from "node:url";

const kScenes = [
    ["scenario1", 20.71, (p) => p[2] > 0.05],
    ["scenario2", 20.82, (p) => p[2] < 0.05],
    ["scenario3", 25.09, (p) => Math.abs(p[0] - 0.05) > 0.0167],
    ["scenario4", 19.85, (p) => Math.abs(p[0] - 0.05) < 0.0167],
    ["scenario5", 18.97, (p) => Math.abs(p[2] - 0.05) > 0.035],
    ["scenario6", 22.6, (p) => p[0] < 0.05],
    ["scenario7", 27.9, (p) => Math.max(...p.map((x) => Math.abs(x - 0.05))) > 0.02],
    ["scenario8", 16.52, (p) => Math.max(...p.map((x) => Math.abs(x - 0.05))) < 0.02],
    ["scenario9", 107.7, null],
];
const kMeshes = [6000, 3072, 1296];
const kStepUs = { 6000: 730, 3072: 340, 1296: 128 };
/** Mean signed error, its spread over scenes and over seeds, for a press of the whole top. */
const kOthers = {
    "raw-dominant": [-0.06, 0.05],
    voigt: [0.14, 0.05],
    reuss: [-0.31, 0.12],
    geometric: [-0.08, 0.06],
    hill: [0.05, 0.04],
    kmod09: [0.012, 0.01],
    iycn13: [-0.03, 0.02],
    calibrated: [0.004, 0.004],
};
const kPaperK = { 1: [-0.17, 0.12, 0.035], 3: [-0.07, 0.09, 0.03], 6: [0.01, 0.07, 0.025] };
const kLoads = { press10: 1, twist: 1.3, pad3: 1.7, tip2: 2.6 };

/** Same numbers in every run (mulberry32). */
function random(seed) {
    let a = seed >>> 0;
    return () => {
        a = (a + 0x6d2b79f5) >>> 0;
        let t = Math.imul(a ^ (a >>> 15), a | 1);
        t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}

const gauss = (next) => Math.sqrt(-2 * Math.log(1 - next())) * Math.cos(2 * Math.PI * next());

function result(next, { method, bins, clusters, tets, seed, load, error, reference, slow = 1 }) {
    const p50 = kStepUs[tets] * slow * (1 + 0.03 * gauss(next));
    const failed = method === "reuss" && load === "tip2" && next() < 0.2;
    return {
        method,
        bins,
        clusters,
        tets,
        seed,
        load,
        fitted: method === "calibrated" && load === "press10",
        force_n: failed ? null : reference * (1 + error),
        reference_force_n: reference,
        force_error: failed ? null : error,
        displacement_error: Math.abs(error) * 0.4,
        within_jnd: !failed && Math.abs(error) <= 0.1,
        converged: !failed,
        // The runtime has no tensors: what needs them has no time.
        step_us: method === "kmod09" ? null : { p50, p99: 1.3 * p50, p999: 1.7 * p50, max: 2.9 * p50 },
        load_ms: method === "kmod09" ? null : tets / 900,
        asset_bytes: method === "kmod09" ? null : tets * 62,
        ...(failed ? { problem: "no convergence in 60 iterations" } : {}),
    };
}

function resultsOf(scene, index, seeds) {
    const next = random(1000 + index),
        results = [];
    const [, force] = scene;
    for (const [load, factor] of Object.entries(kLoads)) {
        const reference = force * { press10: 1, twist: 0.21, pad3: 0.18, tip2: 0.11 }[load];
        const add = (method, bins, clusters, tets, seed, error, slow) =>
            results.push(result(next, { method, bins, clusters, tets, seed, load, error, reference, slow }));
        const homogenised = factor * (0.11 + 0.06 * gauss(next));
        for (const tets of kMeshes) add("homogenised", 1, 1, tets, 1, homogenised + 0.005 * gauss(next));
        for (const [k, [mean, overScenes, overSeeds]] of Object.entries(kPaperK)) {
            const bias = mean + overScenes * gauss(next);
            for (const tets of kMeshes)
                for (let seed = 1; seed <= seeds; ++seed)
                    add("paper", 2, Number(k), tets, seed, factor * (bias + overSeeds * gauss(next)));
        }
        for (const [method, [mean, spread]] of Object.entries(kOthers))
            add(
                method,
                method === "voigt" ? 0 : 2,
                0,
                1296,
                1,
                factor * (mean + spread * gauss(next)),
                method === "iycn13" ? 1.25 : 1,
            );
    }
    return results;
}

/** A cube of 10 cm in n^3 cells of six tetrahedra each. */
export function cube(n) {
    const nodes = [],
        tetrahedra = [],
        id = (x, y, z) => x + (n + 1) * (y + (n + 1) * z);
    for (let z = 0; z <= n; ++z)
        for (let y = 0; y <= n; ++y)
            for (let x = 0; x <= n; ++x) nodes.push((0.1 * x) / n, (0.1 * y) / n, (0.1 * z) / n);
    for (let z = 0; z < n; ++z)
        for (let y = 0; y < n; ++y)
            for (let x = 0; x < n; ++x)
                for (const order of [
                    [0, 1, 2],
                    [0, 2, 1],
                    [1, 0, 2],
                    [1, 2, 0],
                    [2, 0, 1],
                    [2, 1, 0],
                ]) {
                    const at = [x, y, z],
                        corners = [id(...at)];
                    for (const axis of order) {
                        at[axis] += 1;
                        corners.push(id(...at));
                    }
                    tetrahedra.push(...corners);
                }
    return { nodes_m: nodes, tetrahedra };
}

function middles({ nodes_m, tetrahedra }) {
    return Array.from({ length: tetrahedra.length / 4 }, (_, t) =>
        [0, 1, 2].map((k) =>
            [0, 1, 2, 3].reduce((sum, c) => sum + nodes_m[3 * tetrahedra[4 * t + c] + k] / 4, 0),
        ),
    );
}

function statesOf([, , stiffAt], index, fine, coarse) {
    const next = random(9000 + index),
        mesh = cube(fine),
        small = cube(coarse);
    const stiff = (p) => (stiffAt ? next() < (stiffAt(p) ? 2 / 3 : 1 / 3) : false);
    const initial = middles(mesh).map((p) =>
        stiffAt ? (stiff(p) ? 38e3 + 4e3 * next() : 2e3 + 4e3 * next()) : 4e3 + 196e3 * next(),
    );
    const split = stiffAt ? 2e4 : 1e5,
        soft = stiffAt ? 4012.5173 : 51873.25,
        hard = stiffAt ? 39988.0061 : 149001.75;
    const bin = initial.map((e) => (e > split ? 1 : 0));
    const zone = (p) => (stiffAt ? stiffAt(p) : p[0] + p[1] > 0.1);
    const cluster = middles(mesh).map((p) => Math.floor(p[0] / 0.034));
    const aggregated = middles(mesh).map((p) => (zone(p) ? hard : soft));
    const state = (name, on, youngs, more = {}) => ({ name, ...on, youngs_modulus_pa: youngs, ...more });
    return [
        state("C1 initial", mesh, initial),
        state("C2 clustered", mesh, initial, { bin, cluster }),
        state(
            "C3 homogenised",
            mesh,
            bin.map((b) => (b ? hard : soft)),
            { bin, cluster },
        ),
        state("C4 aggregated", mesh, aggregated),
        state(
            "C5 coarse",
            small,
            middles(small).map((p) => (zone(p) ? hard : soft)),
        ),
    ];
}

function curvesOf([, force], results) {
    const time = Array.from({ length: 101 }, (_, i) => i * 0.2);
    const shape = (t, f) => f * (t < 15 ? (t / 15) ** 1.12 : 1 + 0.004 * Math.exp(-(t - 15)));
    const curve = (method, bins, clusters, tets, f) => ({
        method,
        bins,
        clusters,
        tets,
        seed: 1,
        load: "press10",
        time_s: time,
        force_n: time.map((t) => shape(t, f)),
    });
    const at = (method, clusters) =>
        results.find(
            (r) => r.method === method && r.clusters === clusters && r.tets === 1296 && r.load === "press10",
        ).force_n;
    return [
        curve("reference", 0, 0, 6000, force),
        curve("homogenised", 1, 1, 1296, at("homogenised", 1)),
        ...[1, 3, 6].map((k) => curve("paper", 2, k, 1296, at("paper", k))),
    ];
}

function assetOf(tets) {
    const kept = (group, bytes, asked_for_by) => ({ group, bytes, asked_for_by, left_out: false, why: "" });
    const out = (group, why) => ({ group, bytes: 0, asked_for_by: "", left_out: true, why });
    return [
        kept("/knead/asset/mesh", tets * 20, "[mesh]"),
        kept("/knead/asset/stiffness", tets * 26, "[[level]] k3-1296"),
        kept("/knead/asset/ordering", tets * 4, "[[tool]] press"),
        kept("/knead/asset/tools/press", 1964, "[[tool]] press"),
        out("/knead/asset/embedding", "no [surface] in the scene: nothing is drawn with the asset"),
        out("/knead/asset/contact", "the tool is bonded: no friction, no contact search"),
        out("/knead/asset/mass", "quasi-static scene: no inertia asked for"),
    ];
}

/** Table 2 of the paper as its cells come; the other numbers of this file are made up, these too are only like it. */
function paperOf() {
    const next = random(77),
        table2 = [];
    kScenes.forEach(([name, force], i) => {
        table2.push({ scene: name, tets: 6000, method: "reference", force_n: force });
        table2.push({ scene: name, tets: 6000, method: "homogenised", value_percent: 12 + 6 * gauss(next) });
        for (const [k, [mean, spread]] of Object.entries(kPaperK)) {
            const bias = mean + spread * gauss(next);
            for (const tets of kMeshes)
                table2.push({
                    scene: name,
                    tets,
                    method: `k${k}`,
                    value_percent: Number((100 * bias + gauss(next) + i * 0.01).toFixed(1)),
                });
        }
    });
    return {
        table1: [
            { tets: 6000, time_ms: 13 },
            { tets: 3072, time_ms: 5.2 },
            { tets: 1296, time_ms: 2.2 },
        ],
        table2,
    };
}

export function evaluation({ fine = 6, coarse = 4, seeds = 10 } = {}) {
    return {
        schema: "knead-evaluation/1",
        commit: "0123456789abcdef0123456789abcdef01234567",
        machine: {
            cpu: "Some CPU at 2.7 GHz",
            cores: 2,
            flags: "avx2 fma",
            compiler: "g++ 12.2",
            load_average: 0.42,
        },
        command: `knead-evaluate ${kScenes.map(([name]) => `examples/cubes/${name}.toml`).join(" ")} --seeds 10 --html report.html`,
        scenes: kScenes.map((scene, i) => {
            const results = resultsOf(scene, i, seeds);
            return {
                name: scene[0],
                reference: { tets: 6000, kind: "fine" },
                results,
                curves: curvesOf(scene, results),
                states: statesOf(scene, i, fine, coarse),
                asset: assetOf(1296),
            };
        }),
        paper: paperOf(),
    };
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
    const option = (name, usual) =>
        process.argv.includes(name) ? Number(process.argv[process.argv.indexOf(name) + 1]) : usual;
    process.stdout.write(
        JSON.stringify(evaluation({ fine: option("--fine", 6), coarse: option("--coarse", 4) })),
    );
}
