// SPDX-License-Identifier: Apache-2.0
// The whole page in headless Chromium, from a file, as its reader opens it.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { after, test } from "node:test";
import { launch, open, removePages, settled, written } from "./browser.mjs";
import { evaluation } from "./generate.mjs";

const kMaxBytes = 3e6;
const kWidths = [1280, 400];
const kHostile = "</script><script>window.broken = 1</script>\u2028<b>&amp;";

const data = evaluation({ seeds: 3 });
const usual = written(data, "usual");
const browser = await launch();
after(async () => {
    await browser.close();
    removePages();
});

/** Opens the page, runs `check(page)`, and asserts that nothing went wrong in it. */
async function inPage(file, options, check) {
    const { page, problems, close } = await open(browser, file, options);
    try {
        await check(page);
        assert.deepEqual(problems, []);
    } finally {
        await close();
    }
}

/** How many different colours a canvas shows, its clear ground aside. */
const coloursOf = (page) =>
    page.evaluate(() => {
        const canvas = document.getElementById("solid"),
            copy = document.createElement("canvas");
        [copy.width, copy.height] = [canvas.width, canvas.height];
        const context = copy.getContext("2d");
        context.drawImage(canvas, 0, 0);
        const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
        return new Set(pixels.filter((pixel) => pixel >>> 24 === 255)).size;
    });

const pictureOf = (page) => page.evaluate(() => document.getElementById("solid").toDataURL());

/** The first point of the plot that no other lies on, so that the pointer means it. */
async function hoverALevel(page) {
    const place = await page.evaluate(() => {
        const points = [...document.querySelectorAll("#pareto-plot [aria-description='the levels'] > *")]
            .map((p) => p.getBoundingClientRect())
            .map((b) => [b.x + b.width / 2, b.y + b.height / 2]);
        const apart = (p) =>
            Math.min(...points.filter((q) => q !== p).map((q) => Math.hypot(p[0] - q[0], p[1] - q[1])));
        return points.sort((p, q) => apart(q) - apart(p))[0];
    });
    await page.mouse.move(place[0] - 1, place[1] - 1);
    await page.mouse.move(...place);
    await settled(page);
}

test("Page_shows_every_section_with_its_content", async () => {
    await inPage(usual, {}, async (page) => {
        const ids = await page.$$eval("main > section", (sections) => sections.map((s) => s.id));
        assert.deepEqual(ids, ["summary", "pareto", "curves", "table-2", "table-1", "states", "asset"]);
        assert.equal(await page.locator("main .absent").count(), 0);
        assert.equal(await page.locator("#summary tbody tr").count(), 9);
        assert.equal(await page.locator("#pareto-plot [aria-description='the levels'] > *").count(), 19);
        assert.match(
            await page.locator("#pareto .note").textContent(),
            /1 level not drawn: kmod09.*no step time/,
        );
        assert.equal(await page.locator("#pareto-plot [aria-description='the JND'] > *").count(), 1);
        assert.match(
            await page.locator("#pareto-plot [aria-description='the front'] path").getAttribute("d"),
            /^M[\d.]+,[\d.]+[LHV]/,
        );
        assert.match(
            await page.locator("#curves-plot [aria-description='the JND band'] path").getAttribute("d"),
            /^M[\d.]+/,
        );
        assert.equal(await page.locator("#cross-sections svg").count(), 5);
        assert.equal(await page.locator("#asset tbody tr.out").count(), 3);
        assert.equal(await page.locator("nav a").count(), 7);
    });
});

test("Page_labels_every_tick_of_its_log_axes", async () => {
    await inPage(usual, {}, async (page) => {
        const labels = await page.$$eval("#pareto-plot [aria-label$='axis tick label'] text", (texts) =>
            texts.map((t) => t.textContent),
        );
        assert.ok(labels.length >= 10, labels.join());
        assert.ok(
            labels.every((label) => /\d.*(%|s)$/.test(label)),
            labels.join(),
        );
    });
});

