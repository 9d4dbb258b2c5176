// SPDX-License-Identifier: GPL-3.0-or-later
// The states C1..C5 of a scene: one of them as a solid to turn and cut, all of them in the plane of the cut.
import * as Plot from "@observablehq/plot";
import { absent, choice, figure, h, segments } from "./dom.js";
import { count, kilopascals, logTicks, percent } from "./format.js";
import { stiffnessScale } from "./palette.js";
import { Solid } from "./solid.js";
import { bounds, centroids, neighbours, section } from "./tetmesh.js";

const kAxes = ["x", "y", "z"];

/** Faces and middles are found once per state, when it is first looked at. */
function prepared(state) {
    state.behind ??= neighbours(state.tetrahedra);
    state.bounds ??= bounds(state.nodes);
    state.middles ??= [0, 1, 2].map((axis) => centroids(state, axis));
    return state;
}

/** Where the cut goes through: tetrahedra in front of it, towards the viewer, go. */
function cutPosition(state, choices) {
    const { low, high } = prepared(state).bounds;
    const [from, to] = choices.axis === 1 ? [low[1], high[1]] : [high[choices.axis], low[choices.axis]];
    return from + choices.cut * (to - from);
}

function keptBy(state, choices) {
    if (choices.cut === 0) return () => true;
    const position = cutPosition(state, choices),
        middles = state.middles[choices.axis];
    return choices.axis === 1 ? (t) => middles[t] >= position : (t) => middles[t] <= position;
}

function rangeOf(states) {
    let low = Infinity,
        high = 0;
    for (const s of states)
        for (const e of s.youngs) if (e > 0) [low, high] = [Math.min(low, e), Math.max(high, e)];
    return [low, high];
}

/** A colour bar that is itself a plot, so its ticks are those of the scale. */
function colourBar(scale, width) {
    const [low, high] = scale.domain();
    return Plot.legend({
        color: {
            type: "log",
            domain: [low, high],
            interpolate: (t) => scale(low * (high / low) ** t),
            label: "Young\u2019s modulus (kPa)",
            ticks: logTicks(low, high, high / low < 200),
            tickFormat: (e) => String(Number((e / 1000).toPrecision(2))),
        },
        width,
        marginLeft: 14,
        marginRight: 14,
        className: "figure-legend",
    });
}

/** Polygons of the section as a drawing takes them, with the middle where a tooltip points. */
function sectionFeatures(state, choices) {
    return section(state, choices.axis, sectionPlane(state, choices)).map(({ tet, points }) => ({
        type: "Feature",
        tet,
        geometry: { type: "Polygon", coordinates: [[...points, points[0]]] },
        middle: [0, 1].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length),
    }));
}

/** Seen from -y, +x or +z: the two other axes point right and up. */
function crossSection(state, choices, scale, width) {
    const features = sectionFeatures(state, choices);
    const [u, v] = [0, 1, 2].filter((k) => k !== choices.axis);
    const { low, high } = state.bounds;
    const corners = [low, high].map((corner) => [corner[u], corner[v]]);
    const height = Math.max(40, Math.round((width * (high[v] - low[v])) / (high[u] - low[u])));
    const edges = { stroke: "#14171a", strokeOpacity: 0.28, strokeWidth: 0.6 };
    const middle = { x: (f) => f.middle[0], y: (f) => f.middle[1] };
    const title = (f) => `${kilopascals(state.youngs[f.tet])}\ntetrahedron ${f.tet}`;
    return Plot.plot({
        width,
        height,
        margin: 1,
        className: "figure-plot",
        ariaLabel: `Cross-section of ${state.name}`,
        projection: { type: "reflect-y", domain: { type: "LineString", coordinates: corners } },
        color: { type: "identity" },
        marks: [
            Plot.geo(features, { fill: (f) => scale(state.youngs[f.tet]), ...edges }),
            Plot.tip(features, Plot.pointer({ ...middle, title, fontSize: 12, lineHeight: 1.3 })),
        ],
    });
}

/** The plane of the cut, a hair into what stays: a cut along mesh faces shows the faces that it lays open. */
function sectionPlane(state, choices) {
    const { axis } = choices;
    const { low, high } = state.bounds;
    const hair = 1e-6 * (high[axis] - low[axis]);
    const position = cutPosition(state, choices) + (axis === 1 ? hair : -hair);
    return Math.min(high[axis] - hair, Math.max(low[axis] + hair, position));
}

function sectionsFigure(choices) {
    const box = h("div", { class: "sections", id: "cross-sections" });
    const draw = (states, scale) => {
        const columns = box.clientWidth < 700 ? 2 : box.clientWidth < 900 ? 3 : 5;
        const width = Math.floor((box.clientWidth - 14 * (columns - 1)) / columns);
        box.style.setProperty("--columns", columns);
        const sizes = ({ youngs }) => `${count(youngs.length)} tets, ${count(new Set(youngs).size)} moduli`;
        const square = (state) => crossSection(prepared(state), choices, scale, width);
        const name = (state) => h("p", {}, h("b", {}, state.name), h("br"), sizes(state));
        box.replaceChildren(...states.map((state) => h("div", {}, square(state), name(state))));
    };
    return { box, draw };
}

