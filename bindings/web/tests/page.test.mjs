// The page as people use it: opened from a file in Chromium, which has no network.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { createServer } from "node:http";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, colours, serialAbove, until } from "../../../tests/browser/support.mjs";
import { WRITERS } from "./formats.mjs";
import { BUILT, DATA, assertDocument, dp, labelsOf, native, program, recorded, skip, withFolder, written } from "./support.mjs";

const PAGE = pathToFileURL(join(BUILT, "depthplanes.html")).href;

let chrome;
before(async () => chrome = await browser());
after(() => chrome?.close());

/** Opens the page without a network; it has asked nobody for anything and complained of nothing in the end. */
async function withPage(use, { context = chrome.context, allowed = /^$/ } = {}) {
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
async function drawn(page, act) {
    const before = await page.evaluate(() => Number(document.body.dataset.serial));
    await act();
    await serialAbove(page, before);
}

const open = (page, file) => drawn(page, () => page.setInputFiles("#file", file));
const planes = page => page.locator("#planes tbody tr").count();
const banner = page => page.locator("#banner").textContent();
/** Whether the map of the page has these labels. */
async function hasLabels(page, labels) {
    const shown = await page.evaluate(async () => {
        const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", window.depthplanes.frame.labels));
        return [...digest].map(byte => byte.toString(16).padStart(2, "0")).join("");
    });
    return shown === createHash("sha256").update(labels).digest("hex");
}

/** The largest patch of a plane, or of none, as a point of the drawing. */
function pixelWhere(page, hasPlane) {
    return page.evaluate(hasPlane => {
        const { frame, view2d } = window.depthplanes;
        const { left, top, zoom } = view2d.place();
        const is = label => hasPlane ? label === frame.planes[1].label : label === 0;
        for (let v = 2; v < frame.height - 2; v++) {
            for (let u = 2; u < frame.width - 2; u++) {
                const around = [-2, -1, 0, 1, 2].flatMap(dv => [-2, -1, 0, 1, 2].map(du => frame.labels[(v + dv) * frame.width + u + du]));
                if (!around.every(is)) continue;
                // Mice are at whole pixels of the screen, which may be larger than those of the map.
                const [x, y] = [Math.ceil(left + u * zoom), Math.ceil(top + v * zoom)];
                return { x, y, u: Math.floor((x - left) / zoom), v: Math.floor((y - top) / zoom), id: frame.planes[1].id };
            }
        }
    }, hasPlane);
}

test("it opens from a file without a network, and shows a sample in both views", () => withPage(async page => {
    assert.match(await page.title(), /scene:room/);
    assert.ok(await planes(page) > 10);
    const flat = await colours(page, "#view2d .picture");
    assert.ok(flat.different > 100 && flat.share > 0.5, JSON.stringify(flat));
    const shot = await page.locator("#view3d .stage").screenshot();
    assert.ok(shot.length > 20_000, `the view in space is empty: ${shot.length} bytes`);
    assert.match(await page.locator("#speed").textContent(), /^\d+ planes in \d+\.\d ms$/);
    assert.match(await page.locator("#stages").textContent(), /read.*tiles.*grow.*ground.*outlines/);
    await page.click("#licences");
    assert.match(await page.locator("#licence-text").textContent(), /three\.js[^]*Permission is hereby granted/);
}));

test("labels of recorded maps in every format are the program's", { skip }, () => withFolder(async folder => {
    // Without the view in space, which these processors would draw by software.
    const plain = await browser("--disable-3d-apis");
    const maps = await recorded();
    let compared = 0;
    await withPage(async page => {
        for (const format of Object.keys(WRITERS)) {
            const { files, words } = await written(folder, format, maps);
            const expected = await native(folder, files, words);
            if (format === "raw") await drawn(page, () => page.locator("#raw-size").fill("640 x 480").then(() => page.keyboard.press("Enter")));
            for (const { name, stem } of files) {
                await open(page, join(folder, name));
                assert.match(await page.locator("#frame-name").textContent(), new RegExp(`^${name.replaceAll(".", "\\.")} · `));
                assert.ok(await hasLabels(page, labelsOf(expected[stem])), name);
                compared++;
            }
        }
    }, { context: plain.context, allowed: /WebGL/ });
    assert.ok(compared >= 10 * (Object.keys(WRITERS).length - 1) + 8, `${compared}`); // raw files are all of one size
    await plain.close();
}));

test("wishes that come while a map is read are all kept", { skip }, () => withPage(async page => {
    // In one turn of the browser, so that nothing is shown in between.
    const bytes = await readFile(join(DATA, "gt_real/felix_0.depth.png"));
    await page.evaluate(async bytes => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([new Uint8Array(bytes)], "felix.png"));
        const set = (id, to) => {
            const at = document.getElementById(id);
            if (to instanceof FileList) at.files = to; else at.value = to;
            at.dispatchEvent(new Event("change"));
        };
        set("file", transfer.files);
        while (!window.depthplanes.isBusy) await new Promise(next => setTimeout(next, 0));
        set("sensor", "kinect1");
        set("unit", "millimetre");
        set("method", "ngaf");
    }, [...bytes]);
    await until(async () => assert.ok(await page.evaluate(() => !window.depthplanes.isBusy)));
    const { map, reading, method } = await page.evaluate(() => window.depthplanes.state);
    assert.deepEqual([map.file, reading.sensor, reading.unit, method], ["felix.png", "kinect1", "millimetre", "ngaf"]);
    assert.match(await page.locator("#frame-name").textContent(), /^felix\.png/);
}));