test("Page_marks_the_cells_of_table_2_by_sign_and_colour", async () => {
    await inPage(usual, {}, async (page) => {
        const cells = await page.$$eval("#table2 td.pass, #table2 td.miss", (found) =>
            found.map((td) => [td.className, td.textContent]),
        );
        const expected = data.scenes.flatMap((scene) =>
            ["homogenised", 1, 3, 6].flatMap((level) =>
                [6000, 3072, 1296].map((tets) => {
                    const errors = scene.results
                        .filter(
                            (r) =>
                                r.load === "press10" &&
                                r.tets === tets &&
                                (level === "homogenised"
                                    ? r.method === level
                                    : r.method === "paper" && r.clusters === level),
                        )
                        .map((r) => r.force_error);
                    return Math.abs(errors.reduce((a, b) => a + b) / errors.length) <= 0.1;
                }),
            ),
        );
        assert.equal(cells.length, 108);
        assert.equal(cells.filter(([kind]) => kind.includes("pass")).length, expected.filter(Boolean).length);
        for (const [kind, text] of cells)
            assert.ok(text.startsWith(kind.includes("pass") ? "\u2713inside" : "\u2717outside"), text);
        const colours = await page.$$eval("#table2 td.pass, #table2 td.miss", (found) => [
            ...new Set(found.map((td) => getComputedStyle(td).backgroundColor)),
        ]);
        assert.equal(colours.length, 2);
        assert.match(await page.locator(".totals").textContent(), /Ours: \d+ of 81.*Paper: \d+ of 81/);
    });
});

test("Pointer_on_a_level_shows_its_tooltip", async () => {
    await inPage(usual, {}, async (page) => {
        const tip = page.locator("#pareto-plot [aria-label='tip']");
        for (const width of kWidths) {
            await page.setViewportSize({ width, height: 900 });
            await settled(page);
            await page.evaluate(() =>
                document.getElementById("pareto-plot").scrollIntoView({ block: "center" }),
            );
            assert.equal((await tip.textContent()).trim(), "");
            await hoverALevel(page);
            const text = await tip.textContent();
            for (const part of [
                "bins",
                "k ",
                "tets",
                "load press10",
                "step",
                "|error|",
                "\u00b1",
                "seed",
                "$ knead-evaluate",
                "examples/cubes/",
            ])
                assert.ok(text.includes(part), `${part} in: ${text}`);
        }
    });
});

test("Choice_of_a_scene_in_one_section_changes_the_others", async () => {
    await inPage(usual, {}, async (page) => {
        await page.locator("#curves select").first().selectOption("scenario9");
        await settled(page);
        assert.match(await page.locator("#asset caption").textContent(), /scenario9/);
        assert.match(await page.locator("#solid").getAttribute("aria-label"), /scenario9/);
    });
});

test("Page_fits_its_window_without_scrolling_sideways", async () => {
    await inPage(usual, {}, async (page) => {
        await page.locator("details summary").first().click();
        for (const width of kWidths) {
            await page.setViewportSize({ width, height: 900 });
            await settled(page);
            assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
            // What is wider than the window must be inside a box that scrolls.
            const loose = await page.evaluate(() =>
                [...document.querySelectorAll("main *")]
                    .filter(
                        (e) =>
                            e.getBoundingClientRect().right > innerWidth + 1 &&
                            !e.closest(".scroll, svg, .legend"),
                    )
                    .map((e) => e.outerHTML.slice(0, 80)),
            );
            assert.deepEqual(loose, []);
        }
    });
});

test("Page_follows_the_colour_scheme", async () => {
    await inPage(usual, {}, async (page) => {
        const ground = () =>
            page.evaluate(() =>
                getComputedStyle(document.querySelector("section")).backgroundColor.match(/\d+/g).map(Number),
            );
        assert.ok(Math.min(...(await ground())) > 200);
        await page.emulateMedia({ colorScheme: "dark" });
        assert.ok(Math.max(...(await ground())) < 60);
        await page.evaluate(() => document.getElementById("pareto-plot").scrollIntoView({ block: "center" }));
        await hoverALevel(page);
        const tip = await page.evaluate(() =>
            getComputedStyle(document.querySelector("#pareto-plot [aria-label='tip'] path"))
                .fill.match(/\d+/g)
                .map(Number),
        );
        assert.ok(Math.max(...tip.slice(0, 3)) < 60, "the tooltip\u2019s ground is dark too");
    });
});

test("Solid_is_drawn_turned_and_cut_by_keyboard", async () => {
    await inPage(usual, {}, async (page) => {
        assert.ok((await coloursOf(page)) > 20);
        const before = await pictureOf(page);
        await page.locator("#solid").focus();
        for (const key of ["ArrowLeft", "ArrowUp", "+"]) {
            const last = await pictureOf(page);
            await page.keyboard.press(key);
            await settled(page);
            assert.notEqual(await pictureOf(page), last, key);
        }
        await page.keyboard.press("0");
        await settled(page);
        assert.equal(await pictureOf(page), before);
        await page.locator("#cut").focus();
        await page.keyboard.press("Home");
        await settled(page);
        assert.match(await page.locator("#solid").getAttribute("aria-label"), /cut at 0/);
        assert.notEqual(await pictureOf(page), before);
    });
});

