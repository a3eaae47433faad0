// The npm package under node: the labels, documents and words of the program.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cp, readFile, readdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import { WRITERS } from "./formats.mjs";
import { BUILT, assertDocument, dp, labelsOf, native, program, recorded, skip, vga, withFolder, written } from "./support.mjs";

const ROOT = join(import.meta.dirname, "../../..");
const CAMERA = [580, 580, 319.5, 239.5];
const STRICT = ["--noEmit", "--strict", "--target", "es2022", "--module", "es2022", "--moduleResolution", "bundler", "--lib", "es2022,dom", "--types", ""];
const { build } = createRequire(join(ROOT, "crates/depthplanes-serve/page/build.mjs"))("esbuild");

for (const method of ["planar", "ngaf", "ransac"]) {
    test(`${method}: labels of recorded maps are those of the program`, { skip }, () => withFolder(async folder => {
        const { files } = await written(folder, "png", await recorded());
        const expected = await native(folder, files, ["--method", method]);
        const detector = new dp.Detector({ method });
        for (const { name, stem, bytes } of files) {
            const { labels, planes } = detector.detect(dp.read(bytes, name));
            assert.deepEqual(labels, labelsOf(expected[stem]), name);
            assert.equal(planes.length, labels.reduce((most, label) => Math.max(most, label), 0), name);
        }
    }));
}

test("scenes of floats, with noise and without, have the program's labels", () => withFolder(async folder => {
    for (const scene of ["room:sensor=kinect", "boxes:sensor=clean,size=320x240", "stairs:sensor=tof_white"]) {
        program(["detect", `scene:${scene}`, "--labels", "labels.png"], folder);
        const { labels } = new dp.Detector().detect(dp.scene(scene));
        assert.deepEqual(labels, labelsOf(await readFile(join(folder, "labels.png"))), scene);
        assert.ok(labels.some(label => label > 1), scene);
    }
}));

test("files are those of the program, whatever the output", () => withFolder(async folder => {
    const { depth, width, height } = dp.scene("room:sensor=kinect");
    const [, write] = WRITERS.npy;
    const bytes = write({ depth, width, height });
    await writeFile(join(folder, "room.npy"), bytes);
    const found = new dp.Detector().detect(dp.read(bytes, "room.npy", { camera: CAMERA }));
    const words = ["detect", "room.npy", `--intrinsics=${CAMERA}`];
    assertDocument(found.encode("planes", "json"), program([...words, "--json"], folder));
    assert.deepEqual(found.record, JSON.parse(Buffer.from(found.encode("planes", "json"))));
    for (const { name, extensions } of dp.tables().outputs.filter(({ name }) => name !== "curved-labels")) {
        for (const extension of extensions) {
            program([...words, `--${name}`, `made.${extension}`], folder);
            const expected = await readFile(join(folder, `made.${extension}`));
            const made = found.encode(name, extension);
            extension === "json" ? assertDocument(made, expected) : assert.ok(expected.equals(made), `${name}.${extension}`);
        }
    }
    const explained = JSON.parse(program(["explain", "room.npy", "--at", "12,300", `--intrinsics=${CAMERA}`, "--json"], folder));
    assert.deepEqual(found.explain(12, 300), explained);
}));

test("an array of each type is read as the program reads such a file", () => {
    const scene = dp.scene("boxes:sensor=clean_mm,size=160x120");
    const labels = (Type, options, scale = 1) => {
        const array = Type.from(scene.depth, value => Type === BigInt64Array ? BigInt(value) : value * scale);
        return new dp.Detector(options).detect(array, 160, 120).labels;
    };
    const expected = labels(Uint16Array);
    assert.ok(expected.some(label => label > 1));
    for (const Type of [Int16Array, Uint32Array, Int32Array, BigInt64Array]) assert.deepEqual(labels(Type), expected, Type.name);
    for (const Type of [Float32Array, Float64Array]) assert.deepEqual(labels(Type, { unit: "mm" }), expected, Type.name);
    assert.ok(labels(Uint8Array, {}, 1 / 40).some(label => label > 0));
    // A part of a larger buffer, at an odd place.
    const wide = new Uint16Array(scene.depth.length + 3);
    wide.set(scene.depth, 3);
    assert.deepEqual(new dp.Detector().detect(wide.subarray(3), 160, 120).labels, expected);
});

