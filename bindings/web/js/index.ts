/**
 * Finds planes in depth and disparity maps: floors, walls, tables, steps.
 *
 * @example
 * const dp = await load();
 * const detector = new dp.Detector({ camera: [580, 580, 319.5, 239.5] });
 * const { labels, planes } = detector.detect(depth, 640, 480); // depth: Uint16Array, millimetres
 *
 * @module
 */

import { bytesOf, copied, numbers, text, whole, type MapArray } from "./given.js";
import { InputError } from "./error.js";
import { Module, type MapOf, type Request, type Wasm } from "./module.js";
import type { DetectorOptions, Reading, Search } from "./options.js";
import type { Explanation, Plane, PlanesRecord } from "./results.js";
import type { Extension, Method, OutputName, Row, Tables } from "./tables.js";
import { inOptions } from "./words.js";

export { InputError, type MapArray, type Wasm };
export type * from "./options.js";
export type * from "./results.js";
export type * from "./tables.js";

/** A map that was read from a file, or made of a scene. */
export class Frame {
    /**
     * The numbers, row by row, as they are in the file. They are a copy: what is written to them does not change the frame. To find
     * planes in what was written, hand over the array: `detect(frame.depth, frame.width, frame.height)`.
     */
    readonly depth: Uint8Array | Uint16Array | Float32Array;
    readonly width: number;
    readonly height: number;
    /** Name of the format, and of what the numbers mean. */
    readonly format: string;
    readonly unit: string;
    /** `null` unless the numbers are depths. */
    readonly metres_per_unit: number | null;
    /** fx, fy, cx, cy in pixels, if the camera is known. */
    readonly camera: [number, number, number, number] | null;
    /** The number that means "not measured", beside 0, NaN and infinity. */
    readonly missing: number | null;
    /** What a person should know of the map. */
    readonly notes: string[];

    /** @internal */
    readonly map: MapOf;
    /** @internal */
    readonly bytes: Uint8Array;
    /** @internal */
    readonly reading: Reading;

    /** @internal */
    constructor(module: Module, map: MapOf, bytes: Uint8Array, reading: Reading) {
        [this.map, this.bytes, this.reading] = [map, bytes, copied("what is stated of the map", reading)];
        const read = module.ask({ ask: "read", map, words: this.reading }, bytes);
        this.depth = read.depth;
        this.width = read.width;
        this.height = read.height;
        this.format = read.format;
        this.unit = read.unit;
        this.metres_per_unit = read.metres_per_unit;
        this.camera = read.camera;
        this.missing = read.missing;
        this.notes = read.notes.map(inOptions);
    }
}

/** The planes of a map, the largest first. What is written to them changes no file of `encode`. */
export class Planes {
    readonly width: number;
    readonly height: number;
    /** A number for each pixel, row by row: 0 = no plane, otherwise the plane's `label`. */
    readonly labels: Uint16Array;
    readonly planes: Plane[];
    /** As `labels`, of curved surfaces, if they were asked for. */
    readonly curved?: Uint16Array;
    /** Milliseconds of each stage, by its name, reading first. */
    readonly stages: Record<string, number>;
    /** What a person should know of the map and of the result; `record.warnings` in the words of this package. */
    readonly notes: string[];
    /** The whole document. */
    readonly record: PlanesRecord;

    readonly #module: Module;
    readonly #request: Omit<Request, "ask">;
    readonly #bytes: Uint8Array;

    /** @internal */
    constructor(module: Module, request: Omit<Request, "ask">, bytes: Uint8Array) {
        const found = module.ask({ ask: "detect", ...request }, bytes);
        this.record = JSON.parse(new TextDecoder().decode(found.record));
        this.width = this.record.width;
        this.height = this.record.height;
        this.labels = found.labels;
        this.curved = found.curved;
        this.planes = this.record.planes;
        this.stages = Object.fromEntries(found.stages);
        this.notes = this.record.warnings.map(inOptions);
        [this.#module, this.#request, this.#bytes] = [module, request, bytes];
    }

    /**
     * Why the pixel in column u, row v has a plane or none, and what to change. Takes some times as long as the detection.
     *
     * @throws {InputError} for a pixel outside of the map.
     */
    explain(u: number, v: number): Explanation {
        for (const [what, given] of Object.entries({ u, v })) whole(what, given, 0);
        const { arrays, ...explanation } = this.#module.ask({ ask: { explain: [u, v] }, ...this.#request }, this.#bytes);
        explanation.verdict.text = inOptions(explanation.verdict.text);
        return explanation as Explanation;
    }

    /**
     * The bytes of a file, as the program writes it: an output (`tables().outputs`: `"labels"`, `"overlay"`, `"planes"`,
     * `"cloud"`, `"mesh"`, `"curved-labels"`) in the form of an extension (`"png"`, `"npy"`, `"json"`, `"csv"`, `"ply"` ...).
     *
     * @throws {InputError} for an output or an extension that there is not, or that needs a camera.
     */
    encode(output: OutputName, extension: Extension): Uint8Array {
        for (const [what, given] of Object.entries({ output, extension })) text(what, given);
        return this.#module.ask({ ask: { encode: [output, extension] }, ...this.#request }, this.#bytes).bytes;
    }
}

/** Finds planes in the maps of one camera. Keep it for all of them. */
export class Detector {
    /** A copy of what was given, which cannot be changed. */
    readonly options: DetectorOptions;
    readonly #module: Module;

