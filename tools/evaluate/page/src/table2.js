// SPDX-License-Identifier: GPL-3.0-or-later
// Table 2 of the paper: force error per scene and level, ours beside the paper's; and Table 1, the times.
import { absent, caption, choice, h, head, numeric, scrolling } from "./dom.js";
import { count, duration, newtons, percent, plural, signedPercent, significant } from "./format.js";
import { levelsOf, mainLoad, median, referenceForce, usable, valuesOf } from "./levels.js";
import { speedTable } from "./speed.js";

const rowKey = (method, tets) => `${method}|${tets}`;
const isTabled = (r) => r.method === "homogenised" || r.method === "paper";
const tabledName = (r) => (r.method === "homogenised" ? "homogenised" : `k${r.clusters}`);

/** "scenario3", "Sc. 3" and 3 are the same scene to this table. */
function sameScene(name, other) {
    const digits = (text) => /(\d+)\D*$/.exec(String(text))?.[1];
    return String(name) === String(other) || (digits(name) !== undefined && digits(name) === digits(other));
}

function paperCell(data, scene, row) {
    const cell =
        scene.name === "steak"
            ? (data.paper?.steak?.rows ?? []).find((c) => c.method === row.method)
            : (data.paper?.table2 ?? []).find(
                  (c) => c.method === row.method && c.tets === row.tets && sameScene(scene.name, c.scene),
              );
    return cell && Number.isFinite(cell.value_percent) ? cell.value_percent / 100 : undefined;
}

/** The rows: every (method, tets) that we or the paper have, homogenised first, then by k, finest mesh first. */
function rowsOf(data, runs, scenes) {
    const rows = new Map();
    const add = (method, tets) => rows.set(rowKey(method, tets), { method, tets });
    for (const run of runs) add(tabledName(run), run.tets);
    const isShown = (cell) => scenes.some((scene) => sameScene(scene.name, cell.scene));
    for (const cell of (data.paper?.table2 ?? []).filter(isShown))
        if (cell.method !== "reference") add(cell.method, cell.tets);
    const k = (row) => (row.method === "homogenised" ? 0 : Number(row.method.slice(1)));
    return [...rows.values()].sort((a, b) => k(a) - k(b) || b.tets - a.tets);
}

/** Percent without its sign: the caption says it for the whole table. */
const bare = (share) => signedPercent(share).replace("\u202f%", "");

/** A verdict by sign, word and colour, so that none of them has to be seen. */
function verdict(inside) {
    return h(
        "span",
        { class: "sign" },
        h("span", { "aria-hidden": "true" }, inside ? "\u2713" : "\u2717"),
        h("span", { class: "unseen" }, inside ? "inside the JND: " : "outside the JND: "),
    );
}

function oursIn(level, jnd) {
    if (!level) return { cell: [h("span", { class: "absent" }, "\u2013")], inside: undefined };
    const inside = level.failed === 0 && Math.abs(level.signed) <= jnd;
    const value = Number.isFinite(level.signed) ? bare(level.signed) : "not converged";
    const spread =
        level.seeds > 1
            ? h("span", { class: "spread" }, ` \u00b1\u2009${(100 * level.spread).toFixed(1)}`)
            : null;
    const failed =
        level.failed && Number.isFinite(level.signed)
            ? h("span", { class: "spread" }, ` ${level.failed} of ${level.runs.length} not converged`)
            : null;
    return { cell: [verdict(inside), " ", value, spread, failed], inside };
}

function describe(scene, level) {
    if (!level) return null;
    return (
        `${scene.name}, ${level.method}, ${count(level.tets)} tetrahedra: ${signedPercent(level.signed)} mean of ${plural(level.runs.length, "run")}, ` +
        `|error| ${percent(level.lowest)} to ${percent(level.highest)}, ${level.inside} inside`
    );
}

/** The paper gives no sign for its steak. */
function published(scene, share) {
    return scene.name === "steak" ? `|${(100 * share).toFixed(0)}|` : bare(share);
}

