// Binary messages of the server: a head of JSON and arrays of numbers behind it.

const TYPES = { u8: Uint8Array, u16: Uint16Array, f32: Float32Array };

/** The head of a message, with its arrays as members. They are views of the buffer: nothing is copied. */
export function decode(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    for (const [name, { type, at, length: count }] of Object.entries(head.arrays)) {
        head[name] = new TYPES[type](buffer, 4 + length + at, count);
    }
    return head;
}

/** The depth, or the value, of a pixel of the picture; NaN where nothing was measured. */
export function valueAt(frame, at) {
    const code = frame.depth[at];
    return code === 0 ? NaN : frame.low + (code - 1) * frame.scale;
}