test("a frame of 640 x 480 takes less than 25 ms in the page", { skip }, t => withPage(async page => {
    await open(page, join(DATA, "gt_real/lpvo_hall_125.depth.png"));
    const times = await page.evaluate(async () => {
        const { client, state } = window.depthplanes;
        const times = [];
        for (let round = 0; round < 30; round++) {
            // Another parameter each time, so that nothing is remembered; it changes no plane of this map.
            const words = { "min-pixels": 100 + round % 2 };
            const { stages } = await client.ask({ ask: "detect", map: state.map, words }, state.bytes);
            times.push(stages.filter(([name]) => name !== "read").reduce((sum, [, ms]) => sum + ms, 0));
        }
        return times.sort((a, b) => a - b);
    });
    t.diagnostic(`${times[15].toFixed(2)} ms, median of ${times.length}`);
    assert.ok(times[15] < 75, `${times[15]} ms`); // machines of tests are busy
}));

test("a slider changes the planes, and what is not accepted is said", () => withPage(async page => {
    const before = await planes(page);
    await drawn(page, () => page.locator("[data-name=min-pixels] input[type=range]").fill("900"));
    await until(async () => assert.ok(await planes(page) < before));
    const field = page.locator("[data-name=min-pixels] input[type=number]");
    const value = await field.inputValue();
    await field.fill("-5");
    await field.press("Enter");
    await until(async () => assert.match(await banner(page), /min-pixels.*whole number/));
    assert.equal(await field.inputValue(), value);
    await drawn(page, () => page.click("#reset-all"));
    await until(async () => assert.equal(await planes(page), before));
    assert.equal(await page.locator("#banner").isHidden(), true);
}));

test("another method has its own parameters", () => withPage(async page => {
    await drawn(page, () => page.selectOption("#method", "ngaf"));
    const names = await page.locator("#parameters .parameter").evaluateAll(rows => rows.map(row => row.dataset.name));
    assert.deepEqual(names, dp.methods().find(({ name }) => name === "ngaf").parameters.map(({ name }) => name));
    const { labels } = new dp.Detector({ method: "ngaf" }).detect(dp.scene("room:sensor=kinect"));
    assert.ok(await hasLabels(page, labels));
}));

test("a pick names the plane, and where there is none it says why, also by keys", () => withPage(async page => {
    const on = await pixelWhere(page, true);
    await page.locator("#view2d .drawing").click({ position: { x: on.x, y: on.y } });
    await until(async () => assert.match(await page.locator("#pixel").textContent(), new RegExp(`Column, row${on.u}, ${on.v}.*Plane${on.id}, `)));
    assert.equal(await page.locator("#planes tr.chosen").getAttribute("data-id"), String(on.id));
    const off = await pixelWhere(page, false);
    await page.locator("#view2d .drawing").click({ position: { x: off.x, y: off.y } });
    await until(async () => assert.match(await page.locator("#pixel .verdict").textContent(), /^No plane here: /));
    assert.equal(await page.locator("#planes tr.chosen").count(), 0);
    await page.locator("#view2d .drawing").focus();
    await page.keyboard.press("ArrowRight");
    await until(async () => assert.match(await page.locator("#pixel").textContent(), new RegExp(`Column, row${off.u + 1}, ${off.v}`)));
    await page.locator("#planes tbody tr").first().focus();
    await page.keyboard.press("Enter");
    assert.equal(await page.locator("#planes tr.chosen").getAttribute("data-id"), "1");
    await page.keyboard.press("2");
    assert.equal(await page.locator("#mode [data-mode=depth]").getAttribute("aria-checked"), "true");
}));

