// SPDX-License-Identifier: GPL-3.0-or-later
// Elements from data. Text is always set as text, so names in the data cannot become markup.

/** An element with attributes (on... are listeners, null and false are left out) and children. */
export function h(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (value === null || value === undefined || value === false) continue;
        if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
        else element.setAttribute(name, value === true ? "" : value);
    }
    element.append(...children.flat().filter((child) => child !== null && child !== undefined));
    return element;
}

/** The one line that stands where a part of the data is missing. */
export function absent(text) {
    return h("p", { class: "absent" }, text);
}

/** A labelled choice; options are {value, label}. Calls `chosen(value)`. */
export function choice(label, options, value, chosen) {
    const select = h(
        "select",
        { onchange: () => chosen(select.value) },
        options.map((o) => h("option", { value: o.value, selected: o.value === value }, o.label)),
    );
    return h("label", { class: "choice" }, h("span", {}, label), select);
}

/** One of a few, all visible: a group of radio buttons drawn as a bar. */
export function segments(legend, name, options, value, chosen) {
    return h(
        "fieldset",
        { class: "segments" },
        h("legend", {}, legend),
        h(
            "div",
            {},
            options.map((o) =>
                h(
                    "label",
                    {},
                    h("input", {
                        type: "radio",
                        name,
                        value: o.value,
                        checked: o.value === value,
                        onchange: () => chosen(o.value),
                    }),
                    h("span", {}, o.label),
                ),
            ),
        ),
    );
}

/** A table that scrolls inside its own box; reachable by keyboard as browsers ask of scrollable regions. */
export function scrolling(table, name) {
    return h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": name }, table);
}

export function numeric(text) {
    return h("td", { class: "number" }, text);
}

/** A caption no wider than the box the table scrolls in. */
export function caption(...text) {
    return h("caption", {}, h("span", {}, text));
}

/** A figure of `content`, with its number and what it shows below. */
export function figure(number, content, ...text) {
    return h("figure", {}, content, h("figcaption", {}, h("b", {}, `Figure ${number}. `), text));
}

export function head(...titles) {
    return h(
        "thead",
        {},
        h(
            "tr",
            {},
            titles.map((t) =>
                typeof t === "string"
                    ? h("th", { scope: "col" }, t)
                    : h("th", { scope: "col", class: "number" }, t.number),
            ),
        ),
    );
}

/** Draws into `box` now and whenever its width changes; `draw(width)` returns what to put there. */
export function redrawnToWidth(box, draw) {
    let drawn = 0;
    const redraw = () => {
        drawn = Math.floor(box.clientWidth);
        if (drawn > 0) box.replaceChildren(...[draw(drawn)].flat());
    };
    new ResizeObserver(() => {
        if (Math.floor(box.clientWidth) !== drawn) redraw();
    }).observe(box);
    return redraw;
}
