// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as the page writes them.

const kMinus = "\u2212";
const kNarrowSpace = "\u202f";

export function count(n) {
    return Number.isFinite(n) ? Math.round(n).toLocaleString("en-US") : "\u2013";
}

/** At least `digits` significant digits, never an exponent. */
export function significant(x, digits = 3) {
    if (!Number.isFinite(x)) return "\u2013";
    if (x === 0) return "0";
    const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(x))));
    return x.toFixed(Math.min(decimals, 8)).replace("-", kMinus);
}

/** A share as signed percent: 0.0512 is "+5.1 %". */
export function signedPercent(share, decimals = 1) {
    if (!Number.isFinite(share)) return "\u2013";
    const text = Math.abs(100 * share).toFixed(decimals);
    const sign = Number(text) === 0 ? "" : share < 0 ? kMinus : "+";
    return sign + text + kNarrowSpace + "%";
}

export function percent(share, decimals = 1) {
    return Number.isFinite(share) ? (100 * share).toFixed(decimals) + kNarrowSpace + "%" : "\u2013";
}

/** Microseconds as µs below a millisecond, ms above. */
export function duration(us) {
    if (!Number.isFinite(us)) return "\u2013";
    return us < 1000
        ? significant(us, 3) + kNarrowSpace + "\u00b5s"
        : significant(us / 1000, 3) + kNarrowSpace + "ms";
}

/** A duration for an axis: no more digits than the tick has. */
export function durationTick(us) {
    return us < 1000
        ? Number(us.toPrecision(3)) + kNarrowSpace + "\u00b5s"
        : Number((us / 1000).toPrecision(3)) + kNarrowSpace + "ms";
}

export function bytes(n) {
    if (!Number.isFinite(n)) return "\u2013";
    if (n < 1000) return count(n) + kNarrowSpace + "B";
    return n < 1e6
        ? significant(n / 1e3, 3) + kNarrowSpace + "kB"
        : significant(n / 1e6, 3) + kNarrowSpace + "MB";
}

export function newtons(f) {
    return Number.isFinite(f) ? significant(f, 4) + kNarrowSpace + "N" : "\u2013";
}

export function kilopascals(pa) {
    return Number.isFinite(pa) ? significant(pa / 1000, 3) + kNarrowSpace + "kPa" : "\u2013";
}

/** 1, 2, 5 per decade inside [low, high]: powers of ten only where room is short, more where few would be left. */
export function logTicks(low, high, dense = true) {
    const usual = logMultiples(low, high, dense ? [1, 2, 5] : [1]);
    return usual.length < 3 ? logMultiples(low, high, [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]) : usual;
}

function logMultiples(low, high, multiples) {
    const ticks = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
        for (const m of multiples)
            if (m * 10 ** e >= low * 0.999 && m * 10 ** e <= high * 1.001) ticks.push(m * 10 ** e);
    return ticks;
}

export function plural(n, one, many = one + "s") {
    return `${count(n)} ${n === 1 ? one : many}`;
}
