// The program and pages of it.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const LONG_MS = 60_000;
const program = process.env.DEPTHPLANES ?? "depthplanes";

/** A scene that shows floor, boxes and walls. */
export const SCENE = "scene:robot:sensor=kinect,size=320x240,frames=60";

const ARGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
    "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/** Starts `depthplanes serve`; its address and how to end it. */
export async function serve(...words) {
    const child = spawn(program, ["serve", ...words], { stdio: ["ignore", "pipe", "pipe"] });
    let said = "";
    child.stderr.on("data", bytes => said += bytes);
    const ended = new Promise(resolve => child.on("exit", resolve));
    const url = await new Promise((resolve, reject) => {
        child.stdout.on("data", bytes => resolve(String(bytes).trim()));
        ended.then(code => reject(new Error(`the program ended with ${code}: ${said}`)));
    });
    return {
        url,
        port: new URL(url).port,
        stop: signal => {
            child.kill(signal ?? "SIGINT");
            return ended;
        },
    };
}

/** A browser with a folder of its own. `extra` are further words for it. */
export async function browser(...extra) {
    const folder = await mkdtemp(join(tmpdir(), "depthplanes-browser-"));
    const context = await chromium.launchPersistentContext(folder, {
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: [...ARGS, ...extra],
        viewport: { width: 1400, height: 800 },
    });
    const close = async () => {
        await context.close();
        await rm(folder, { recursive: true, force: true });
    };
    return { context, close };
}

/** Opens the page and waits for a frame; whatever the browser complains of, or asks others for, fails. */
export async function open(context, url) {
    const page = await context.newPage();
    page.complaints = [];
    page.on("pageerror", error => page.complaints.push(error.stack));
    page.on("console", message => message.type() === "error" && page.complaints.push(message.text()));
    page.on("request", request => request.url().startsWith(url) || page.complaints.push(`asks ${request.url()}`));
    await page.goto(url);
    await serialAbove(page, 0);
    return page;
}

/** Waits until a frame of a higher number is drawn; its number. */
export async function serialAbove(page, serial) {
    await page.waitForFunction(least => Number(document.body.dataset.serial) > least, serial, { timeout: LONG_MS, polling: 100 });
    return page.evaluate(() => Number(document.body.dataset.serial));
}

/** Pauses at a frame. */
export async function pausedAt(page, index) {
    if (await page.locator("#play.playing").count()) await page.click("#play");
    await page.waitForSelector("#play:not(.playing)");
    await page.locator("#seek").fill(String(index));
    await until(async () => assert.match(await page.locator("#position").textContent(), new RegExp(`^${index} /`)));
    await until(async () => assert.match(await page.locator("#frame-name").textContent(), new RegExp(`0${index}[ .]`)));
}

/** Repeats until nothing is thrown. */
export async function until(check) {
    const start = Date.now();
    for (;;) {
        try {
            return await check();
        } catch (error) {
            if (Date.now() - start > LONG_MS) throw error;
            await new Promise(resolve => setTimeout(resolve, 50));
        }
    }
}

/** How many different colours a canvas has, and its share of pixels that are not of the most frequent one. */
export function colours(page, selector) {
    return page.locator(selector).evaluate(canvas => {
        const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
        const context = copy.getContext("2d");
        context.drawImage(canvas, 0, 0);
        const counts = new Map();
        for (const pixel of new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)) {
            counts.set(pixel, (counts.get(pixel) ?? 0) + 1);
        }
        const all = copy.width * copy.height;
        return { different: counts.size, share: 1 - Math.max(...counts.values()) / all };
    });
}
