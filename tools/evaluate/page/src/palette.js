// SPDX-License-Identifier: GPL-3.0-or-later
// One colour and one symbol per method, the same in every figure and legible on light and dark ground.
import { interpolateRgbBasis, scaleSequentialLog } from "d3";

const kMethods = {
    paper: ["#3b6fd6", "circle"],
    homogenised: ["#e8702a", "square"],
    "raw-dominant": ["#159c8c", "diamond"],
    voigt: ["#d29b00", "triangle"],
    reuss: ["#a06a45", "triangle2"],
    geometric: ["#6f9fd8", "star"],
    hill: ["#9a5fe0", "hexagon"],
    kmod09: ["#e0529c", "wye"],
    iycn13: ["#4a9f3f", "cross"],
    calibrated: ["#7f8b96", "diamond2"],
};
const kOther = ["#8a8f3a", "plus"];

export function methodColour(method) {
    return method === "reference" ? "currentColor" : (kMethods[method] ?? kOther)[0];
}

export function methodSymbol(method) {
    return (kMethods[method] ?? kOther)[1];
}

/** Known methods in the order of this page, then any others. */
export function methodsInOrder(methods) {
    const known = Object.keys(kMethods);
    const rank = (m) => (known.includes(m) ? known.indexOf(m) : known.length);
    return [...methods].sort((a, b) => rank(a) - rank(b));
}

/** Soft is pale yellow and stiff dark red, as in the paper's figures; lightness falls all the way. */
const kStiffness = interpolateRgbBasis(["#fdeea0", "#fbc55a", "#f28b3c", "#d84a35", "#a8233f", "#7c1745"]);

export function stiffnessScale(low, high) {
    const top = high > low * 1.001 ? high : low * 1.1;
    return scaleSequentialLog([low, top], kStiffness).clamp(true);
}
