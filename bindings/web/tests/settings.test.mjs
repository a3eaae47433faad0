// What is stated of maps on the page: for a map that is refused, one of a stereo rig, and with files of cameras.

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";
import { until } from "../../../tests/browser/support.mjs";
import { WRITERS } from "./formats.mjs";
import { banner, drawn, hasLabels, open, type, withPage, writeMap } from "./page.mjs";
import { dp, labelsOf, program, withFolder } from "./support.mjs";

test("a map that is refused waits until what is stated of it is mended", () => withFolder(folder => withPage(async page => {
    const large = await writeMap(folder, "large.pgm", "boxes:sensor=clean_mm,size=320x240");
    const small = await writeMap(folder, "small.pgm", "boxes:sensor=clean_mm,size=160x120");
    await open(page, large);
    await drawn(page, () => type(page, "#camera", "290, 290, 199.5, 149.5"));
    assert.equal(await page.locator("#carried").isHidden(), true);
    await page.setInputFiles("#file", small);
    await until(async () => assert.match(await banner(page), /^small\.pgm: .*principal point/));
    assert.match(await page.locator("#refused").textContent(), /^small\.pgm was not read/);
    assert.match(await page.locator("#carried").textContent(), /^Stated for the map before: Camera\./);
    assert.match(await page.locator("#frame-name").textContent(), /^large\.pgm/);
    // How planes are looked for still acts on what is shown, and the other one still waits.
    await drawn(page, () => page.selectOption("#method", "ngaf"));
    assert.match(await page.locator("#frame-name").textContent(), /^large\.pgm/);
    assert.match(await banner(page), /^small\.pgm: /);
    await drawn(page, () => page.click("#clear-carried"));
    assert.match(await page.locator("#frame-name").textContent(), /^small\.pgm/);
    for (const id of ["#banner", "#refused", "#carried"]) assert.equal(await page.locator(id).isHidden(), true, id);
    assert.equal(await page.locator("#camera").inputValue(), "");
    assert.equal(await page.locator("#method").inputValue(), "ngaf");
    // What waits can be given up.
    await type(page, "#camera", "290, 290, 199.5, 149.5");
    await until(async () => assert.equal(await page.locator("#refused").isHidden(), false));
    await page.click("#give-up");
    assert.equal(await page.locator("#camera").inputValue(), "");
    assert.equal(await page.locator("#banner").isHidden(), true);
})));

test("a size of files without a header can be cleared, and stated again", () => withFolder(folder => withPage(async page => {
    const raw = await writeMap(folder, "boxes.raw", "boxes:sensor=clean_mm,size=160x120");
    await page.setInputFiles("#file", raw);
    await until(async () => assert.match(await banner(page), /“Raw size”/));
    await drawn(page, () => type(page, "#raw-size", "160 x 120"));
    assert.match(await page.locator("#frame-name").textContent(), /^boxes\.raw · 160 × 120/);
    await type(page, "#raw-size", "");
    await until(async () => assert.match(await banner(page), /“Raw size”/));
    assert.equal(await page.locator("#raw-size").inputValue(), "");
    await drawn(page, () => type(page, "#raw-size", "120 x 160"));
    assert.match(await page.locator("#frame-name").textContent(), /^boxes\.raw · 120 × 160/);
})));

test("disparity of a rig has metres by its fields", () => withFolder(folder => withPage(async page => {
    const { depth } = dp.scene("boxes:sensor=clean_mm,size=160x120");
    const disparity = Uint16Array.from(depth, mm => mm && Math.round(16 * 145 * 100 / mm));
    const file = join(folder, "disparity.pgm");
    await writeFile(file, WRITERS.pnm[1]({ depth: disparity, width: 160, height: 120 }));
    await open(page, file);
    await page.locator("#more").evaluate(element => element.parentElement.open = true);
    await drawn(page, () => page.selectOption("#unit", "disparity"));
    await drawn(page, () => type(page, "#scale", "16"));
    await drawn(page, () => type(page, "#camera", "145, 145, 79.5, 59.5"));
    await drawn(page, () => type(page, "#baseline", "0.1"));
    await drawn(page, () => type(page, "#valid-range", "1, 2000"));
    assert.equal(await page.locator("#view3d .hint").isHidden(), true);
    assert.match(await page.locator("#planes tbody tr").first().textContent(), /\d m.*m²/);
    const words = ["--encoding=disparity", "--scale=16", "--intrinsics=145,145,79.5,59.5", "--baseline=0.1", "--valid-range=1,2000"];
    program(["detect", "disparity.pgm", "--labels", "labels.png", ...words], folder);
    assert.ok(await hasLabels(page, labelsOf(await readFile(join(folder, "labels.png")))));
    await type(page, "#missing", "none");
    await until(async () => assert.match(await banner(page), /missing is "none"; accepted: a number/));
})));

test("a camera file is dropped beside a map, or after it", () => withFolder(folder => withPage(async page => {
    const map = await writeMap(folder, "boxes.pgm", "boxes:sensor=clean_mm,size=160x120");
    const [matrix, other] = ["K.txt", "camera.json"].map(name => join(folder, name));
    await writeFile(matrix, "145 0 79.5\n0 145 59.5\n0 0 1\n");
    await writeFile(other, JSON.stringify({ fx: 150, fy: 150, cx: 79.5, cy: 59.5, width: 160, height: 120 }));
    await open(page, [matrix, map]);
    assert.equal(await page.locator("#camera").inputValue(), "K.txt");
    assert.equal(await page.locator("#carried").isHidden(), true);
    assert.match(await page.locator("#in-use").textContent(), /145, 145, 79\.5, 59\.5 of K\.txt/);
    await open(page, other);
    assert.match(await page.locator("#frame-name").textContent(), /^boxes\.pgm/);
    assert.match(await page.locator("#in-use").textContent(), /150, 150, 79\.5, 59\.5 of camera\.json/);
    await page.setInputFiles("#file", [map, await writeMap(folder, "again.pgm", "boxes:sensor=clean_mm,size=160x120")]);
    await until(async () => assert.match(await banner(page), /boxes\.pgm, again\.pgm: one map at a time/));
})));
