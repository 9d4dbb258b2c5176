// SPDX-License-Identifier: GPL-3.0-or-later
// The command line that makes a level's results again.

const quoted = (text) =>
    /^[\w@%+=:,./-]+$/.test(text) ? text : `'${String(text).replaceAll("'", "'\\''")}'`;

/** The scene's file as the evaluation was given it, else the name it would usually have. */
function fileOf(data, name) {
    const words = typeof data.command === "string" ? data.command.split(/\s+/) : [];
    return words.find((word) => word.split("/").at(-1) === `${name}.toml`) ?? `${name}.toml`;
}

/** knead-evaluate for one level: its scenes, method, mesh, loads and seeds. */
export function commandOf(data, scenes, level) {
    const seeds = level.runs.map((run) => run.seed).filter(Number.isFinite);
    const words = [
        "knead-evaluate",
        ...scenes.map((scene) => quoted(fileOf(data, scene.name))),
        "--methods",
        quoted(level.method),
    ];
    if (level.method === "paper") words.push("--bins", level.bins, "--clusters", level.clusters);
    words.push("--levels", level.tets, "--loads", quoted(level.loads.join(",")));
    if (seeds.length) words.push("--seeds", new Set(seeds).size, "--seed-base", Math.min(...seeds));
    if (scenes.some((scene) => scene.reference?.kind === "finer")) words.push("--reference", "finer");
    return words.join(" ");
}
