// Runs the module of src/lib.rs on one map: node labels.mjs MODULE METHOD TYPE WIDTH HEIGHT PIXELS LABELS
//
// PIXELS is a file of numbers of TYPE (u16 millimetres or f32 metres), row by row, little-endian. Writes one u16 for
// each pixel to the file LABELS and prints the number of planes. But for the files the same works in a browser.

import { readFileSync, writeFileSync } from "node:fs";

const [file, method, type, width, height, source, target] = process.argv.slice(2);
const module = await WebAssembly.instantiate(readFileSync(file)); // it imports nothing
const { memory, allocate, free, detect_u16, detect_f32 } = module.instance.exports;
const detect = { u16: detect_u16, f32: detect_f32 }[type];

// Memory may grow, and then moves, with every call into the module: a view of it holds until the next one.
const view = (at, length) => new Uint8Array(memory.buffer, at, length);

const room = (length) => {
    const at = allocate(length) >>> 0; // addresses come as signed numbers
    if (at === 0) throw new Error(`no memory of ${length} bytes`);
    return at;
};

const copy = (bytes) => {
    const at = room(bytes.length);
    view(at, bytes.length).set(bytes);
    return at;
};

const name = new TextEncoder().encode(method);
const pixels = readFileSync(source);
const expected = width * height * { u16: 2, f32: 4 }[type];
if (pixels.length !== expected) throw new Error(`${source} has ${pixels.length} bytes, not ${expected}`);

const [nameAt, pixelsAt, labelsAt] = [copy(name), copy(pixels), room(width * height * 2)];
const planes = detect(nameAt, name.length, pixelsAt, Number(width), Number(height), labelsAt);
if (planes < 0) throw new Error(`${method} failed with ${planes}; the numbers are named in src/lib.rs`);
writeFileSync(target, view(labelsAt, width * height * 2));
console.log(planes);

free(nameAt, name.length);
free(pixelsAt, pixels.length);
free(labelsAt, width * height * 2);
