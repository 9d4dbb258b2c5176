// SPDX-License-Identifier: GPL-3.0-or-later
// Force over time, with the band in which the reference's force would not be told from another (Figure 8).
import * as Plot from "@observablehq/plot";
import { absent, choice, figure, h, redrawnToWidth } from "./dom.js";
import { newtons, percent, significant } from "./format.js";
import { levelName } from "./levels.js";
import { methodColour } from "./palette.js";

const kClusters = ["#8a5fd0", "#3b6fd6", "#0f8f80", "#b0589a"];

function curveName(curve) {
    return curve.method === "reference" ? "reference" : levelName(curve, false);
}

/** Names and colours of the curves shown: the paper's k in one family, everything else by its method. */
function colours(curves) {
    const names = [...new Set(curves.map(curveName))];
    const ks = names
        .filter((name) => name.startsWith("paper"))
        .sort((a, b) => a.localeCompare(b, "en", { numeric: true }));
    const colour = (name) =>
        name === "reference"
            ? "var(--ink)"
            : ks.includes(name)
              ? kClusters[ks.indexOf(name) % kClusters.length]
              : methodColour(name);
    return { names, range: names.map(colour) };
}

/** Heights in the plot for labels at the curves' ends, pushed apart so that none covers another. */
function spreadLabels(ends, forceOfPixel) {
    const gap = 15 * forceOfPixel;
    const sorted = [...ends].sort((a, b) => a.force - b.force);
    sorted.forEach((end, i) => {
        end.at = i ? Math.max(end.force, sorted[i - 1].at + gap) : end.force;
    });
    return sorted;
}

function curveRows(curves) {
    return curves.flatMap((c) =>
        c.time_s.map((t, i) => ({
            name: curveName(c),
            id: `${curveName(c)}|${c.seed}`,
            t,
            force: c.force_n[i],
        })),
    );
}

function curveMarks(rows, labels, jnd) {
    const place = { x: "t", y: "force" };
    const reference = rows.filter((r) => r.name === "reference");
    const band = { y1: (r) => r.force * (1 - jnd), y2: (r) => r.force * (1 + jnd) };
    const title = (r) => `${r.name}\n${significant(r.t, 3)} s: ${newtons(r.force)}`;
    const end = { textAnchor: "start", dx: 8, fontWeight: 600 };
    return [
        Plot.areaY(reference, {
            x: "t",
            ...band,
            fill: "var(--ink)",
            fillOpacity: 0.11,
            ariaDescription: "the JND band",
        }),
        Plot.ruleY([0], { strokeOpacity: 0.4 }),
        Plot.line(rows, { ...place, z: "id", stroke: "name", strokeOpacity: 0.9, strokeWidth: 1.8 }),
        Plot.line(reference, { ...place, z: "id", stroke: "var(--ink)", strokeWidth: 2.4 }),
        Plot.text(labels, { x: "t", y: "at", text: "name", fill: "name", ...end }),
        Plot.tip(rows, Plot.pointer({ ...place, title, fontSize: 12, lineHeight: 1.3, maxRadius: 30 })),
    ];
}

function chart(width, curves, jnd) {
    const narrow = width < 640;
    const height = narrow ? 320 : 420;
    const rows = curveRows(curves);
    const { names, range } = colours(curves);
    const top = Math.max(...rows.map((r) => r.force * (r.name === "reference" ? 1 + jnd : 1))) * 1.04;
    const bottom = Math.min(0, ...rows.map((r) => r.force));
    const ends = names.map((name) => rows.filter((r) => r.name === name).at(-1));
    const labels = narrow ? [] : spreadLabels(ends, (top - bottom) / (height - 60));
    return Plot.plot({
        width,
        height,
        marginLeft: 48,
        marginBottom: 40,
        marginRight: narrow ? 10 : 130,
        className: "figure-plot",
        ariaLabel: "Force over time",
        color: { domain: names, range, legend: narrow },
        x: { label: "time (s) \u2192" },
        y: { label: "\u2191 force (N)", grid: true, domain: [bottom, top] },
        marks: curveMarks(rows, labels, jnd),
    });
}

const option = (value) => ({
    value: String(value),
    label: typeof value === "number" ? value.toLocaleString("en-US") : String(value),
});

/** Choices among the curves of a scene; what is not there any more is replaced by what is. */
function curveControls(scenes, scene, choices, selection, redraw) {
    const members = { load: "Load", tets: "Tetrahedra" };
    const boxes = Object.entries(members).map(([member, label]) => {
        const compared = scene.curves.filter((c) => member === "load" || c.method !== "reference");
        const values = [...new Set(compared.map((c) => c[member]))];
        if (!values.includes(choices[member])) choices[member] = values[0];
        if (values.length < 2) return null;
        return choice(label, values.map(option), String(choices[member]), (text) => {
            choices[member] = values.find((value) => String(value) === text);
            redraw();
        });
    });
    const names = scenes.map((s) => option(s.name));
    return [choice("Scene", names, scene.name, (name) => selection.set(name)), ...boxes].filter(Boolean);
}

export function curvesSection(data, selection) {
    const scenes = data.scenes.filter((s) => s.curves.length > 0);
    if (scenes.length === 0) return [absent("No force curves in this evaluation.")];
    const choices = {};
    const box = h("div", { class: "plot", id: "curves-plot" });
    const controls = h("div", { class: "controls" });
    const scene = () => scenes.find((s) => s.name === selection.scene) ?? scenes[0];
    const isShown = (c) =>
        c.load === choices.load &&
        (c.method === "reference" || choices.tets === undefined || c.tets === choices.tets);
    const note = h("p", { class: "note" });
    const redraw = redrawnToWidth(box, (width) => {
        const shown = scene().curves.filter(isShown);
        const hasReference = shown.some((c) => c.method === "reference");
        note.textContent = hasReference ? "" : "No curve of the reference was recorded, so there is no band.";
        return chart(width, shown, data.jnd);
    });
    const refresh = () => {
        controls.replaceChildren(...curveControls(scenes, scene(), choices, selection, redraw));
        redraw();
    };
    selection.onchange(refresh);
    refresh();
    const caption = [
        "Force on the tool over time. The grey band is the reference ",
        `\u00b1 ${percent(data.jnd, 0)}: a curve inside it cannot be told from the reference by touch. `,
        "Where several seeds were recorded, each has its line.",
    ];
    return [controls, figure(2, box, ...caption), note];
}
