// SPDX-License-Identifier: GPL-3.0-or-later
// Error against run time: a point per level, the front, the JND.
import * as Plot from "@observablehq/plot";
import { absent, choice, figure, h, head, numeric, redrawnToWidth, scrolling } from "./dom.js";
import { commandOf } from "./command.js";
import { bytes, count, duration, durationTick, logTicks, percent, plural, signedPercent } from "./format.js";
import {
    kSameTime,
    levelName,
    levelsOf,
    mainLoad,
    methodsInOrderOf,
    paretoFront,
    valuesOf,
} from "./levels.js";
import { methodColour, methodSymbol, methodsInOrder } from "./palette.js";

/** Errors below this are drawn at it: a log axis has no zero, and nobody feels 0.1 %. */
const kFloor = 1e-3;

function tooltip(level, jnd) {
    const lines = [
        level.method,
        `bins ${level.bins ?? "\u2013"}, k ${level.clusters ?? "\u2013"}, ${count(level.tets)} tets`,
        `load ${level.loads.join(", ")}${level.scenes > 1 ? `, ${level.scenes} scenes` : ""}`,
        `step ${duration(level.step)} (p99 ${duration(level.stepP99)})`,
        `|error| ${percent(level.error)}, ${percent(level.lowest)} to ${percent(level.highest)}`,
        `signed ${signedPercent(level.signed)} \u00b1 ${percent(level.spread)}`,
        `inside the JND: ${level.inside} of ${plural(level.runs.length, "run")}, ${plural(level.seeds, "seed")}`,
    ];
    if (level.failed)
        lines.push(`not converged: ${level.failed}${level.problem ? ` (${level.problem})` : ""}`);
    if (level.fitted) lines.push("fitted on this load: not on the front");
    if (Number.isFinite(level.bytes)) lines.push(`asset ${bytes(level.bytes)}`);
    lines.push(`$ ${level.command}`);
    return lines.join("\n");
}

/** Axes with the labels of all their ticks: a log scale's own would leave some of 2, 5 and 10 without. */
function logAxes(times, errors) {
    const errorTick = (e) => (e <= kFloor ? "\u2264\u2009" : "") + percent(e, e < 0.01 ? 1 : 0);
    return [
        Plot.gridX(times),
        Plot.gridY(errors),
        Plot.axisX(times, { text: durationTick }),
        Plot.axisY(errors, { text: errorTick }),
    ];
}

const drawnAt = (error) => Math.max(error, kFloor);
const kPlace = { x: "step", y: (level) => drawnAt(level.error) };

function jndMarks(jnd, low, high) {
    const ground = { fill: "var(--pass-ground)", fillOpacity: 0.55 };
    const halo = { stroke: "var(--surface)", strokeWidth: 4 };
    return [
        Plot.rect([0], { x1: low, x2: high, y1: kFloor, y2: jnd, ...ground }),
        Plot.ruleY([jnd], { stroke: "var(--miss)", strokeDasharray: "6 4", ariaDescription: "the JND" }),
        Plot.text([`JND ${percent(jnd, 0)}`], {
            x: high,
            y: jnd,
            dy: -7,
            dx: -4,
            textAnchor: "end",
            fill: "var(--miss)",
            ...halo,
        }),
    ];
}

function frontMarks(front, named) {
    const line = { strokeOpacity: 0.55, strokeWidth: 1.5, curve: "step-after", ariaDescription: "the front" };
    const text = { text: (level) => levelName(level), dy: -13, dx: 4, textAnchor: "start" };
    return {
        line: Plot.line(front, { ...kPlace, stroke: "currentColor", ...line }),
        names: Plot.text(named ? front : [], {
            ...kPlace,
            ...text,
            fill: "currentColor",
            stroke: "var(--surface)",
            strokeWidth: 4,
        }),
    };
}

function levelMarks(levels, narrow) {
    const range = { y1: (l) => drawnAt(l.lowest), y2: (l) => drawnAt(l.highest) };
    return [
        Plot.ruleX(levels, { x: "step", ...range, stroke: "method", strokeOpacity: 0.4 }),
        Plot.dot(levels, {
            ...kPlace,
            stroke: "method",
            symbol: "method",
            r: narrow ? 4 : 5,
            strokeWidth: 1.6,
            fill: (l) => (l.fitted ? "none" : methodColour(l.method)),
            fillOpacity: 0.75,
            ariaDescription: "the levels",
        }),
    ];
}

function tipMark(levels, jnd, lineWidth) {
    const look = { maxRadius: 30, lineWidth, lineHeight: 1.3, fontSize: 12 };
    return Plot.tip(levels, Plot.pointer({ ...kPlace, title: (l) => tooltip(l, jnd), ...look }));
}

function chart(width, levels, front, jnd) {
    const narrow = width < 560;
    const times = levels.map((l) => l.step);
    const [low, high] = [Math.min(...times) / 1.45, Math.max(...times) * 1.45];
    const top = Math.max(0.2, ...levels.map((l) => l.highest)) * 1.15;
    const methods = methodsInOrder(new Set(levels.map((l) => l.method)));
    const { line, names } = frontMarks(front, !narrow);
    return Plot.plot({
        width,
        height: narrow ? 380 : 460,
        marginLeft: 52,
        marginBottom: 42,
        marginRight: narrow ? 12 : 24,
        ariaLabel: "Force error against step time",
        className: "figure-plot",
        x: { type: "log", domain: [low, high], label: "median time of one step \u2192" },
        y: { type: "log", domain: [kFloor, top], label: "\u2191 mean |force error|" },
        color: { domain: methods, range: methods.map(methodColour) },
        symbol: { domain: methods, range: methods.map(methodSymbol) },
        marks: [
            ...logAxes(logTicks(low, high, !narrow || high / low < 20), logTicks(kFloor, top)),
            ...jndMarks(jnd, low, high),
            line,
            ...levelMarks(levels, narrow),
            names,
            tipMark(levels, jnd, narrow ? 21 : 36),
        ],
    });
}

