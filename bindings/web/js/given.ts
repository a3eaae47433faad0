// What callers give: held against what is accepted, and copied, so that what they do with it later changes no result.

import { InputError } from "./error.js";

/** Numbers of a map, row by row, top row first. */
export type MapArray =
    | Uint8Array | Uint8ClampedArray | Int8Array | Uint16Array | Int16Array | Uint32Array | Int32Array | BigUint64Array | BigInt64Array
    | Float32Array | Float64Array;

/** A copy of an object of options, which cannot be changed. */
export function copied<T extends object>(what: string, given: T): T {
    if (typeof given !== "object" || given === null || Array.isArray(given)) {
        throw new InputError(`${what}: ${shown(given)}; accepted: an object, such as { unit: "mm" }`);
    }
    return JSON.parse(asJson(what, given), (_, value) => Object.freeze(value));
}

function asJson(what: string, given: object): string {
    try {
        return JSON.stringify(given, inJson);
    } catch (error) {
        if (error instanceof InputError) throw error;
        throw new InputError(`${what}: an object that holds itself, or that cannot be read; accepted: names with numbers, strings and arrays`);
    }
}

/** JSON has no such values: it refuses them, or leaves them out. */
function inJson(name: string, value: unknown): unknown {
    if (typeof value === "number" && !Number.isFinite(value)) {
        throw new InputError(`${name} is ${value}; accepted: a finite number`);
    }
    if (typeof value === "bigint" || typeof value === "function" || typeof value === "symbol") {
        throw new InputError(`${name} is ${shown(value)}; accepted: a number, a string, true, false, or an array`);
    }
    return value;
}

/** The bytes of a file, a copy. */
export function bytesOf(file: Uint8Array | ArrayBuffer): Uint8Array {
    return file instanceof ArrayBuffer ? copyOf(file, 0) : numbers(file).bytes;
}

/** The bytes of an array, a copy, and the name of their type in NumPy's words. */
export function numbers(array: MapArray): { sample: string; bytes: Uint8Array } {
    if (!ArrayBuffer.isView(array) || array instanceof DataView) {
        throw new InputError(`the map is ${shown(array)}; accepted: a typed array, such as Uint16Array or Float32Array, or a Frame`);
    }
    const sample = array[Symbol.toStringTag].replace(/Clamped|Big|Array/g, "").toLowerCase();
    return { sample, bytes: copyOf(array.buffer, array.byteOffset, array.byteLength) };
}

function copyOf(buffer: ArrayBufferLike, from: number, length?: number): Uint8Array {
    try {
        return new Uint8Array(buffer, from, length).slice();
    } catch {
        throw new InputError("the array has no memory any more: it was transferred, for instance to a worker; accepted: one that was not");
    }
}

/** A whole number from a least one on. */
export function whole(name: string, given: unknown, least: number): number {
    if (Number.isSafeInteger(given) && (given as number) >= least) return given as number;
    throw new InputError(`${name} is ${shown(given)}; accepted: a whole number from ${least} on`);
}

/** A string. */
export function text(name: string, given: unknown): string {
    if (typeof given === "string") return given;
    throw new InputError(`${name} is ${shown(given)}; accepted: a string`);
}

/** What was given, and of which kind it is where that is what is wrong. */
function shown(given: unknown): string {
    if (typeof given === "string") return `the string ${JSON.stringify(given)}`;
    if (typeof given === "bigint") return `the BigInt ${given}n`;
    if (Array.isArray(given)) return "an Array";
    return typeof given === "number" || given === null || given === undefined ? String(given) : `of type ${typeof given}`;
}
