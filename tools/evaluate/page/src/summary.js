// SPDX-License-Identifier: GPL-3.0-or-later
// What was evaluated, and the answer to "which level may I use, and what do I lose?".
import { absent, caption, choice, h, head, numeric, scrolling } from "./dom.js";
import { count, duration, newtons, percent, plural, significant } from "./format.js";
import {
    kSameTime,
    levelName,
    levelsOf,
    mainLoad,
    median,
    methodsInOrderOf,
    referenceForce,
    usable,
    valuesOf,
} from "./levels.js";

/** Machine, commit and the like come as text or as an object of texts. */
function written(value) {
    if (value === undefined || value === null) return null;
    if (Array.isArray(value)) return value.map(written).join(", ");
    if (typeof value !== "object") return String(value);
    return Object.entries(value)
        .map(([k, v]) => `${k.replaceAll("_", " ")}: ${written(v)}`)
        .join(" \u00b7 ");
}

function references(scenes) {
    const texts = scenes
        .map(
            ({ reference: r }) =>
                r &&
                [r.tets && plural(r.tets, "tetrahedron", "tetrahedra"), r.kind].filter(Boolean).join(", "),
        )
        .filter(Boolean);
    return [...new Set(texts)].join("; ") || null;
}

function seedsOf(scenes) {
    const seeds = valuesOf(scenes, "seed").sort((a, b) => a - b);
    if (seeds.length === 0) return null;
    const whole = seeds.every((s, i) => s === seeds[0] + i);
    return seeds.length === 1
        ? String(seeds[0])
        : whole
          ? `${seeds.length} (${seeds[0]} to ${seeds.at(-1)})`
          : `${seeds.length} (${seeds.join(", ")})`;
}

function facts(data) {
    const runs = data.scenes.flatMap((s) => s.results);
    const failed = runs.filter((r) => !usable(r)).length;
    const rows = [
        ["Scenes", data.scenes.map((s) => s.name).join(", ") || null],
        ["Methods", methodsInOrderOf(data.scenes).join(", ") || null],
        ["Loads", valuesOf(data.scenes, "load").join(", ") || null],
        ["Seeds", seedsOf(data.scenes)],
        ["Reference", references(data.scenes)],
        ["Not converged", runs.length ? `${count(failed)} of ${plural(runs.length, "run")}` : null],
        ["Commit", data.commit && h("code", {}, written(data.commit))],
        ["Machine", written(data.machine)],
        [
            "Notes",
            data.scenes.flatMap((s) => (s.notes ?? []).map((note) => `${s.name}: ${note}`)).join("; ") ||
                false,
        ],
        ["Command", data.command && h("code", {}, written(data.command))],
    ];
    return h(
        "dl",
        { class: "facts" },
        rows
            .filter(([, value]) => value !== false)
            .map(([name, value]) =>
                h(
                    "div",
                    { class: name === "Command" || name === "Notes" ? "wide" : null },
                    h("dt", {}, name),
                    h("dd", {}, value ?? h("span", { class: "absent" }, "not recorded")),
                ),
            ),
    );
}

function worst(level) {
    return level.failed > 0 ? Infinity : level.highest;
}

/**
 * The fastest level inside the JND on every run (of those as fast the most exact), else the one that comes nearest.
 * A level fitted on a load does not count on that load.
 */
function choose(scene, load, jnd) {
    const runs = scene.results.filter((r) => (load === "" || r.load === load) && r.fitted !== true);
    const levels = levelsOf(runs, jnd).filter(
        (level) => Number.isFinite(level.step) && level.runs.some(usable),
    );
    const good = levels.filter((level) => worst(level) <= jnd);
    const fastest = Math.min(...good.map((level) => level.step));
    const best = good
        .filter((level) => level.step <= fastest * (1 + kSameTime))
        .sort((a, b) => worst(a) - worst(b))[0];
    const near = [...levels].sort((a, b) => worst(a) - worst(b) || a.error - b.error);
    const meshes = [...new Set(levels.map((level) => level.tets))].sort((m, n) => n - m);
    const finest = levels.filter((level) => level.tets === meshes[0]).map((level) => level.step);
    const slowest = meshes.length > 1 ? median(finest) : NaN;
    return {
        best: best ?? near[0],
        inside: good.length > 0,
        total: levels.length,
        good: good.length,
        slowest,
    };
}

function choiceRow(data, scene, load) {
    const { best, inside, total, good, slowest } = choose(scene, load, data.jnd);
    const name = h("th", { scope: "row" }, scene.name);
    if (!best) return h("tr", {}, name, h("td", { colspan: "7", class: "absent" }, "no converged run"));
    const verdict = inside ? "\u2713 " : "\u2717 none; nearest ";
    const numbers = [
        percent(best.error),
        best.failed ? "not converged" : percent(best.highest),
        duration(best.step),
        Number.isFinite(slowest) ? `${significant(slowest / best.step, 2)}\u00d7` : "\u2013",
        `${good} of ${total}`,
    ];
    return h(
        "tr",
        {},
        name,
        numeric(newtons(referenceForce(scene, load))),
        h("td", { class: inside ? "pass" : "miss" }, verdict, levelName(best)),
        numbers.map(numeric),
    );
}

function choiceTable(data, load) {
    const title = caption(
        `Fastest level whose force stays within ${percent(data.jnd, 0)} of the reference in every run `,
        `(${load === "" ? "all loads" : "load " + load}, all seeds). Time is the median step. Of levels equally `,
        `fast (within ${percent(kSameTime, 0)}) the most exact; those fitted on the load do not count. `,
        "Speed-up is against the finest mesh simulated on the same machine.",
    );
    const numbers = ["Mean |error|", "Worst", "Step", "Speed-up", "Levels inside"];
    const columns = head(
        "Scene",
        { number: "Reference" },
        "Fastest level inside",
        ...numbers.map((number) => ({ number })),
    );
    const rows = data.scenes.map((scene) => choiceRow(data, scene, load));
    return scrolling(h("table", {}, title, columns, h("tbody", {}, rows)), "Fastest level inside, per scene");
}

export function summarySection(data) {
    const runs = data.scenes.flatMap((s) => s.results);
    if (runs.length === 0) return [facts(data), absent("No results in this evaluation.")];
    const loads = valuesOf(data.scenes, "load");
    const box = h("div", {});
    const show = (load) => box.replaceChildren(choiceTable(data, load));
    show(mainLoad(data.scenes));
    const options = loads.map((value) => ({ value, label: value }));
    return [
        facts(data),
        h(
            "div",
            { class: "controls" },
            choice("Load", [...options, { value: "", label: "all loads" }], mainLoad(data.scenes), show),
        ),
        box,
    ];
}
