// SPDX-License-Identifier: GPL-3.0-or-later
// Bundles src/ into one self-contained page. node build.mjs OUTPUT
// The page keeps one placeholder, @KNEAD_EVALUATION@, where html_report() puts the data.
import { build } from "esbuild";
import { readFile, rename, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const kPlaceholder = "@KNEAD_EVALUATION@";
const here = (name) => fileURLToPath(new URL(`src/${name}`, import.meta.url));

async function bundle(name, options) {
    const result = await build({
        entryPoints: [here(name)],
        bundle: true,
        minify: true,
        write: false,
        charset: "utf8",
        legalComments: "inline",
        logLevel: "warning",
        ...options,
    });
    return result.outputFiles[0].text.trim();
}

/** The text as the content of a script element: an end tag in a string must not end the element. */
function scriptText(text) {
    return text.replaceAll(/<\/(script)/gi, "<\\/$1").replaceAll("<!--", "<\\!--");
}

const output = process.argv[2];
if (!output) throw new Error("usage: node build.mjs OUTPUT");
const style = await bundle("style.css", {});
const script = scriptText(
    await bundle("main.js", { format: "iife", target: ["chrome105", "firefox121", "safari16"] }),
);
const page = (await readFile(here("report.html"), "utf8"))
    .replace("@STYLE@", () => style)
    .replace("@SCRIPT@", () => script);
if (page.split(kPlaceholder).length !== 2) throw new Error(`the page must have ${kPlaceholder} exactly once`);
await writeFile(`${output}.part`, page);
await rename(`${output}.part`, output);
console.log(`${output}: ${Buffer.byteLength(page)} bytes`);
