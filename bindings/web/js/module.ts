// The WebAssembly module: requests go in, responses come out, each a head of JSON with numbers behind it.

import { decode } from "../../../crates/depthplanes-serve/page/src/message.js";
import { InputError } from "./error.js";
import { inOptions } from "./words.js";

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

/** Bytes that a module can address. What stops one that has used more than half of them is the lack of more. */
const ALL = 2 ** 32;
const NOTHING = new Uint8Array(0);
const IMPORTS = { env: { now: () => performance.now() } };

export class Module {
    private exports!: Exports;
    /** Whether it has seen no map yet, and has all its memory: memory of WebAssembly grows and never shrinks. */
    private isFresh = true;

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
        const text = new TextEncoder().encode(JSON.stringify(request));
        const wasFresh = this.isFresh;
        if (request.map) this.isFresh = false;
        try {
            return this.answer(text, bytes);
        } catch (error) {
            if (!(error instanceof WebAssembly.RuntimeError)) throw error;
            const used = this.exports.memory.buffer.byteLength;
            // What it knew is lost, and no answer depends on that. Anew it has all its memory.
            this.use(new WebAssembly.Instance(this.compiled, IMPORTS));
            if (!wasFresh) return this.exchange(request, bytes);
            throw new InputError(used > ALL / 2
                ? `more memory is needed than the ${Math.ceil(ALL / 1e6)} MB of a WebAssembly module; accepted: a smaller map`
                : `the module stopped and was started anew (${error.message})`);
        }
    }

    private answer(text: Uint8Array, bytes: Uint8Array): ArrayBuffer {
        const { memory, request, respond, response } = this.exports;
        const length = 4 + text.length + bytes.length;
        const at = request(length) >>> 0; // addresses come as signed numbers
        if (at === 0) throw new WebAssembly.RuntimeError(`no memory for ${length} bytes`);
        new DataView(memory.buffer).setUint32(at, text.length, true);
        const room = new Uint8Array(memory.buffer, at + 4, length - 4);
        room.set(text);
        room.set(bytes, text.length);
        const size = respond() >>> 0;
        const from = response() >>> 0;
        return memory.buffer.slice(from, from + size) as ArrayBuffer; // memory may have grown, and then moved
    }

    private use(instance: WebAssembly.Instance): void {
        this.exports = instance.exports as unknown as Exports;
        this.isFresh = true;
    }
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
