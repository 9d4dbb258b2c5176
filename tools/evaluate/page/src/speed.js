// SPDX-License-Identifier: GPL-3.0-or-later
// The runtime beside the plain baseline: what a coarser mesh gains on either.
import { caption, h, head, numeric, scrolling } from "./dom.js";
import { count, duration, significant } from "./format.js";
import { median } from "./levels.js";

const ratio = (a, b) => (a > 0 && b > 0 ? `${significant(a / b, 2)}\u00d7` : "\u2013");

/** Median steps over the scenes of a mesh. */
function timesOf(all, tets) {
    const of = (side) =>
        median(
            all
                .filter((s) => s.tets === tets)
                .map((s) => s[side]?.p50)
                .filter(Number.isFinite),
        );
    return { tets, runtime: of("runtime_us"), baseline: of("baseline_us") };
}

/** Meshes of objects of different sizes are not compared: one block for each number of fine tetrahedra. */
function blocks(scenes) {
    const byFine = new Map();
    for (const scene of scenes) {
        const fine = Math.max(...scene.speed.map((s) => s.tets));
        byFine.set(fine, [...(byFine.get(fine) ?? []), ...scene.speed]);
    }
    return [...byFine.values()].map((all) =>
        [...new Set(all.map((s) => s.tets))].sort((a, b) => b - a).map((tets) => timesOf(all, tets)),
    );
}

function speedRow(row, first) {
    const cells = [
        duration(row.runtime),
        ratio(first.runtime, row.runtime),
        duration(row.baseline),
        ratio(first.baseline, row.baseline),
        ratio(row.baseline, row.runtime),
    ];
    return h("tr", {}, h("th", { scope: "row" }, count(row.tets)), cells.map(numeric));
}

/** Nothing where the baseline was not timed. */
export function speedTable(data) {
    const scenes = data.scenes.filter((scene) => scene.speed?.length > 0);
    if (scenes.length === 0) return null;
    const title = caption(
        "The same press on the runtime and on a plain baseline (assembled matrix, conjugate gradients with block ",
        "Jacobi, double precision), in turns: medians over the scenes of one size. The finest mesh has the raw ",
        "elasticities.",
    );
    const titles = ["Runtime", "Speed-up", "Baseline", "Speed-up", "Baseline / runtime"];
    const columns = head("Tetrahedra", ...titles.map((number) => ({ number })));
    const rows = blocks(scenes).flatMap((block) => block.map((row) => speedRow(row, block[0])));
    return scrolling(h("table", { id: "speed-table" }, title, columns, h("tbody", {}, rows)), "Runtime and baseline");
}