function legend(levels) {
    const methods = methodsInOrder(new Set(levels.map((l) => l.method)));
    return Plot.legend({
        symbol: { domain: methods, range: methods.map(methodSymbol) },
        className: "figure-legend",
        color: { domain: methods, range: methods.map(methodColour) },
        fill: "color",
        swatchSize: 14,
    });
}

function numberRow(level, front) {
    const state = front.includes(level) ? "yes" : level.fitted ? "fitted" : "";
    const inside = `${level.inside} of ${level.runs.length}`;
    const numbers = [
        duration(level.step),
        duration(level.stepP99),
        percent(level.error),
        percent(level.highest),
        inside,
        bytes(level.bytes),
    ];
    return h(
        "tr",
        {},
        h("th", { scope: "row" }, levelName(level)),
        h("td", {}, state),
        numbers.map(numeric),
        h("td", {}, h("code", {}, level.command)),
    );
}

function numbersTable(levels, front) {
    const titles = ["Step p50", "p99", "Mean |error|", "Worst", "Runs inside", "Asset"];
    const columns = head("Level", "On the front", ...titles.map((number) => ({ number })), "Command");
    const rows = [...levels].sort((a, b) => a.step - b.step).map((level) => numberRow(level, front));
    const table = h("table", { class: "compact" }, columns, h("tbody", {}, rows));
    const title = h("summary", {}, `The ${plural(levels.length, "point")} as a table`);
    return h("details", {}, title, scrolling(table, "Points of figure 1"));
}

/** The levels that the choices leave, and those of them that have a place in the plot. */
function selected(data, choices) {
    const scenes = data.scenes.filter((s) => choices.scene === "" || s.name === choices.scene);
    const runs = scenes
        .flatMap((s) => s.results)
        .filter((r) => choices.load === "" || r.load === choices.load);
    const levels = levelsOf(runs, data.jnd).map((level) => ({
        ...level,
        scenes: scenes.length,
        command: commandOf(data, scenes, level),
    }));
    return { levels, drawn: levels.filter((l) => l.step > 0 && Number.isFinite(l.error)) };
}

/** Levels without a place in the plot are named, with what they lack. */
function notDrawn(levels) {
    const kShown = 6;
    if (levels.length === 0) return "";
    const reason = (l) =>
        Number.isFinite(l.error) ? `no step time, mean |error| ${percent(l.error)}` : "did not converge";
    const names = levels.slice(0, kShown).map((l) => `${levelName(l)} (${reason(l)})`);
    return `${plural(levels.length, "level")} not drawn: ${names.join("; ")}${levels.length > kShown ? "; \u2026" : "."}`;
}

export function paretoSection(data) {
    const choices = { scene: "", load: mainLoad(data.scenes) ?? "" };
    if (methodsInOrderOf(data.scenes).length === 0)
        return [absent("No results, so no error against run time.")];
    const box = h("div", { class: "plot", id: "pareto-plot" }),
        key = h("div", { class: "legend" });
    const table = h("div", {}),
        note = h("p", { class: "note" });
    const draw = (width) => {
        const { levels, drawn } = selected(data, choices);
        const front = paretoFront(drawn.filter((l) => !l.fitted));
        key.replaceChildren(...(drawn.length ? [legend(drawn)] : []));
        table.replaceChildren(...(drawn.length ? [numbersTable(drawn, front)] : []));
        note.textContent = notDrawn(levels.filter((level) => !drawn.includes(level)));
        return drawn.length
            ? chart(width, drawn, front, data.jnd)
            : absent("Nothing to draw for this choice.");
    };
    const redraw = redrawnToWidth(box, draw);
    const controls = paretoControls(data, choices, redraw);
    return [controls, figure(1, [key, box], ...paretoCaption()), note, table];
}

function paretoControls(data, choices, redraw) {
    const pick = (member) => (value) => {
        choices[member] = value;
        redraw();
    };
    const option = (value) => ({ value, label: value });
    const scenes = [{ value: "", label: "all scenes together" }, ...data.scenes.map((s) => option(s.name))];
    const loads = [...valuesOf(data.scenes, "load").map(option), { value: "", label: "all loads" }];
    return h(
        "div",
        { class: "controls" },
        choice("Scene", scenes, choices.scene, pick("scene")),
        choice("Load", loads, choices.load, pick("load")),
    );
}

function paretoCaption() {
    return [
        "Force error against the time of one step. A point is a level: mean of |error| over the chosen scenes, ",
        "loads and seeds; the thin line is its range. The stepped line is the front: no other level is more exact ",
        `and as fast (times within ${percent(kSameTime, 0)} count as equal). Below the dashed line the difference `,
        "is not felt. Hollow points were fitted on a shown load and stay off the front. Errors below ",
        `${percent(kFloor)} are drawn at ${percent(kFloor)}.`,
    ];
}
