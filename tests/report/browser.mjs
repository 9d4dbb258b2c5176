// SPDX-License-Identifier: Apache-2.0
// Pages written by write_report and opened in headless Chromium, with what went wrong in them.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

/** Software drawing, and none of the connections that the browser makes for itself. */
const kFlags = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
];

const folder = mkdtempSync(join(tmpdir(), "knead-report-"));

export function launch() {
    return chromium.launch({ executablePath: process.env.KNEAD_CHROMIUM, args: kFlags });
}

export function removePages() {
    rmSync(folder, { recursive: true, force: true });
}

/** The file of the page that shows `evaluation`. */
export function written(evaluation, name) {
    const data = join(folder, `${name}.json`),
        page = join(folder, `${name}.html`);
    writeFileSync(data, JSON.stringify(evaluation));
    execFileSync(process.env.KNEAD_WRITE_REPORT, [data, process.env.KNEAD_TEMPLATE, page]);
    return page;
}

/** Opens a page; `problems` gathers console errors, exceptions and every request but the page itself. */
export async function open(
    browser,
    file,
    { width = 1280, height = 900, scheme = "light", script = true } = {},
) {
    const context = await browser.newContext({
        viewport: { width, height },
        colorScheme: scheme,
        javaScriptEnabled: script,
    });
    const page = await context.newPage();
    const address = pathToFileURL(file).href,
        problems = [];
    page.on("console", (message) => {
        if (["error", "warning"].includes(message.type()) && !isDriverNote(message.text()))
            problems.push(`${message.type()}: ${message.text()}`);
    });
    page.on("pageerror", (error) => problems.push(`exception: ${error.message}`));
    page.on("request", (request) => {
        const url = request.url();
        if (url.split("#")[0] !== address && !url.startsWith("data:") && !url.startsWith("blob:"))
            problems.push(`request: ${url}`);
    });
    await page.goto(address);
    await page.waitForLoadState("load");
    await settled(page);
    return { page, problems, close: () => context.close() };
}

/** Two frames later: what was asked for in one has been drawn in the next. */
export async function settled(page) {
    if (await page.evaluate(() => true).catch(() => false))
        await page.evaluate(
            () =>
                new Promise((done) =>
                    requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30))),
                ),
        );
}

/** Chromium's notes that reading pixels back stalls a software driver say nothing about the page. */
function isDriverNote(text) {
    return text.includes("GL Driver Message") || text.includes("GPU stall");
}