test("no answer depends on the one before, nor on what is written to the array since", () => {
    const detector = new dp.Detector({ camera: CAMERA });
    const other = new dp.Detector({ method: "ngaf" });
    const { depth, width, height } = dp.scene("room:sensor=kinect");
    const first = detector.detect(depth, width, height);
    const document = first.encode("planes", "json");
    other.detect(depth, width, height);
    depth.fill(0);
    assert.equal(detector.detect(depth, width, height).planes.length, 0);
    assert.deepEqual(first.encode("planes", "json"), document);
    assert.equal(first.explain(320, 400).verdict.kind, "plane");
});

test("options and frames are copies: what is written to them later changes no result", () => {
    const options = { min_pixels: 100, camera: [...CAMERA] };
    const detector = new dp.Detector(options);
    const reading = { unit: "mm" };
    const scene = dp.scene("room:sensor=kinect");
    const frame = dp.read(WRITERS.pnm[1](scene), "room.pgm", reading);
    const [found, read] = [detector.detect(scene.depth, scene.width, scene.height), new dp.Detector({ min_pixels: 100 }).detect(frame)];
    const documents = [found, read].map(planes => planes.encode("planes", "json"));
    Object.assign(options, { min_pixels: 3000, method: "ngaf" });
    options.camera[0] = 1;
    reading.unit = "cm";
    frame.depth.fill(0);
    assert.deepEqual([found, read].map(planes => planes.encode("planes", "json")), documents);
    assert.deepEqual(detector.options, { min_pixels: 100, camera: CAMERA });
    assert.throws(() => detector.options.min_pixels = 3000, TypeError);
    assert.throws(() => detector.options.camera[0] = 1, TypeError);
    assert.deepEqual(detector.detect(scene.depth, scene.width, scene.height).labels, found.labels);
    assert.deepEqual(new dp.Detector({ min_pixels: 100 }).detect(frame).labels, read.labels);
    assert.equal(detector.detect(frame.depth, frame.width, frame.height).planes.length, 0);
});

