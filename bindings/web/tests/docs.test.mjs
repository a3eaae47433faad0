// The snippets of the docs for web pages, in Chromium.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cp, readFile, writeFile } from "node:fs/promises";
import { createServer } from "node:http";
import { join } from "node:path";
import { test } from "node:test";
import { browser, until } from "../../../tests/browser/support.mjs";
import { BUILT, withFolder } from "./support.mjs";

const ROOT = join(import.meta.dirname, "../../..");

/** The first snippet of the docs in a language. */
async function snippet(language) {
    const text = await readFile(join(ROOT, "docs/browser.md"), "utf8");
    return new RegExp(`^\`\`\`${language}\\n([^]*?)^\`\`\``, "m").exec(text)[1];
}

/** What a page of HTML shows, with a folder of files beside it; those that are not there are not found. */
async function served(folder, html, words) {
    const types = { js: "text/javascript", wasm: "application/wasm" };
    const server = createServer(async ({ url }, response) => {
        const bytes = url === "/" ? `<!doctype html>${html}` : await readFile(join(folder, url)).catch(() => null);
        response.writeHead(bytes === null ? 404 : 200, { "Content-Type": types[url.split(".").pop()] ?? "text/html" });
        response.end(bytes);
    });
    await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
    const own = await browser();
    try {
        const page = await own.context.newPage();
        const failed = new Promise(resolve => page.on("pageerror", error => resolve(error.message)));
        await page.goto(`http://127.0.0.1:${server.address().port}/`);
        const text = until(async () => (assert.match(await page.locator("body").innerText(), /\d+ planes/), "planes"));
        assert.match(await Promise.race([text, failed]), words);
    } finally {
        await own.close();
        server.close();
    }
}

test("the snippet of HTML on the page of the docs runs in a browser", () => withFolder(async folder => {
    await cp(join(BUILT, "package"), join(folder, "depthplanes"), { recursive: true });
    await served(folder, await snippet("html"), /^planes$/);
}));

test("bundled by esbuild as the docs say it runs in a browser, and otherwise it is said what to do", () => withFolder(async folder => {
    await cp(join(BUILT, "package"), join(folder, "node_modules/depthplanes"), { recursive: true });
    const code = await snippet("javascript");
    const esbuild = join(ROOT, "crates/depthplanes-serve/page/node_modules/.bin/esbuild");
    const [, words] = /^esbuild (.*)$/m.exec(await readFile(join(ROOT, "docs/browser.md"), "utf8"));
    const bundle = () => execFileSync(esbuild, words.split(" "), { cwd: folder, stdio: "pipe" });
    const html = '<body><script type="module" src="/page.js"></script>';
    await writeFile(join(folder, "page.js"), code);
    bundle();
    await served(join(folder, "public"), html, /^planes$/);
    await writeFile(join(folder, "page.js"), code.replace(/^.*\.wasm";\n/m, "").replace("load(wasm)", "load()"));
    bundle();
    await served(join(folder, "public"), html, /depthplanes\.wasm: 404.*import wasm from "depthplanes\/depthplanes\.wasm".*--loader:\.wasm=file/);
}));
