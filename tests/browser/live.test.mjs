// The live page as people use it, in Chromium.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { SCENE, browser, colours, open, pausedAt, serialAbove, serve, until } from "./support.mjs";

let chrome;
let server;
before(async () => {
    chrome = await browser();
    server = await serve(SCENE, "--port", "0");
});
after(async () => {
    await chrome?.close();
    assert.equal(await server?.stop(), 0, "Ctrl-C ends it cleanly");
});

/** A page of the shared server, which is closed in the end and has complained of nothing. */
async function withPage(use, url = server.url) {
    const page = await open(chrome.context, url);
    await use(page);
    assert.deepEqual(page.complaints, []);
    await page.close();
}

const planes = page => page.locator("#planes tbody tr").count();

/** A pixel of the picture as a point of the drawing, by what its label has to be. */
function pixelWhere(page, hasPlane) {
    return page.evaluate(hasPlane => {
        const { frame, view2d } = window.depthplanes;
        const { left, top, zoom } = view2d.place();
        const largest = frame.planes[1].label;
        const is = label => hasPlane ? label === largest : label === 0;
        // The middle of a patch of 5 x 5 pixels that are all so.
        for (let v = 2; v < frame.height - 2; v++) {
            for (let u = 2; u < frame.width - 2; u++) {
                const around = [-2, -1, 0, 1, 2].flatMap(dv => [-2, -1, 0, 1, 2].map(du => frame.labels[(v + dv) * frame.width + u + du]));
                if (around.every(is)) return { x: left + (u + 0.5) * zoom, y: top + (v + 0.5) * zoom, u, v, id: frame.planes[1].id };
            }
        }
    }, hasPlane);
}

test("it opens and shows frame after frame, in both views", () => withPage(async page => {
    assert.match(await page.title(), /scene:robot/);
    await serialAbove(page, await serialAbove(page, 0));
    assert.equal(await page.locator("#link").textContent(), "live");
    assert.ok(await planes(page) >= 3);
    const flat = await colours(page, "#view2d .picture");
    assert.ok(flat.different > 100 && flat.share > 0.5, JSON.stringify(flat));
    const shot = await page.locator("#view3d .stage").screenshot();
    assert.ok(shot.length > 20_000, `the view in space is empty: ${shot.length} bytes`);
    assert.match(await page.locator("#ground").textContent(), /Camera height0\.\d+ ± /);
    assert.match(await page.locator("#stages").textContent(), /tiles.*grow.*ground.*track/);
}));

test("a slider changes the planes, and another page sees it move", () => withPage(async page => {
    const other = await open(chrome.context, server.url);
    await pausedAt(page, 12);
    const before = await planes(page);
    await page.locator("[data-name=min-pixels] input[type=range]").fill("900");
    await until(async () => assert.ok(await planes(page) < before, `${before}`));
    const value = await page.locator("[data-name=min-pixels] input[type=number]").inputValue();
    assert.ok(Number(value) > 1000, value);
    await until(async () => assert.equal(await other.locator("[data-name=min-pixels] input[type=number]").inputValue(), value));
    await page.locator("[data-name=min-pixels] input[type=number]").fill("-5");
    await page.locator("[data-name=min-pixels] input[type=number]").press("Enter");
    await until(async () => assert.match(await page.locator("#banner").textContent(), /min-pixels.*whole number/));
    await page.click("#reset-all");
    await until(async () => assert.equal(await planes(page), before));
    await until(async () => assert.equal(await page.locator("#banner").isHidden(), true));
    await other.close();
}));

test("a pick names the plane, and where there is none it says why", () => withPage(async page => {
    await pausedAt(page, 12);
    const on = await pixelWhere(page, true);
    await page.locator("#view2d .drawing").click({ position: { x: on.x, y: on.y } });
    await until(async () => assert.match(await page.locator("#pixel").textContent(), new RegExp(`Column, row${on.u}, ${on.v}.*Plane${on.id}, `)));
    assert.equal(await page.locator("#planes tr.chosen").getAttribute("data-id"), String(on.id));
    const off = await pixelWhere(page, false);
    await page.locator("#view2d .drawing").click({ position: { x: off.x, y: off.y } });
    await until(async () => assert.match(await page.locator("#pixel .verdict").textContent(), /^No plane here: /));
    assert.equal(await page.locator("#planes tr.chosen").count(), 0);
}));

test("play, pause, step and seek", () => withPage(async page => {
    const position = () => page.locator("#position").textContent();
    await pausedAt(page, 40);
    const still = await page.evaluate(() => document.body.dataset.serial);
    await page.waitForTimeout(300);
    assert.equal(await page.evaluate(() => document.body.dataset.serial), still);
    await page.click("#on");
    await until(async () => assert.match(await position(), /^41 /));
    await page.click("#back");
    await until(async () => assert.match(await position(), /^40 /));
    await page.locator("body").press("ArrowRight");
    await until(async () => assert.match(await position(), /^41 /));
    await page.click("#play");
    await until(async () => assert.match(await position(), /^[0-9] /)); // it begins anew after the last frame
}));