test("what is wrong is said in the names of options", () => withFolder(async folder => {
    const flat = new Uint16Array(64 * 48).fill(1000);
    const detector = new dp.Detector();
    const refused = (act, words) => assert.throws(act, error => {
        assert.equal(error.name, "InputError");
        assert.match(error.message, words);
        assert.doesNotMatch(error.message, /--|cargo|`depthplanes /);
        return true;
    });
    refused(() => new dp.Detector({ method: "plane" }), /no method `plane`; there are: planar, ngaf/);
    refused(() => new dp.Detector({ sensor: "kinect9" }), /kinect9.*kinect1/);
    refused(() => new dp.Detector({ unit: "miles" }), /miles.*millimetre/);
    refused(() => new dp.Detector({ min_pixels: -5 }), /`min_pixels`.*-5.*a whole number from/);
    refused(() => new dp.Detector({ min_pixels: "many" }), /min_pixels is "many"; accepted: a number/);
    refused(() => new dp.Detector({ min_pixels: NaN }), /min_pixels is NaN; accepted: a finite number/);
    refused(() => new dp.Detector({ min_pixels: 900n }), /^min_pixels is the BigInt 900n; accepted: a number/);
    refused(() => new dp.Detector({ min_pixels: () => 900 }), /^min_pixels is of type function; accepted: a number/);
    const holdsItself = {};
    holdsItself.camera = holdsItself;
    refused(() => new dp.Detector(holdsItself), /^the options: an object that holds itself.*accepted: names with numbers/);
    for (const [given, words] of [[null, "null"], [[9], "an Array"], ["mm", 'the string "mm"'], [9, "9"]]) {
        refused(() => new dp.Detector(given), new RegExp(`^the options: ${words}; accepted: an object`));
    }
    refused(() => dp.read(new Uint8Array(10), "map.png", null), /^what is stated of the map: null; accepted: an object/);
    refused(() => dp.read(new Uint8Array(10), 5), /^the name is 5; accepted: a string/);
    refused(() => dp.scene(), /^the scene is undefined; accepted: a string/);
    const gone = new Uint16Array(64 * 48);
    structuredClone(gone.buffer, { transfer: [gone.buffer] });
    refused(() => detector.detect(gone, 64, 48), /^the array has no memory any more: it was transferred/);
    refused(() => dp.read(gone.buffer), /^the array has no memory any more: it was transferred/);
    refused(() => detector.detect(flat, "64", "48"), /^width is the string "64"; accepted: a whole number from 1 on/);
    refused(() => detector.detect(flat, 64, 48).explain(1n, 1), /^u is the BigInt 1n; accepted: a whole number/);
    refused(() => detector.detect(flat, 64, 48).encode("labels"), /^extension is undefined; accepted: a string/);
    refused(() => new dp.Detector({ theta: 1 }), /no option `theta`; the method `planar` has no such parameter, ngaf has; accepted: .*min_pixels/);
    refused(() => new dp.Detector({ camera: [580, 580] }), /camera is \[580,580\]; accepted: \[fx, fy, cx, cy\]/);
    refused(() => new dp.Detector({ camera: "no camera" }), /camera/);
    refused(() => new dp.Detector({ method: "ngaf", curved: true }), /curved.*planar/);
    refused(() => new dp.Detector({ camera_size: [640, 480] }), /camera_size needs the camera/);
    refused(() => detector.detect([1, 2], 2, 1), /the map is an Array; accepted: a typed array/);
    refused(() => detector.detect(flat, 64, 47), /the array has 3072 numbers; accepted: 64 x 47 = 3008/);
    refused(() => detector.detect(flat, 64), /height is undefined; accepted: a whole number/);
    refused(() => detector.detect(flat, 64, 48).explain(64, 0), /pixel 64,0 is outside of the map/);
    refused(() => new dp.Detector({ cam: [1, 2] }), /no option `cam`; did you mean `camera`\?; accepted: .*camera_size.*merge_coplanar.*min_pixels/);
    refused(() => new dp.Detector({ minPixels: 9 }), /did you mean `min_pixels`\?/);
    refused(() => new dp.Detector({ colour: "red" }), /no option `colour`; accepted/);
    refused(() => detector.detect(flat, 64, 48).encode("cloud", "ply"), /give `camera` or `sensor`/);
    refused(() => dp.read(new Uint8Array(6), "map.raw"), /state the size with `raw_size`$/);
    refused(() => new dp.Detector({ unit: "disparity", baseline: 0.1 }), /`focal` \(or `camera`\)/);
    refused(() => detector.detect(flat, 64, 48).encode("labels", "jpg"), /png or .npy/);
    refused(() => dp.read(new Uint8Array(10), "map.png", { sensr: "kinect1" }), /no option `sensr`; did you mean `sensor`\?; accepted: sensor, unit, camera, /);
    refused(() => new dp.Detector({ unit: "mm" }).detect(dp.scene("room:size=64x48")), /read already/);
    refused(() => dp.scene("ballroom"), /ballroom.*room/);
    for (const [name, text] of [["letter.txt", "Dear Sir"], ["cut.png", "\x89PNG\r\n\x1a\n"], ["photo.jpg", "\xff\xd8\xff\xe0"]]) {
        const bytes = Buffer.from(text, "latin1");
        await writeFile(join(folder, name), bytes);
        let said;
        assert.throws(() => program(["detect", name], folder), error => (said = error.stderr, true));
        refused(() => dp.read(bytes, name), new RegExp(`^${name}: `));
        const inOptions = said.replace(/--([a-z-]+)/g, (_, flag) => `\`${flag.replaceAll("-", "_").replace("intrinsics", "camera")}\``);
        assert.throws(() => dp.read(bytes, name), error => inOptions.includes(error.message) || assert.fail(`${said} ${error.message}`));
    }
}));

/** The names of a union of literals in a file of types. */
async function union(file, name) {
    const types = await readFile(join(BUILT, "package", file), "utf8");
    const [, names] = new RegExp(`type ${name} = ([^;]*);`).exec(types);
    return [...names.matchAll(/"([\w.-]+)"/g)].map(([, name]) => name).sort();
}

/** The options that an interface in the types of options has. */
async function optionsOf(name) {
    const types = await readFile(join(BUILT, "package/options.d.ts"), "utf8");
    const [, body] = new RegExp(`interface ${name}[^{]*{([^}]*)}`).exec(types);
    return [...body.matchAll(/^    (\w+)\?:/gm)].map(([, option]) => option);
}

test("names of options, methods and outputs are those of the tables, and have types", async () => {
    const parameters = dp.methods().flatMap(({ parameters }) => parameters.map(({ name }) => name));
    assert.deepEqual(await union("options.d.ts", "ParameterName"), [...new Set(parameters)].sort());
    assert.deepEqual(await union("tables.d.ts", "MethodName"), dp.methods().map(({ name }) => name).sort());
    const { outputs } = dp.tables();
    assert.deepEqual(await union("tables.d.ts", "OutputName"), outputs.map(({ name }) => name).sort());
    assert.deepEqual(await union("tables.d.ts", "Extension"), [...new Set(outputs.flatMap(({ extensions }) => extensions))].sort());
    const own = dp.methods()[0].parameters.map(({ name }) => name);
    const options = [...await optionsOf("Reading"), ...await optionsOf("Search"), ...own].sort();
    assert.throws(() => new dp.Detector({ nothing: 1 }), ({ message }) => {
        assert.deepEqual(message.split("accepted: ")[1].split(", ").sort(), options);
        return true;
    });
    for (const { name, parameters } of dp.methods()) {
        const values = Object.fromEntries(parameters.map(({ name, default: usual }) => [name, usual]));
        const { record } = new dp.Detector({ method: name, ...values }).detect(new Uint16Array(64).fill(9), 8, 8);
        const written = Object.fromEntries(Object.entries(record.parameters).map(([name, value]) => [name.replaceAll("-", "_"), value]));
        assert.deepEqual(written, values);
        // As the document has them.
        assert.deepEqual(new dp.Detector({ method: name, ...record.parameters }).detect(new Uint16Array(64).fill(9), 8, 8).record.parameters, record.parameters);
    }
});

test("each flag that a message of the readers names is an option", async () => {
    const { outputFiles } = await build({ entryPoints: [join(ROOT, "bindings/web/js/words.ts")], bundle: true, format: "esm", write: false });
    const { inOptions, inFields } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString("base64")}`);
    const options = new Set([...await optionsOf("Reading"), ...await optionsOf("Search")]);
    const sources = join(ROOT, "crates/depthplanes-io/src");
    // Label images are not read here.
    const names = (await readdir(sources, { recursive: true })).filter(name => name.endsWith(".rs") && name !== "labels.rs");
    let seen = 0;
    for (const name of [...names, "../../depthplanes/src/explanation.rs"]) {
        const code = (await readFile(join(sources, name), "utf8")).split("#[cfg(test)]")[0]
            .replace(/^\s*\/\/.*$|\.contains\("[^"]*"\)/gm, "");
        for (const [flag] of code.matchAll(/--[a-z][a-z-]*\b(?!=no)/g)) {
            if (flag === "--features") continue; // of how the program is built; such a phrase is left out
            const [, option] = /^`(\w+)`$/.exec(inOptions(flag)) ?? assert.fail(`${name}: ${flag}`);
            assert.ok(options.has(option), `${name}: ${flag}`);
            seen++;
        }
    }
    assert.ok(seen > 100, `${seen}`);
    const says = (text, option, field) => assert.deepEqual([inOptions(text), inFields(text)], [option, field]);
    says("state --encoding millimetre, or --raw-size", "state `unit` millimetre, or `raw_size`", "state “Unit” millimetre, or “Raw size”");
    says("try --intrinsics=1,2,3,4; --rectified=no undoes it", "try `camera` 1,2,3,4; `rectified` false undoes it", "try “Camera” 1,2,3,4; “Rectified” false undoes it");
    says("check --intrinsics, --camera and --camera-size", "check `camera` and `camera_size`", "check “Camera” and “Camera size”");
    says("builds with the feature `x` (cargo install ... --features x)", "builds with the feature `x`", "builds with the feature `x`");
});

test("types refuse a method, an output and an option that there is not", () => withFolder(async folder => {
    await writeFile(join(folder, "package.json"), "{}");
    await cp(join(BUILT, "package"), join(folder, "node_modules/depthplanes"), { recursive: true });
    const wrong = ['new dp.Detector({ method: "ngaff" })', 'new dp.Detector({ "min-pixels": 9 })', 'planes.encode("labelz", "png")', 'planes.encode("labels", "jpg")'];
    const right = ['new dp.Detector({ method: "ngaf", min_pixels: 9 })', 'planes.encode("labels", "png")', "load(address)"];
    const lines = [...wrong.map(line => `// @ts-expect-error\n${line};`), ...right.map(line => `${line};`)].join("\n");
    await writeFile(join(folder, "calls.ts"), `import { load, type Depthplanes, type Planes } from "depthplanes";\nimport address from "depthplanes/depthplanes.wasm";\ndeclare const dp: Depthplanes, planes: Planes;\n${lines}\n`);
    execFileSync(join(ROOT, "bindings/web/node_modules/.bin/tsc"), [...STRICT, "calls.ts"], { cwd: folder, stdio: "pipe" });
}));

