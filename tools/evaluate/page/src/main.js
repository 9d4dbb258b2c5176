// SPDX-License-Identifier: GPL-3.0-or-later
// The page: reads the evaluation that stands in it and fills one section after the other.
import { assetSection } from "./asset.js";
import { curvesSection } from "./curves.js";
import { kSchema, readEvaluation } from "./data.js";
import { absent, h } from "./dom.js";
import { plural } from "./format.js";
import { paretoSection } from "./pareto.js";
import { statesSection } from "./states.js";
import { summarySection } from "./summary.js";
import { table2Section, timeSection } from "./table2.js";

/** The scene that the sections about one scene show; choosing it in one changes all. */
function sharedSelection() {
    const listeners = [];
    const selection = {
        scene: undefined,
        onchange: (listener) => listeners.push(listener),
        set: (name) => {
            selection.scene = name;
            listeners.forEach((listener) => listener());
        },
    };
    return selection;
}

const kSections = [
    ["summary", "Summary", summarySection],
    ["pareto", "Error against run time", paretoSection],
    ["curves", "Force over time", curvesSection],
    ["table-2", "Force error per scene", table2Section],
    ["table-1", "Time of one step", timeSection],
    ["states", "States of the object", statesSection],
    ["asset", "Asset contents: what was left out, and why", assetSection],
];

/** A part that cannot be drawn says so in its place; the others still stand. */
function filled(make, data, selection) {
    try {
        return make(data, selection);
    } catch (error) {
        console.error(error);
        return [absent(`This part could not be drawn: ${error.message}`)];
    }
}

function lead(data) {
    const runs = data.scenes.reduce((sum, s) => sum + s.results.length, 0);
    return h(
        "p",
        { class: "lead" },
        `${plural(data.scenes.length, "scene")}, ${plural(runs, "run")}: which level may be used, and what is lost with it.`,
    );
}

function show() {
    const main = document.querySelector("main");
    let data;
    try {
        data = readEvaluation(document.getElementById("knead-evaluation").textContent);
    } catch (error) {
        main.append(absent(`The data of this page cannot be read: ${error.message}`));
        return;
    }
    document.querySelector("header").append(lead(data));
    if (data.schema !== kSchema)
        main.append(
            absent(
                `This page was made for ${kSchema}; the data says ${JSON.stringify(data.schema ?? null)}.`,
            ),
        );
    const selection = sharedSelection();
    const nav = document.querySelector("nav ul");
    for (const [id, title, make] of kSections) {
        const section = h(
            "section",
            { id, "aria-labelledby": `${id}-title` },
            h("h2", { id: `${id}-title` }, title),
        );
        main.append(section);
        section.append(...filled(make, data, selection).filter(Boolean));
        nav.append(h("li", {}, h("a", { href: `#${id}` }, title.split(":")[0])));
    }
}

show();
