// What the tests of the page share: the page in Chromium, and what people do there.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, serialAbove } from "../../../tests/browser/support.mjs";
import { WRITERS } from "./formats.mjs";
import { BUILT, dp } from "./support.mjs";

const PAGE = pathToFileURL(join(BUILT, "depthplanes.html")).href;

let chrome;
before(async () => chrome = await browser());
after(() => chrome?.close());

/** Opens the page without a network; it has asked nobody for anything and complained of nothing in the end. */
export async function withPage(use, { context = chrome.context, allowed = /^$/ } = {}) {
    const page = await context.newPage();
    const complaints = [];
    page.on("pageerror", error => complaints.push(error.stack));
    page.on("console", message => message.type() === "error" && complaints.push(message.text()));
    page.on("request", request => /^(file|blob|data):/.test(request.url()) || complaints.push(`asks ${request.url()}`));
    await context.setOffline(true);
    await page.goto(PAGE);
    await serialAbove(page, 0);
    await use(page);
    assert.deepEqual(complaints.filter(text => !allowed.test(text)), []);
    await page.close();
}

/** Does something and waits until it is drawn. */
export async function drawn(page, act) {
    const before = await page.evaluate(() => Number(document.body.dataset.serial));
    await act();
    await serialAbove(page, before);
}

export const open = (page, file) => drawn(page, () => page.setInputFiles("#file", file));
export const planes = page => page.locator("#planes tbody tr").count();
export const banner = page => page.locator("#banner").textContent();
/** Whether the map of the page has these labels. */
export async function hasLabels(page, labels) {
    const shown = await page.evaluate(async () => {
        const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", window.depthplanes.frame.labels));
        return [...digest].map(byte => byte.toString(16).padStart(2, "0")).join("");
    });
    return shown === createHash("sha256").update(labels).digest("hex");
}

/** Writes a map of millimetres into a folder; the path of the file. */
export async function writeMap(folder, name, spec) {
    const { depth, width, height } = dp.scene(spec);
    await writeFile(join(folder, name), WRITERS[name.endsWith("raw") ? "raw" : "pnm"][1]({ depth, width, height }));
    return join(folder, name);
}

/** Types into a field. */
export async function type(page, field, text) {
    await page.locator(field).fill(text);
    await page.locator(field).press("Enter");
}
