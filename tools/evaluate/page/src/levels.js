// SPDX-License-Identifier: GPL-3.0-or-later
// From single runs to levels: what the seeds of one (method, bins, clusters, mesh) say together.

import { methodsInOrder } from "./palette.js";

const mean = (xs) => xs.reduce((a, b) => a + b, 0) / xs.length;

export function median(xs) {
    if (xs.length === 0) return NaN;
    const sorted = [...xs].sort((a, b) => a - b);
    const half = sorted.length >> 1;
    return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

/** Sample standard deviation; 0 for a single value. */
export function deviation(xs) {
    if (xs.length < 2) return 0;
    const m = mean(xs);
    return Math.sqrt(xs.reduce((sum, x) => sum + (x - m) ** 2, 0) / (xs.length - 1));
}

/** Did the run end in a state that its error speaks of? */
export function usable(run) {
    return run.converged !== false && Number.isFinite(run.force_error);
}

const levelKey = (run) => [run.method, run.bins, run.clusters, run.tets].join("|");

/**
 * One level per (method, bins, clusters, tets), with the runs of all loads, seeds and scenes given. Errors are
 * shares; `signed` keeps the sign, `error` is of its absolute value. A run that did not converge has no error
 * and counts as a miss.
 */
export function levelsOf(runs, jnd) {
    const groups = new Map();
    for (const run of runs) {
        if (run.method === "reference") continue;
        const key = levelKey(run);
        if (!groups.has(key)) groups.set(key, []);
        groups.get(key).push(run);
    }
    return [...groups].map(([key, group]) => summary(key, group, jnd));
}

function summary(key, runs, jnd) {
    const good = runs.filter(usable);
    const signed = good.map((run) => run.force_error);
    const error = signed.map(Math.abs);
    const steps = (name) => median(runs.map((run) => run.step_us?.[name]).filter(Number.isFinite));
    const { method, bins, clusters, tets } = runs[0];
    return {
        key,
        method,
        bins,
        clusters,
        tets,
        runs,
        loads: [...new Set(runs.map((run) => run.load))],
        seeds: new Set(runs.map((run) => run.seed)).size,
        fitted: runs.some((run) => run.fitted === true),
        failed: runs.length - good.length,
        inside: error.filter((e) => e <= jnd).length,
        signed: good.length ? mean(signed) : NaN,
        spread: deviation(signed),
        error: good.length ? mean(error) : NaN,
        lowest: Math.min(...error),
        highest: Math.max(...error),
        step: steps("p50"),
        stepP99: steps("p99"),
        bytes: median(runs.map((run) => run.asset_bytes).filter(Number.isFinite)),
        problem: runs.find((run) => run.problem)?.problem,
    };
}

/** Step times closer than this share are taken as equal: repeated measurements differ by as much. */
export const kSameTime = 0.03;

/** The levels for which no other is more exact and as fast, from the fastest to the most exact. */
export function paretoFront(levels) {
    const beats = (a, b) =>
        a.step <= b.step * (1 + kSameTime) && (a.error < b.error || (a.error === b.error && a.step < b.step));
    return levels
        .filter((level) => !levels.some((other) => beats(other, level)))
        .sort((a, b) => a.step - b.step);
}

/** "paper, 2 bins, k = 3, 1,296 tets" */
export function levelName(level, withMesh = true) {
    const parts = [level.method];
    if (level.method === "paper") parts[0] += ` k\u2009=\u2009${level.clusters}`;
    if (level.method === "paper" && level.bins !== 2 && level.bins !== undefined)
        parts.push(`${level.bins} bins`);
    if (withMesh && level.tets) parts.push(`${level.tets.toLocaleString("en-US")} tets`);
    return parts.join(", ");
}

/** The reference's force under a load: the mean over the runs, as every seed has its own object. */
export function referenceForce(scene, load) {
    const forces = scene.results.filter((run) => run.load === load).map((run) => run.reference_force_n);
    const known = forces.filter(Number.isFinite);
    return known.length ? mean(known) : NaN;
}

/** Values of one member over all runs of the scenes, in order of appearance. */
export function valuesOf(scenes, member) {
    const values = new Set();
    for (const scene of scenes)
        for (const run of scene.results) if (run[member] !== undefined) values.add(run[member]);
    return [...values];
}

/** The methods evaluated, in the page's order; the reference is not one of them. */
export function methodsInOrderOf(scenes) {
    return methodsInOrder(valuesOf(scenes, "method").filter((m) => m !== "reference"));
}

/** The load that tables speak of when nothing else is asked: the paper's press by 10 %, or the first. */
export function mainLoad(scenes) {
    const loads = valuesOf(scenes, "load");
    return loads.includes("press10") ? "press10" : loads[0];
}