// Maps of each format are compared on the page.
test("tables are the program's", () => {
    for (const [command, rows] of [["presets", dp.sensors()], ["formats", dp.tables().formats], ["methods", dp.methods()], ["encodings", dp.tables().units]]) {
        const text = program([command]);
        const said = about => about.replace(/`(\w+)`$/, (_, option) => `--${option.replaceAll("_", "-")}`);
        for (const { name, about } of rows) assert.ok(text.includes(name) && (text.includes(about) || text.includes(said(about))), name);
        assert.equal(text.trim().split("\n").length, rows.length + 1, command);
    }
    assert.deepEqual(dp.tables().formats.map(({ name }) => name).sort(), Object.keys(WRITERS).sort());
});

test("a map that is too large is refused, and the next one is not", () => {
    const detector = new dp.Detector();
    const found = (width, height) => {
        const { labels, planes } = detector.detect(new Uint16Array(width * height).fill(1000), width, height);
        return [labels.length, planes.length];
    };
    const message = /^(\d+ MB of memory are needed; accepted: what fits into|more memory is needed than) the 4295 MB of a WebAssembly module/;
    for (const [width, height] of [[5000, 5000], [4000, 3900]]) {
        assert.throws(() => found(width, height), { name: "InputError", message }, `${width} x ${height}`);
    }
    // Each fits into a module, and with what the one before has left it does not.
    for (const [width, height] of [[3840, 2160], [4096, 2160], [2160, 4096]]) assert.deepEqual(found(width, height), [width * height, 1]);
    assert.equal(detector.detect(new Uint16Array(4096).fill(1000), 64, 64).planes.length, 1);
});

