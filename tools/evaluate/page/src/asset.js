// SPDX-License-Identifier: GPL-3.0-or-later
// What each scene's asset holds, which line of the scene asked for it, and what was left out and why.
import { absent, caption, choice, h, head, scrolling } from "./dom.js";
import { bytes, count } from "./format.js";

function row(entry, largest) {
    const out = Boolean(entry.left_out);
    const what = typeof entry.left_out === "string" ? entry.left_out : "left out";
    const reason = [out && entry.left_out !== true ? what : null, entry.why].filter(Boolean).join(": ");
    const share = largest > 0 ? (100 * (entry.bytes ?? 0)) / largest : 0;
    return h(
        "tr",
        { class: out ? "out" : null },
        h("th", { scope: "row" }, h("code", {}, entry.group ?? "\u2013")),
        h("td", { class: "state" }, out ? "\u2212 left out" : "in the asset"),
        h("td", { class: "number" }, out && !entry.bytes ? "\u2013" : bytes(entry.bytes)),
        h("td", { class: "bar", "aria-hidden": "true" }, h("span", { style: `width:${share.toFixed(1)}%` })),
        h("td", { class: "asked" }, entry.asked_for_by || "\u2013"),
        h("td", { class: "why" }, reason || "\u2013"),
    );
}

function table(scene) {
    const largest = Math.max(0, ...scene.asset.map((e) => e.bytes ?? 0));
    const total = scene.asset.reduce((sum, e) => sum + (e.bytes ?? 0), 0);
    const left = scene.asset.filter((e) => e.left_out).length;
    const entries = [...scene.asset].sort(
        (a, b) => Boolean(a.left_out) - Boolean(b.left_out) || (b.bytes ?? 0) - (a.bytes ?? 0),
    );
    return scrolling(
        h(
            "table",
            {},
            caption(
                `Asset of ${scene.name}: ${bytes(total)} in ${count(scene.asset.length - left)} groups; ${count(left)} left out.`,
            ),
            head("Group", "State", { number: "Bytes" }, "", "Asked for by", "Why"),
            h(
                "tbody",
                {},
                entries.map((e) => row(e, largest)),
            ),
        ),
        "Asset contents",
    );
}

export function assetSection(data, selection) {
    const scenes = data.scenes.filter((s) => s.asset.length > 0);
    if (scenes.length === 0) return [absent("No asset contents in this evaluation.")];
    const box = h("div", {}),
        controls = h("div", { class: "controls" });
    const refresh = () => {
        const scene = scenes.find((s) => s.name === selection.scene) ?? scenes[0];
        controls.replaceChildren(
            choice(
                "Scene",
                scenes.map((s) => ({ value: s.name, label: s.name })),
                scene.name,
                (name) => selection.set(name),
            ),
        );
        box.replaceChildren(table(scene));
    };
    selection.onchange(refresh);
    refresh();
    return [controls, box];
}
