// What the tests of the package and of the page share: the package as it was built, the program, recorded maps.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdtemp, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { WRITERS } from "./formats.mjs";

/** The folder that scripts/npm built into. */
export const BUILT = process.env.DEPTHPLANES_WEB ?? join(import.meta.dirname, "../../../target/web");
export const DATA = process.env.DEPTHPLANES_DATA ?? join(import.meta.dirname, "../../../../shared/data");
/** On CI nothing may be missing. */
export const skip = process.env.CI !== "true" && !existsSync(DATA) && "there is no data, set DEPTHPLANES_DATA";

/** Of every kind of camera there is, in millimetres. */
const RECORDED = [
    "cape_tunnel", "felix_0", "k2stairs_0", "k7_000", "lpvo_hall_125", "mosd_learn17", "rspl_1", "tsdf_150", "pcl", "stereo_002249",
];
export const RAW = { width: 640, height: 480 };

const { load } = await import(join(BUILT, "package/index.js"));
export const dp = await load();

/** Runs the program, which is built with the feature `exr`; what it prints. */
export function program(words, cwd) {
    return execFileSync(process.env.DEPTHPLANES ?? "depthplanes", words, { cwd, encoding: "utf8", maxBuffer: 2 ** 28, stdio: ["ignore", "pipe", "pipe"] });
}

/** A folder that goes when `use` ends. */
export async function withFolder(use) {
    const folder = await mkdtemp(join(tmpdir(), "depthplanes-web-"));
    try {
        return await use(folder);
    } finally {
        await rm(folder, { recursive: true, force: true });
    }
}

/** Ten recorded maps: name, bytes of the PNG, and the map. */
export async function recorded() {
    return Promise.all(RECORDED.map(async name => {
        const png = await readFile(join(DATA, "gt_real", `${name}.depth.png`));
        return { name, png, map: dp.read(png, name) };
    }));
}

/** Names of all recorded maps of 640 x 480. */
export async function vga() {
    const names = (await readdir(join(DATA, "gt_real"))).filter(name => name.endsWith(".depth.png")).sort();
    const files = await Promise.all(names.map(name => readFile(join(DATA, "gt_real", name))));
    return files.map(bytes => dp.read(bytes)).filter(({ width, height }) => width === 640 && height === 480);
}

/** Writes the recorded maps into a folder, in a format; their files, with the words of the program and of the package that they
 * need. */
export async function written(folder, format, maps) {
    const [ending, write] = WRITERS[format];
    const suited = format === "raw" ? maps.filter(({ map }) => map.width === RAW.width) : maps;
    const words = format === "raw" ? ["--raw-size", `${RAW.width}x${RAW.height}`] : [];
    const reading = format === "raw" ? { raw_size: [RAW.width, RAW.height] } : {};
    const files = await Promise.all(suited.map(async ({ name, png, map }) => {
        const bytes = write(map, png);
        await writeFile(join(folder, `${name}.${ending}`), bytes);
        return { name: `${name}.${ending}`, stem: name, bytes };
    }));
    return { files, words, reading };
}

/** The label images that the program writes of files in a folder, by the files' stems. */
export async function native(folder, files, words = []) {
    program(["detect", ...files.map(({ name }) => name), "--out-dir", "native", "--only", "labels", ...words], folder);
    const image = async ({ stem }) => [stem, await readFile(join(folder, "native", `${stem}.labels.png`))];
    return Object.fromEntries(await Promise.all(files.map(image)));
}

/** That two documents of JSON are one to twelve digits: C libraries and WebAssembly do not agree on the last bit of `exp` and `ln`. */
export function assertDocument(made, expected) {
    const digits = (_, value) => typeof value === "number" ? Number(value.toPrecision(12)) : value;
    const [a, b] = [made, expected].map(text => JSON.stringify(JSON.parse(Buffer.from(text)), digits, 1));
    assert.equal(a, b);
    assert.equal(Buffer.from(made).toString().split("\n").length, Buffer.from(expected).toString().split("\n").length);
}

/** The numbers of a label image. */
export const labelsOf = png => Uint16Array.from(dp.read(png, "labels.png", { unit: "grey" }).depth);