/** Snippets of a page in a language, in their order. */
async function snippets(page, language) {
    const text = await readFile(join(ROOT, page), "utf8");
    return [...text.matchAll(/^```(\w+)\n([^]*?)^```/gm)].filter(([, of]) => of === language).map(([, , code]) => code);
}

for (const page of ["docs/browser.md", "bindings/web/README.md"]) {
    test(`the snippets of ${page} run, and their types are right`, () => withFolder(async folder => {
        const code = (await snippets(page, "js")).join("\n");
        assert.match(code, /await load\(\)/);
        // Installed as it is packed, without a network.
        const npm = words => execFileSync("npm", words, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
        const packed = npm(["pack", join(BUILT, "package"), "--silent"]).trim();
        npm(["install", `./${packed}`, "--offline", "--no-audit", "--no-fund", "--silent"]);
        const { depth, width, height } = dp.scene("room:sensor=kinect");
        await writeFile(join(folder, "depth.pgm"), WRITERS.pnm[1]({ depth, width, height }));
        await writeFile(join(folder, "snippets.mjs"), code);
        execFileSync(process.execPath, ["snippets.mjs"], { cwd: folder, stdio: "pipe" });
        await writeFile(join(folder, "node.d.ts"), "declare module 'node:fs/promises' { export function readFile(name: string): Promise<Uint8Array>; export function writeFile(name: string, bytes: Uint8Array): Promise<void>; }\n");
        await cp(join(folder, "snippets.mjs"), join(folder, "snippets.ts"));
        execFileSync(join(ROOT, "bindings/web/node_modules/.bin/tsc"), [...STRICT, "node.d.ts", "snippets.ts"], { cwd: folder, stdio: "pipe" });
    }));
}

test("a frame of 640 x 480 takes less than 75 ms", { skip }, async t => {
    const frames = await vga();
    const detector = new dp.Detector();
    const times = [];
    for (let round = 0; round < 5; round++) {
        for (const frame of frames) {
            const start = performance.now();
            detector.detect(frame.depth, frame.width, frame.height);
            if (round > 0) times.push(performance.now() - start);
        }
    }
    const median = times.sort((a, b) => a - b)[times.length >> 1];
    t.diagnostic(`${median.toFixed(2)} ms, median of ${times.length} detections of ${frames.length} recorded maps`);
    assert.ok(median < 75, `${median} ms`); // a quiet machine takes a tenth of that, and those of tests are busy
});
