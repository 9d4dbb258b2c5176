// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the evaluation that html_report() put into the page: knead-evaluation/1, or its shorter form
// (results as a table, meshes shared by the states, moduli by palette) as html_report.h describes it.

export const kSchema = "knead-evaluation/1";

function restoredResults(results) {
    if (Array.isArray(results)) return results;
    if (!results?.columns) return [];
    const paths = results.columns.map((name) => name.split("."));
    return results.rows.map((row) => {
        const result = {};
        row.forEach((value, i) => {
            if (value === null) return;
            const [outer, inner] = paths[i];
            if (inner) (result[outer] ??= {})[inner] = value;
            else result[outer] = value;
        });
        return result;
    });
}

function restoredState(state, meshes, moduli) {
    const mesh = state.mesh === undefined ? state : meshes[state.mesh];
    const e = (state.modulus === undefined ? state.youngs_modulus_pa : moduli[state.modulus]) ?? [];
    return {
        name: state.name ?? "state",
        nodes: Float64Array.from((mesh.nodes_m ?? []).flat()),
        tetrahedra: Uint32Array.from((mesh.tetrahedra ?? []).flat()),
        youngs: Float64Array.from(e.palette ? e.index.map((i) => e.palette[i]) : e),
    };
}

function sound(state) {
    const nodes = state.nodes.length / 3;
    return (
        state.tetrahedra.length > 0 &&
        state.tetrahedra.every((node) => node < nodes) &&
        state.youngs.length === state.tetrahedra.length / 4
    );
}

/** The evaluation with every optional part present, if empty; throws where the text is not one. */
export function readEvaluation(text) {
    const raw = JSON.parse(text);
    if (typeof raw !== "object" || raw === null) throw new Error("the data is not an object");
    const scenes = (raw.scenes ?? []).map((scene, i) => ({
        ...scene,
        name: String(scene.name ?? `scene ${i + 1}`),
        results: restoredResults(scene.results),
        curves: (scene.curves ?? []).filter(
            (c) => c.time_s?.length > 1 && c.time_s.length === c.force_n?.length,
        ),
        states: (scene.states ?? [])
            .map((s) => restoredState(s, raw.meshes ?? [], raw.moduli ?? []))
            .filter(sound),
        asset: scene.asset ?? [],
    }));
    return { ...raw, jnd: raw.jnd ?? 0.1, scenes };
}
