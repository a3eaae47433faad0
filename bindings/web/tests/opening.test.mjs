// Files that are opened one after the other, and what is no file.

import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";
import { until } from "../../../tests/browser/support.mjs";
import { banner, drawn, open, withPage, writeMap } from "./page.mjs";
import { withFolder } from "./support.mjs";

const MAP = "boxes:sensor=clean_mm,size=160x120";
const shown = page => page.locator("#frame-name").textContent();
const isQuiet = page => page.evaluate(() => !window.depthplanes.isBusy);

/** Makes files whose names begin with `slow` wait; returns what releases them, and waits for what comes of it. */
async function slowFiles(page) {
    await page.evaluate(() => {
        const read = File.prototype.arrayBuffer;
        const released = new Promise(release => window.release = release);
        File.prototype.arrayBuffer = async function() {
            if (this.name.startsWith("slow")) await released;
            return read.call(this);
        };
    });
    return async () => {
        await page.evaluate(() => window.release());
        await page.waitForTimeout(300);
        await until(async () => assert.ok(await isQuiet(page)));
    };
}

test("of two files the one that was opened last is shown, however long the first takes", () => withFolder(folder => withPage(async page => {
    const [slow, fast] = await Promise.all(["slow.pgm", "fast.pgm"].map(name => writeMap(folder, name, MAP)));
    const release = await slowFiles(page);
    await page.setInputFiles("#file", slow);
    await until(async () => assert.equal(await page.locator("#reading").textContent(), "reading slow.pgm"));
    await open(page, fast);
    await until(async () => assert.ok(await page.locator("#reading").isHidden()));
    await release();
    assert.match(await shown(page), /^fast\.pgm/);
    assert.equal(await page.locator("#banner").isHidden(), true);
})));

test("a sample that is chosen while a file is read stays", () => withFolder(folder => withPage(async page => {
    const release = await slowFiles(page);
    await page.setInputFiles("#file", await writeMap(folder, "slow.pgm", MAP));
    await drawn(page, () => page.selectOption("#sample", "stairs:sensor=kinect"));
    await release();
    assert.match(await shown(page), /^scene:stairs/);
})));

test("an older file neither brings its error nor takes that of a newer one away", () => withFolder(folder => withPage(async page => {
    const [slow, fast, other] = await Promise.all(["slow.pgm", "fast.pgm", "other.pgm"].map(name => writeMap(folder, name, MAP)));
    await page.evaluate(() => {
        const read = File.prototype.arrayBuffer;
        const failed = new Promise((_, fail) => window.failSlow = fail);
        failed.catch(() => {});
        File.prototype.arrayBuffer = function() {
            return this.name.startsWith("slow") ? failed : read.call(this);
        };
    });
    await page.setInputFiles("#file", slow);
    await open(page, fast);
    await page.evaluate(() => window.failSlow(new Error("late")));
    await page.waitForTimeout(300);
    assert.equal(await page.locator("#banner").isHidden(), true);
    // A map that planes are looked for in, and meanwhile files that are refused at once.
    const wasBusy = await page.evaluate(() => {
        const [sample, input, transfer] = [document.getElementById("sample"), document.getElementById("file"), new DataTransfer()];
        sample.value = "room:sensor=kinect";
        sample.dispatchEvent(new Event("change"));
        for (const name of ["a.png", "b.png", "c.png"]) transfer.items.add(new File(["x"], name));
        input.files = transfer.files;
        input.dispatchEvent(new Event("change"));
        return window.depthplanes.isBusy;
    });
    assert.ok(wasBusy);
    await until(async () => assert.ok(await isQuiet(page)));
    assert.match(await banner(page), /3 files were dropped/);
    assert.match(await shown(page), /^scene:room/);
    await open(page, other);
    assert.equal(await page.locator("#banner").isHidden(), true);
})));

test("a map that is refused after another one was opened says nothing", () => withFolder(folder => withPage(async page => {
    const fast = await writeMap(folder, "fast.pgm", MAP);
    await page.evaluate(() => {
        const { client } = window.depthplanes;
        const ask = client.ask.bind(client);
        const late = new Promise(release => window.release = release);
        client.ask = async (request, bytes) => {
            if (request.map?.file === "cut.pgm") await late;
            return ask(request, bytes);
        };
    });
    await page.setInputFiles("#file", { name: "cut.pgm", mimeType: "", buffer: Buffer.from("P5\n64 48\n65535\n") });
    await until(async () => assert.equal(await page.locator("#reading").textContent(), "reading cut.pgm"));
    await page.setInputFiles("#file", fast);
    await page.waitForTimeout(100);
    await page.evaluate(() => {
        window.said = [];
        new MutationObserver(() => window.said.push(document.getElementById("banner-text").textContent))
            .observe(document.getElementById("banner"), { subtree: true, childList: true, characterData: true });
        window.release();
    });
    await until(async () => assert.match(await shown(page), /^fast\.pgm/));
    assert.deepEqual((await page.evaluate(() => window.said)).filter(Boolean), []);
    assert.equal(await page.locator("#refused").isHidden(), true);
})));

test("a folder is refused with words", () => withFolder(folder => withPage(async page => {
    const client = await page.context().newCDPSession(page);
    for (const name of ["frames", "camera.json"]) {
        await mkdir(join(folder, name));
        const data = { items: [], files: [join(folder, name)], dragOperationsMask: 1 };
        for (const type of ["dragEnter", "dragOver", "drop"]) await client.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
        await until(async () => assert.match(await banner(page), new RegExp(`^${name}: this cannot be read; accepted: .*no folders`)));
    }
    assert.match(await shown(page), /^scene:room/);
})));