test("Solid_is_turned_by_dragging_and_changed_by_its_controls", async () => {
    await inPage(usual, {}, async (page) => {
        let last = await pictureOf(page);
        const changed = async (what) => {
            await settled(page);
            const now = await pictureOf(page);
            assert.notEqual(now, last, what);
            last = now;
        };
        await page.locator("#solid").scrollIntoViewIfNeeded();
        const shown = await page.locator("#solid").boundingBox();
        await page.mouse.move(shown.x + shown.width / 2, shown.y + shown.height / 2);
        await page.mouse.down();
        await page.mouse.move(shown.x + shown.width / 2 + 80, shown.y + shown.height / 2 + 20, { steps: 4 });
        await page.mouse.up();
        await changed("drag");
        await page.locator("input[name=state][value='3']").check();
        await changed("state");
        const sections = await page.locator("#cross-sections").innerHTML();
        await page.locator("input[name=axis][value='0']").check();
        await changed("axis");
        assert.notEqual(await page.locator("#cross-sections").innerHTML(), sections);
    });
});

test("Page_of_a_hostile_name_shows_it_as_text", async () => {
    const hostile = evaluation({ seeds: 1 });
    hostile.scenes[0].name = kHostile;
    hostile.commit = kHostile;
    await inPage(written(hostile, "hostile"), {}, async (page) => {
        assert.equal(await page.evaluate(() => window.broken), undefined);
        assert.equal(await page.locator("#summary tbody th").first().textContent(), kHostile);
        assert.equal(await page.locator("main b", { hasText: "&" }).count(), 0);
    });
});

test("Page_without_the_optional_parts_says_so_in_their_places", async () => {
    const bare = evaluation({ seeds: 2 });
    for (const scene of bare.scenes)
        for (const part of ["curves", "states", "asset", "reference"]) delete scene[part];
    for (const part of ["paper", "machine", "commit", "command"]) delete bare[part];
    for (const run of bare.scenes.flatMap((s) => s.results))
        for (const part of ["step_us", "fitted"]) if (run.seed === 2 || part === "fitted") delete run[part];
    await inPage(written(bare, "bare"), {}, async (page) => {
        for (const [id, text] of [
            ["curves", "No force curves"],
            ["states", "No states"],
            ["asset", "No asset contents"],
            ["table-2", "paper\u2019s numbers are not"],
        ])
            assert.ok((await page.locator(`#${id} .absent`).first().textContent()).includes(text), id);
        assert.equal(await page.locator("#table2 td.pass, #table2 td.miss").count(), 108);
    });
});

test("Page_of_an_empty_or_foreign_evaluation_stands", async () => {
    for (const [name, content] of [
        ["empty", {}],
        ["no-scenes", { schema: "knead-evaluation/1", scenes: [] }],
        ["bare-scene", { scenes: [{ name: "a" }] }],
        ["number", 3],
    ])
        await inPage(written(content, name), {}, async (page) => {
            const said = await page.locator("main .absent").allTextContents();
            assert.ok(said.length >= 1, name);
            assert.equal(
                said.some((text) => text.includes("cannot be read")),
                name === "number",
                said.join(),
            );
            assert.equal(await page.locator("main > section").count(), name === "number" ? 0 : 7, name);
        });
});

test("Page_of_a_level_that_never_converged_counts_it_as_a_miss", async () => {
    const failing = evaluation({ seeds: 2 });
    for (const run of failing.scenes[0].results)
        if (run.method === "homogenised") Object.assign(run, { converged: false, force_error: null });
    await inPage(written(failing, "failing"), {}, async (page) => {
        assert.match(
            await page.locator("#table2 tbody tr").nth(1).locator("td").first().textContent(),
            /^\u2717.*not converged/,
        );
        await page.locator("#pareto select").first().selectOption("scenario1");
        await settled(page);
        assert.match(await page.locator("#pareto .note").textContent(), /4 levels not drawn/);
    });
});

test("Page_of_curves_without_a_reference_says_that_there_is_no_band", async () => {
    const lacking = evaluation({ seeds: 1 });
    for (const scene of lacking.scenes) scene.curves = scene.curves.filter((c) => c.method !== "reference");
    await inPage(written(lacking, "lacking"), {}, async (page) => {
        assert.match(await page.locator("#curves .note").textContent(), /no band/);
        assert.equal((await page.locator("#curves-plot path").count()) > 0, true);
    });
});

test("Page_of_a_typical_run_is_at_most_3_MB", () => {
    const typical = written(evaluation({ fine: 10, coarse: 6 }), "typical");
    assert.ok(statSync(typical).size <= kMaxBytes, `${statSync(typical).size} bytes`);
    console.log(`${statSync(typical).size} bytes with 9 scenes, 3,636 runs and states of 6,000 tetrahedra`);
});