test("downloads are the program's files", { skip }, () => withFolder(async folder => withPage(async page => {
    await writeFile(join(folder, "hall.png"), await readFile(join(DATA, "gt_real/lpvo_hall_125.depth.png")));
    await open(page, join(folder, "hall.png"));
    await drawn(page, () => page.locator("#camera").fill("525, 525, 319.5, 239.5").then(() => page.keyboard.press("Enter")));
    assert.equal(await page.locator("#view3d .hint").isHidden(), true);
    const words = ["detect", "hall.png", "--intrinsics=525,525,319.5,239.5"];
    for (const output of ["labels.png", "planes.json", "planes.csv", "overlay.png", "cloud.ply", "mesh.ply"]) {
        const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-output="${output}"]`)]);
        assert.equal(download.suggestedFilename(), `hall.${output}`);
        await download.saveAs(join(folder, "got"));
        program([...words, `--${output.split(".")[0]}`, `made.${output}`], folder);
        const [got, made] = await Promise.all(["got", `made.${output}`].map(name => readFile(join(folder, name))));
        output === "planes.json" ? assertDocument(got, made) : assert.ok(got.equals(made), output);
    }
    program([...words, "--planes", "made.json"], folder);
    assert.equal(await readFile(join(folder, "made.json"), "utf8"), program([...words, "--json"], folder));
})));

test("files that are none, and cameras that are none, say what is wrong", () => withFolder(folder => withPage(async page => {
    const refused = async (name, bytes, words) => {
        await writeFile(join(folder, name), bytes);
        await page.setInputFiles("#file", join(folder, name));
        await until(async () => assert.match(await banner(page), words));
    };
    await refused("letter.txt", "Dear Sir", /letter\.txt: .*accepted/);
    await refused("empty.png", "", /empty\.png: /);
    const { depth, width, height } = dp.scene("boxes:sensor=clean_mm,size=160x120");
    const pgm = WRITERS.pnm[1]({ depth, width, height });
    await refused("cut.pgm", pgm.subarray(0, 1000), /cut\.pgm: /);
    assert.match(await page.locator("#frame-name").textContent(), /^scene:room/, "what was shown is still shown");
    await writeFile(join(folder, "boxes.pgm"), pgm);
    await open(page, join(folder, "boxes.pgm"));
    assert.equal(await page.locator("#banner").isHidden(), true);
    assert.match(await page.locator("#view3d .hint").textContent(), /camera/);
    await page.click("[data-output='cloud.ply']");
    await until(async () => assert.match(await banner(page), /intrinsics/));
    await page.locator("#camera").fill("580, 580, wide");
    await page.keyboard.press("Enter");
    await until(async () => assert.match(await banner(page), /camera is \[580,580,"wide"\]; accepted: \[fx, fy, cx, cy\]/));
    await writeFile(join(folder, "camera.json"), "{}");
    await page.setInputFiles("#camera-file", join(folder, "camera.json"));
    await until(async () => assert.doesNotMatch(await banner(page), /wide/));
    await writeFile(join(folder, "camera.yaml"), "camera_matrix: {rows: 3, cols: 3, data: [145, 0, 80, 0, 145, 60, 0, 0, 1]}\nimage_width: 160\nimage_height: 120\ndistortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n");
    await drawn(page, () => page.setInputFiles("#camera-file", join(folder, "camera.yaml")));
    assert.equal(await page.locator("#camera").inputValue(), "camera.yaml");
    assert.equal(await page.locator("#view3d .hint").isHidden(), true);
})));

test("a file that is dropped is shown", () => withPage(async page => {
    const { depth, width, height } = dp.scene("stairs:sensor=clean_mm,size=160x120");
    const bytes = [...WRITERS.pnm[1]({ depth, width, height })];
    await drawn(page, () => page.evaluate(bytes => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([new Uint8Array(bytes)], "stairs.pgm"));
        for (const type of ["dragover", "drop"]) document.body.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    }, bytes));
    assert.match(await page.locator("#frame-name").textContent(), /^stairs\.pgm · 160 × 120/);
}));

test("the page stays free while planes are found", () => withPage(async page => {
    const longest = await page.evaluate(async () => {
        const { client, state } = window.depthplanes;
        let [longest, before, goes] = [0, performance.now(), true];
        const beat = new MessageChannel();
        beat.port1.onmessage = () => {
            longest = Math.max(longest, performance.now() - before);
            before = performance.now();
            if (goes) beat.port2.postMessage(0);
        };
        beat.port2.postMessage(0);
        const start = performance.now();
        while (performance.now() - start < 1000) await client.ask({ ask: "detect", map: state.map, words: { method: "ransac" } });
        goes = false;
        return longest;
    });
    assert.ok(longest < 200, `it stood still for ${longest} ms`);
}));

test("it fits a small screen", () => withPage(async page => {
    await page.setViewportSize({ width: 390, height: 844 });
    await until(async () => {
        const [wide, seen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
        assert.ok(wide <= seen, `${wide} ${seen}`);
    });
    for (const id of ["#open", "#sample", "#view2d .picture", "#method"]) {
        const box = await page.locator(id).boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= 390, `${id} ${JSON.stringify(box)}`);
    }
}));

test("the snippet of HTML on the page of the docs runs in a browser", async () => {
    const text = await readFile(join(import.meta.dirname, "../../../docs/browser.md"), "utf8");
    const [, html] = /^```html\n([^]*?)^```/m.exec(text);
    const types = { js: "text/javascript", wasm: "application/wasm" };
    const server = createServer(async ({ url }, response) => {
        const [name] = url.split("/depthplanes/").slice(1);
        response.setHeader("Content-Type", types[name?.split(".").pop()] ?? "text/html");
        response.end(name ? await readFile(join(BUILT, "package", name)) : `<!doctype html>${html}`);
    });
    await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
    const own = await browser();
    const page = await own.context.newPage();
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await until(async () => assert.match(await page.locator("body").innerText(), /\d+ planes/));
    await own.close();
    server.close();
});