    /** @internal */
    constructor(module: Module, options: DetectorOptions = {}) {
        this.options = copied("the options", options);
        module.ask({ ask: "check", words: this.options });
        this.#module = module;
    }

    /**
     * The planes of an array of width x height numbers, row by row, or of a frame that was read. The array may be written to
     * afterwards.
     *
     * @throws {InputError} for what is no map.
     */
    detect(map: MapArray, width: number, height: number): Planes;
    detect(map: Frame): Planes;
    detect(map: MapArray | Frame, width?: number, height?: number): Planes {
        if (map instanceof Frame) {
            const request = { map: map.map, read_with: map.reading, words: this.options };
            return new Planes(this.#module, request, map.bytes);
        }
        const { sample, bytes } = numbers(map);
        const size = { width: whole("width", width, 1), height: whole("height", height, 1) };
        if (map.length !== size.width * size.height) {
            throw new InputError(`the array has ${map.length} numbers; accepted: ${size.width} x ${size.height} = ${size.width * size.height}`);
        }
        return new Planes(this.#module, { map: { array: { sample, ...size } }, words: this.options }, bytes);
    }
}

/** All there is, of one module. */
export class Depthplanes {
    /** `new dp.Detector(options)`; throws an InputError for an option that is not accepted. */
    readonly Detector: new (options?: DetectorOptions) => Detector;
    readonly version: string;
    readonly #module: Module;
    readonly #tables: Tables;

    /** @internal */
    constructor(module: Module) {
        this.#module = module;
        const tables = tablesOf(module);
        this.#tables = tables;
        this.version = tables.version;
        this.Detector = class extends Detector {
            constructor(options?: DetectorOptions) {
                super(module, options);
            }
        };
    }

    /**
     * Reads a file of any of `tables().formats`, which is told by its content. `name` is what messages call it.
     *
     * @throws {InputError} with what is wrong with it.
     */
    read(bytes: Uint8Array | ArrayBuffer, name = "bytes", reading: Reading = {}): Frame {
        return new Frame(this.#module, { file: text("the name", name) }, bytesOf(bytes), reading);
    }

    /** A synthetic scene, such as `"room:sensor=kinect,size=320x240"`; `tables()` lists `scenes` and `scene_sensors`. */
    scene(spec: string): Frame {
        return new Frame(this.#module, { scene: text("the scene", spec) }, new Uint8Array(0), {});
    }

    /** The methods with their parameters; the first is the default. */
    methods(): Method[] {
        return structuredClone(this.#tables.methods);
    }

    /** The names that `sensor` takes. */
    sensors(): Row[] {
        return structuredClone(this.#tables.sensors);
    }

    /** All tables. */
    tables(): Tables {
        return structuredClone(this.#tables);
    }
}

/**
 * Loads the module: from `depthplanes.wasm` beside this file, or from where it is stated to be (an address, a response, bytes,
 * or a module that was compiled).
 */
export async function load(wasm: Wasm = new URL("depthplanes.wasm", import.meta.url)): Promise<Depthplanes> {
    return new Depthplanes(await Module.load(wasm));
}

/** The tables, with the names of options. */
function tablesOf(module: Module): Tables {
    const { arrays, ...tables } = module.ask({ ask: "tables" });
    const rows: Row[] = [...tables.sensors, ...tables.units, ...tables.formats, ...tables.outputs];
    for (const row of rows) row.about = inOptions(row.about);
    for (const { parameters } of tables.methods as Method[]) {
        for (const parameter of parameters) parameter.name = parameter.name.replaceAll("-", "_");
    }
    return tables;
}