function cellOf(data, scene, row, runs, tally) {
    const level = levelsOf(
        runs.filter((r) => tabledName(r) === row.method && r.tets === row.tets),
        data.jnd,
    )[0];
    const ours = oursIn(level, data.jnd),
        paper = paperCell(data, scene, row);
    tally.push({
        scene: scene.name,
        row,
        ours: ours.inside,
        paper: paper === undefined ? undefined : Math.abs(paper) <= data.jnd,
    });
    const state = ours.inside === undefined ? null : ours.inside ? "pass" : "miss";
    return h(
        "td",
        { class: `cell ${state ?? ""}`, title: describe(scene, level) },
        h("span", { class: "ours" }, ours.cell),
        paper === undefined
            ? null
            : h("span", { class: "paper" }, "paper ", verdict(Math.abs(paper) <= data.jnd), " ", published(scene, paper)),
    );
}

function referenceCell(data, scene, load) {
    const isIt = (cell) => cell.method === "reference" && sameScene(scene.name, cell.scene);
    const paper = (data.paper?.table2 ?? []).find(isIt)?.force_n;
    const theirs = paper === undefined ? null : h("span", { class: "paper" }, `paper ${newtons(paper)}`);
    const ours = h("span", { class: "ours" }, newtons(referenceForce(scene, load)));
    return h("td", { class: "cell" }, ours, theirs);
}

function referenceRow(data, scenes, load) {
    const cells = scenes.map((scene) => referenceCell(data, scene, load));
    return h("tr", {}, h("th", { scope: "row" }, "reference"), cells);
}

/** "ours 48 of 81 cells inside; some k works in 24 of 27 (scene, mesh) pairs; the paper's ..." */
function totals(tally, who) {
    const cells = tally.filter((c) => c[who] !== undefined && c.row.method !== "homogenised");
    if (cells.length === 0) return null;
    const pairs = new Map();
    for (const c of cells)
        pairs.set(c.scene + c.row.tets, (pairs.get(c.scene + c.row.tets) ?? false) || c[who]);
    const works = [...pairs.values()].filter(Boolean).length;
    const inside = cells.filter((c) => c[who]).length;
    return h(
        "li",
        {},
        h("b", {}, who === "ours" ? "Ours: " : "Paper: "),
        `${inside} of ${cells.length} cells inside the JND; some k works in ${works} of ${pairs.size} pairs of scene and mesh `,
        `(${percent(works / pairs.size, 0)}).`,
    );
}

function levelRow(row, isFirst, cells) {
    const name = row.method === "homogenised" ? "homogenised" : `k\u2009=\u2009${row.method.slice(1)}`;
    const tets = h("span", { class: "tets" }, ` ${count(row.tets)}`);
    return h("tr", { class: isFirst ? "first" : null }, h("th", { scope: "row" }, name, tets), cells);
}

function tableTitle(data, load, bins) {
    const what = bins === undefined ? load : `${load}, ${plural(bins, "bin")}`;
    return caption(
        h("b", {}, "Table 2. "),
        "Force error against the reference: mean over the seeds \u00b1 standard deviation, in percent ",
        `(load ${what}). \u2713 inside the JND of ${percent(data.jnd, 0)}, \u2717 outside.`,
        data.paper?.table2 ? " Below each: the paper\u2019s cell." : "",
    );
}

function table(data, load, bins) {
    const ofBins = (r) => r.method === "homogenised" || bins === undefined || r.bins === bins;
    const runsOf = (scene) => scene.results.filter((r) => isTabled(r) && r.load === load && ofBins(r));
    const scenes = data.scenes.filter((scene) => runsOf(scene).length > 0);
    const rows = rowsOf(data, scenes.flatMap(runsOf), scenes);
    const tally = [];
    const body = rows.map((row, i) => {
        const cells = scenes.map((scene) => cellOf(data, scene, row, runsOf(scene), tally));
        return levelRow(row, i === 0 || rows[i - 1].method !== row.method, cells);
    });
    const columns = head("Level, tets", ...scenes.map((s) => s.name));
    const all = h("tbody", {}, referenceRow(data, scenes, load), body);
    return [
        scrolling(h("table", { class: "table2" }, tableTitle(data, load, bins), columns, all), "Table 2"),
        h("ul", { class: "totals" }, totals(tally, "ours"), totals(tally, "paper")),
    ];
}