function solidOrReason(canvas) {
    try {
        return { solid: new Solid(canvas) };
    } catch {
        return {
            reason: absent("This browser has no WebGL, so the solid is not shown; the cross-sections are."),
        };
    }
}

function keysNote(solid) {
    const reset = h("button", { type: "button", onclick: () => solid.reset() }, "Reset view");
    const text = "Drag to turn. With the picture in focus: arrow keys turn, + and \u2212 zoom, 0 resets. ";
    return h("p", { id: "solid-keys", class: "note" }, text, reset);
}

/** The places of solid, colour bar and sections, and `draw(scene)`, which fills them. */
function statesPicture(choices) {
    const canvas = h("canvas", { id: "solid", tabindex: "0", role: "img", "aria-describedby": "solid-keys" });
    const stage = h("div", { class: "stage" }, canvas);
    const bar = h("div", { class: "legend" });
    const { solid, reason } = solidOrReason(canvas);
    const sections = sectionsFigure(choices);
    const draw = ({ name, states }) => {
        const state = prepared(states[choices.state]);
        const scale = stiffnessScale(...rangeOf(states));
        const cut = `cut at ${percent(choices.cut, 0)} along ${kAxes[choices.axis]}`;
        canvas.setAttribute("aria-label", `${state.name} of ${name}, ${cut}`);
        bar.replaceChildren(colourBar(scale, Math.min(360, bar.clientWidth || 300)));
        solid?.show(state, state.behind, keptBy(state, choices), (t) => scale(state.youngs[t]));
        sections.draw(states, scale);
    };
    new ResizeObserver(() => solid?.resize(stage.clientWidth, stage.clientHeight)).observe(stage);
    const left = h("div", {}, reason ?? [stage, keysNote(solid)]);
    return { box: h("div", { class: "both" }, left, h("div", {}, bar, sections.box)), sections, draw };
}

/** Controls, solid and sections of one scene's states; `selection` is the scene chosen anywhere on the page. */
export function statesSection(data, selection) {
    const scenes = data.scenes.filter((s) => s.states.length > 0);
    if (scenes.length === 0) return [absent("No states C1 to C5 in this evaluation.")];
    const choices = { state: 0, axis: 1, cut: 0.5 };
    const picture = statesPicture(choices);
    const controls = h("div", { class: "controls" });
    const scene = () => scenes.find((s) => s.name === selection.scene) ?? scenes[0];
    let asked = false;
    const redraw = () => {
        if (asked) return;
        asked = true;
        requestAnimationFrame(() => {
            asked = false;
            picture.draw(scene());
        });
    };
    const refresh = () => {
        choices.state = Math.min(choices.state, scene().states.length - 1);
        controls.replaceChildren(...stateControls(scenes, scene(), choices, selection, redraw));
        redraw();
    };
    selection.onchange(refresh);
    refresh();
    new ResizeObserver(redraw).observe(picture.sections.box);
    return [controls, figure(3, picture.box, ...kCaption)];
}

const kCaption = [
    "The states of the object, coloured by Young\u2019s modulus on a log scale: initial (C1), clustered (C2), ",
    "homogenised (C3), aggregated (C4), coarse (C5). The cut leaves out whole tetrahedra, so what remains is ",
    "solid and is what was computed. The squares: the plane of the cut through every state.",
];

function cutSlider(choices, redraw) {
    const output = h("output", {}, percent(choices.cut, 0));
    const moved = () => {
        choices.cut = Number(slider.value) / 100;
        output.textContent = percent(choices.cut, 0);
        redraw();
    };
    const value = String(Math.round(100 * choices.cut));
    const slider = h("input", { type: "range", min: "0", max: "95", value, id: "cut", oninput: moved });
    return h("label", { class: "choice" }, h("span", {}, "Cut away"), slider, output);
}

function stateControls(scenes, scene, choices, selection, redraw) {
    const pick = (member) => (value) => {
        choices[member] = Number(value);
        redraw();
    };
    const numbered = (labels) => labels.map((label, i) => ({ value: String(i), label }));
    const names = scenes.map((s) => ({ value: s.name, label: s.name }));
    const states = numbered(scene.states.map((s) => s.name));
    return [
        choice("Scene", names, scene.name, (name) => selection.set(name)),
        segments("State", "state", states, String(choices.state), pick("state")),
        segments("Cut along", "axis", numbered(kAxes), String(choices.axis), pick("axis")),
        cutSlider(choices, redraw),
    ];
}