test("a file that is dragged in is shown, and one that is no map is refused in words", () => withPage(async page => {
    const drop = (name, bytes) => page.evaluate(([name, bytes]) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([new Uint8Array(bytes)], name));
        for (const type of ["dragover", "drop"]) document.body.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    }, [name, [...bytes]]);
    const pgm = Buffer.concat([Buffer.from("P5\n64 48\n65535\n"), Buffer.alloc(64 * 48 * 2)]);
    for (let at = 0; at < 64 * 48; at++) pgm.writeUInt16BE([1500, 2500, 65535][Math.floor(at % 64 / 25)], pgm.length - 64 * 48 * 2 + 2 * at);
    await drop("two walls.pgm", pgm);
    await until(async () => assert.match(await page.locator("#frame-name").textContent(), /^two walls\.pgm/));
    await until(async () => assert.ok(await planes(page) >= 2));
    assert.match(await page.locator("#notes").textContent(), /--missing 65535/);
    assert.match(await page.locator("#view3d .hint").textContent(), /--intrinsics/);
    await drop("letter.txt", Buffer.from("Dear Sir"));
    await until(async () => assert.match(await page.locator("#banner").textContent(), /letter\.txt: /));
    page.complaints = page.complaints.filter(text => !text.includes("422")); // the browser notes that the server refused it
    await page.click("#leave-file");
    await until(async () => assert.match(await page.locator("#frame-name").textContent(), /^frame-/));
}));

test("pages of other sites get nothing", async () => {
    const page = await chrome.context.newPage();
    await page.goto(server.url.replace("127.0.0.1", "localhost")); // another origin in the same browser
    const outcome = await page.evaluate(url => Promise.all([
        new Promise(resolve => {
            const socket = new WebSocket(`${url.replace("http", "ws")}live`);
            socket.onopen = () => resolve("open");
            socket.onerror = () => resolve("refused");
        }),
        fetch(`${url}file/map.pgm`, { method: "POST", body: "P5", mode: "no-cors" }).then(() => "sent", () => "refused"),
    ]), server.url);
    assert.equal(outcome[0], "refused");
    const [socket, post] = [await fetch(`${server.url}live`, { headers: { Origin: "http://evil.example" } }),
        await fetch(`${server.url}file/map.pgm`, { method: "POST", body: "P5", headers: { Origin: "http://evil.example" } })];
    assert.deepEqual([socket.status, post.status], [403, 403]);
    await page.close();
});

test("it connects again after the program was started anew", async () => {
    const first = await serve(SCENE, "--port", "0");
    const page = await open(chrome.context, first.url);
    const before = await serialAbove(page, 0);
    await first.stop("SIGKILL");
    await until(async () => assert.match(await page.locator("#link").textContent(), /no connection/));
    assert.match(await page.locator("#banner").textContent(), /connects again/);
    const second = await serve("scene:robot:sensor=kinect,size=320x240,frames=61", "--port", first.port);
    await until(async () => assert.equal(await page.locator("#link").textContent(), "live"));
    await until(async () => assert.match(await page.locator("#source").textContent(), /frames=61/));
    await until(async () => assert.equal(await page.locator("#banner").isHidden(), true));
    await until(async () => assert.match(await page.locator("#position").textContent(), /\/ 60/));
    assert.ok(before > 0);
    await page.close();
    assert.equal(await second.stop(), 0);
});

test("twenty pages at once, one of them frozen, and none without frames", async () => {
    // Without the view in space, which these processors would draw by software for all of them.
    const many = await browser("--disable-3d-apis", "--window-size=480,360");
    const shared = await serve("scene:robot:sensor=kinect,size=160x120,frames=60", "--port", "0");
    const pages = [];
    while (pages.length < 20) {
        const page = await open(many.context, shared.url);
        await page.setViewportSize({ width: 480, height: 360 });
        // What plays while they open would only slow that.
        if (pages.length === 0) await pausedAt(page, 10);
        pages.push(page);
    }
    const [frozen, ...others] = pages;
    await others[0].click("#play");
    assert.match(await frozen.locator("#view3d .hint").textContent(), /no WebGL/);
    const held = frozen.evaluate(() => {
        const end = performance.now() + 5000;
        while (performance.now() < end);
        return Number(document.body.dataset.serial);
    });
    const before = await Promise.all(others.map(page => serialAbove(page, 0)));
    await Promise.all(others.map((page, at) => serialAbove(page, before[at] + 3)));
    const newest = await others[0].evaluate(() => Number(document.body.dataset.serial));
    const at = await held;
    assert.ok(newest > at + 3, `${newest} ${at}`);
    const later = await serialAbove(frozen, newest);
    assert.ok(later >= newest);
    for (const page of others) assert.deepEqual(page.complaints.filter(text => !text.includes("WebGL")), []);
    await many.close();
    assert.equal(await shared.stop(), 0);
});

const DATA = process.env.DEPTHPLANES_DATA ?? join(import.meta.dirname, "../../../shared/data");
const isMissing = process.env.CI !== "true" && !existsSync(DATA);
test("a recorded video", { skip: isMissing && "there is no data, set DEPTHPLANES_DATA" }, async () => {
    const recorded = await serve(join(DATA, "video_7scenes"), "--port", "0");
    await withPage(async page => {
        await pausedAt(page, 20);
        assert.ok(await planes(page) > 10);
        assert.match(await page.locator("#planes").textContent(), /table/);
    }, recorded.url);
    assert.equal(await recorded.stop(), 0);
});

test("a folder with a file that cannot be read says which", async () => {
    const folder = await mkdtemp(join(tmpdir(), "depthplanes-frames-"));
    const pgm = Buffer.concat([Buffer.from("P5\n32 32\n65535\n"), Buffer.alloc(32 * 32 * 2, 5)]);
    await writeFile(join(folder, "1.pgm"), pgm);
    await writeFile(join(folder, "2.pgm"), pgm.subarray(0, 100));
    const broken = await serve(folder, "--port", "0");
    await withPage(async page => {
        await until(async () => assert.match(await page.locator("#banner").textContent(), /2\.pgm: /));
    }, broken.url);
    assert.equal(await broken.stop(), 0);
    await rm(folder, { recursive: true });
});