export function table2Section(data) {
    const loads = valuesOf(data.scenes, "load");
    const runs = data.scenes.flatMap((s) => s.results).filter(isTabled);
    if (runs.length === 0)
        return [absent("No result of the method of the paper or of the homogenised object, so no Table 2.")];
    const bins = [...new Set(runs.filter((r) => r.method === "paper").map((r) => r.bins))];
    bins.sort((a, b) => a - b);
    const choices = { load: mainLoad(data.scenes), bins: bins.includes(2) ? 2 : bins[0] };
    const box = h("div", { id: "table2" });
    const show = () => box.replaceChildren(...table(data, choices.load, choices.bins));
    show();
    const pick = (label, member, values) => {
        if (values.length < 2) return null;
        const options = values.map((value) => ({ value: String(value), label: String(value) }));
        return choice(label, options, String(choices[member]), (text) => {
            choices[member] = values.find((value) => String(value) === text);
            show();
        });
    };
    const controls = h("div", { class: "controls" }, pick("Load", "load", loads), pick("Bins", "bins", bins));
    const missing = absent("The paper\u2019s numbers are not in this evaluation, so only ours are shown.");
    return [controls, ...(data.paper?.table2 ? [] : [missing]), box];
}

/** What the paper's Table 1 says of a mesh, in ms, whichever of the two forms it comes in. */
function paperTime(data, tets) {
    const table1 = data.paper?.table1;
    const row = Array.isArray(table1) ? table1.find((r) => r.tets === tets) : undefined;
    return row?.time_ms ?? row?.ms ?? row?.value_ms;
}

const ratio = (a, b) => (a > 0 && b > 0 ? `${significant(a / b, 2)}\u00d7` : "\u2013");

/** One row per mesh: our times and speed-up, and the paper's where it has any. */
function timeRows(data, runs, meshes) {
    const papers = meshes.map((tets) => paperTime(data, tets));
    const withPaper = papers.some((p) => p !== undefined);
    const all = (tets, name) => runs.filter((r) => r.tets === tets).map((r) => r.step_us[name]);
    const time = (tets, name) => median(all(tets, name).filter(Number.isFinite));
    const rows = meshes.map((tets, i) => {
        const ours = ["p50", "p99", "p999", "max"].map((name) => duration(time(tets, name)));
        const faster = ratio(time(meshes[0], "p50"), time(tets, "p50"));
        const theirs = [duration(1000 * papers[i]), ratio(papers[0], papers[i])];
        const cells = [...ours, faster, ...(withPaper ? theirs : [])];
        return h("tr", {}, h("th", { scope: "row" }, count(tets)), cells.map(numeric));
    });
    return { rows, withPaper };
}

export function timeSection(data) {
    const load = mainLoad(data.scenes); // scenes of another load are other objects; times do not depend on it
    const runs = data.scenes
        .flatMap((s) => s.results)
        .filter((r) => r.load === load && isTabled(r) && usable(r) && r.step_us?.p50 > 0);
    const meshes = [...new Set(runs.map((r) => r.tets))].sort((a, b) => b - a);
    if (meshes.length === 0) return [absent("No step times in this evaluation.")];
    const { rows, withPaper } = timeRows(data, runs, meshes);
    const titles = ["p50", "p99", "p99.9", "worst", "Speed-up"];
    if (withPaper) titles.push("Paper", "Paper\u2019s speed-up");
    const title = caption(
        h("b", {}, "Table 1. "),
        "Time of one step on the runtime: medians over scenes, levels and seeds of each quantile. ",
        "Ratios within one run are the claim; absolute times depend on the machine.",
    );
    const columns = head("Tetrahedra", ...titles.map((number) => ({ number })));
    const table1 = scrolling(h("table", {}, title, columns, h("tbody", {}, rows)), "Table 1");
    return [table1, speedTable(data)];
}
