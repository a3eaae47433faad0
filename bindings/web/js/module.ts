// The WebAssembly module: requests go in, responses come out, each a head of JSON with numbers behind it.

import { decode } from "../../../crates/depthplanes-serve/page/src/message.js";
import { inOptions } from "./words.js";

/** Something was wrong with what was given; the message says what is accepted. */
export class InputError extends Error {
    override name = "InputError";
}

/** What a request is about: an array, a file, or a scene. */
export type MapOf =
    | { array: { sample: string; width: number; height: number } }
    | { file: string }
    | { scene: string };

/** A request; see `src/request.rs`. */
export interface Request {
    ask: string | Record<string, unknown>;
    map?: MapOf;
    read_with?: object;
    words?: object;
}

interface Exports {
    memory: WebAssembly.Memory;
    request(bytes: number): number;
    respond(): number;
    response(): number;
}

/** Where the module's bytes are. */
export type Wasm = string | URL | Response | PromiseLike<Response> | BufferSource | WebAssembly.Module;

const NOTHING = new Uint8Array(0);
const IMPORTS = { env: { now: () => performance.now() } };

export class Module {
    private exports!: Exports;

    private constructor(private readonly compiled: WebAssembly.Module) {}

    /** Compiles the module and starts it. */
    static async load(wasm: Wasm): Promise<Module> {
        const module = new Module(await compile(wasm));
        module.use(await WebAssembly.instantiate(module.compiled, IMPORTS));
        return module;
    }

    /** Asks; the answer's head with its arrays. */
    ask(request: Request, bytes: Uint8Array = NOTHING): any {
        const head = decode(this.exchange(request, bytes));
        if (typeof head.error === "string") throw new InputError(inOptions(head.error));
        return head;
    }

    /** Asks; the answer's bytes, a copy. */
    exchange(request: Request, bytes: Uint8Array = NOTHING): ArrayBuffer {
        const text = new TextEncoder().encode(JSON.stringify(request, finite));
        const length = 4 + text.length + bytes.length;
        try {
            const { memory, respond, response } = this.exports;
            const at = this.exports.request(length) >>> 0; // addresses come as signed numbers
            if (at === 0) throw new InputError(`${length} bytes of memory are needed and cannot be had`);
            new DataView(memory.buffer).setUint32(at, text.length, true);
            const room = new Uint8Array(memory.buffer, at + 4, length - 4);
            room.set(text);
            room.set(bytes, text.length);
            const size = respond() >>> 0;
            const from = response() >>> 0;
            return memory.buffer.slice(from, from + size) as ArrayBuffer; // memory may have grown, and then moved
        } catch (error) {
            if (!(error instanceof WebAssembly.RuntimeError)) throw error;
            // What it knew is lost, and no answer depends on that.
            this.use(new WebAssembly.Instance(this.compiled, IMPORTS));
            throw new InputError(`the module had to be started anew (${error.message}): most likely the map is too large for its memory`);
        }
    }

    private use(instance: WebAssembly.Instance): void {
        this.exports = instance.exports as unknown as Exports;
    }
}

/** JSON has no numbers that are not finite. */
function finite(name: string, value: unknown): unknown {
    if (typeof value === "number" && !Number.isFinite(value)) {
        throw new InputError(`${name} is ${value}; accepted: a finite number`);
    }
    return value;
}

async function compile(wasm: Wasm): Promise<WebAssembly.Module> {
    const from = await wasm;
    if (from instanceof WebAssembly.Module) return from;
    if (from instanceof ArrayBuffer || ArrayBuffer.isView(from)) return WebAssembly.compile(from as BufferSource);
    if (from instanceof Response) return WebAssembly.compile(await bytesOf(from));
    const url = new URL(from as string | URL, import.meta.url);
    if (url.protocol !== "file:" || !("process" in globalThis)) return WebAssembly.compile(await bytesOf(await fetch(url)));
    const files = "node:fs/promises"; // node alone has it, and fetches no files
    const { readFile } = await import(/* @vite-ignore */ files);
    return WebAssembly.compile(await readFile(url));
}

async function bytesOf(response: Response): Promise<ArrayBuffer> {
    if (response.ok) return response.arrayBuffer();
    throw new InputError(`${response.url}: ${response.status} ${response.statusText}; accepted: the address of depthplanes.wasm, which `
        + "lies in the package. A bundler that does not copy it, such as esbuild, gives it by "
        + "`import wasm from \"depthplanes/depthplanes.wasm\"` with --loader:.wasm=file, for load(wasm)");
}
