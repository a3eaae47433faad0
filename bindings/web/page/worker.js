// The thread that finds planes: the module answers here, and the page stays free meanwhile.

import { Module } from "../js/module.ts";

/* global WASM: the module, packed with gzip, in base64 */
const packed = Uint8Array.from(atob(WASM), letter => letter.charCodeAt(0));
const unpacked = new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip")));
const loaded = unpacked.arrayBuffer().then(bytes => Module.load(bytes));

onmessage = async ({ data: { number, request, bytes } }) => {
    try {
        const answer = (await loaded).exchange(request, bytes);
        postMessage({ number, answer }, [answer]);
    } catch (error) {
        postMessage({ number, error: error.message });
    }
};
