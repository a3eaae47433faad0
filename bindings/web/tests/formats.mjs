// Maps of 16-bit millimetres as files of each format that is read.

import { crc32 } from "node:zlib";

const bytes = (array, type) => Buffer.from(type.from(array).buffer);
const u16 = ({ depth }) => bytes(depth, Uint16Array);
const metres = ({ depth }) => Float32Array.from(depth, mm => mm / 1000);
const words = (...numbers) => bytes(numbers, Uint32Array);

function pgm({ depth, width, height }) {
    return Buffer.concat([Buffer.from(`P5\n${width} ${height}\n65535\n`), u16({ depth }).swap16()]);
}

function npy(map) {
    const about = `{'descr': '<u2', 'fortran_order': False, 'shape': (${map.height}, ${map.width}), }`;
    const head = about.padEnd(117) + "\n";
    return Buffer.concat([Buffer.from("\x93NUMPY\x01\x00\x76\x00", "latin1"), Buffer.from(head), u16(map)]);
}

/** An archive of one file, which is not packed. */
function npz(map) {
    const [name, body] = [Buffer.from("depth.npy"), npy(map)];
    const entry = Buffer.alloc(26);
    entry.writeUInt16LE(20, 0);
    entry.writeUInt32LE(crc32(body), 10);
    entry.writeUInt32LE(body.length, 14);
    entry.writeUInt32LE(body.length, 18);
    entry.writeUInt16LE(name.length, 22);
    const local = Buffer.concat([Buffer.from("PK\x03\x04"), entry, name, body]);
    const listed = Buffer.concat([Buffer.from("PK\x01\x02\x14\x00"), entry, Buffer.alloc(14), name]);
    const end = Buffer.alloc(18);
    end.writeUInt16LE(1, 4);
    end.writeUInt16LE(1, 6);
    end.writeUInt32LE(listed.length, 8);
    end.writeUInt32LE(local.length, 12);
    return Buffer.concat([local, listed, Buffer.from("PK\x05\x06"), end]);
}

function tiff(map) {
    const body = u16(map);
    const tags = [[256, map.width], [257, map.height], [258, 16], [259, 1], [262, 1], [273, 8], [277, 1], [278, map.height], [279, body.length]];
    const directory = Buffer.alloc(2 + 12 * tags.length + 4);
    directory.writeUInt16LE(tags.length, 0);
    tags.forEach(([tag, value], at) => {
        directory.writeUInt16LE(tag, 2 + 12 * at);
        directory.writeUInt16LE(4, 4 + 12 * at);
        directory.writeUInt32LE(1, 6 + 12 * at);
        directory.writeUInt32LE(value, 10 + 12 * at);
    });
    return Buffer.concat([Buffer.from("II\x2a\x00"), words(8 + body.length), body, directory]);
}

function pfm(map) {
    const values = metres(map);
    const rows = Array.from({ length: map.height }, (_, at) => values.subarray(at * map.width, (at + 1) * map.width));
    return Buffer.concat([Buffer.from(`Pf\n${map.width} ${map.height}\n-1\n`), ...rows.reverse().map(row => bytes(row, Float32Array))]);
}

function pcd(map) {
    const head = `# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH ${map.width}\nHEIGHT ${map.height}\n`
        + `VIEWPOINT 0 0 0 1 0 0 0\nPOINTS ${map.width * map.height}\nDATA binary\n`;
    const point = (z, at) => z > 0
        ? [(at % map.width - 319.5) / 525 * z, (Math.floor(at / map.width) - 239.5) / 525 * z, z] : [NaN, NaN, NaN];
    return Buffer.concat([Buffer.from(head), bytes([...metres(map)].flatMap(point), Float32Array)]);
}

/** Packed by a packer that finds nothing to pack: pieces of 32 bytes behind their lengths. */
function pclzf(map) {
    const body = u16(map);
    const pieces = [];
    for (let at = 0; at < body.length; at += 32) {
        const piece = body.subarray(at, at + 32);
        pieces.push(Buffer.from([piece.length - 1]), piece);
    }
    const packed = Buffer.concat(pieces);
    const kind = Buffer.alloc(16);
    kind.write("depth16");
    return Buffer.concat([Buffer.from("PCLZF"), words(map.width, map.height), kind, words(packed.length, body.length), packed]);
}

function rvl({ depth, width, height }) {
    const packed = [];
    let [word, nibbles] = [0, 0];
    const nibble = value => {
        word = (word << 4 | value) >>> 0;
        if (++nibbles === 8) packed.push(word), word = nibbles = 0;
    };
    const number = value => {
        do nibble(value & 7 | (value > 7 ? 8 : 0)); while (value >>>= 3);
    };
    let last = 0;
    for (let at = 0; at < depth.length;) {
        let end = at;
        while (end < depth.length && depth[end] === 0) end++;
        number(end - at);
        at = end;
        while (end < depth.length && depth[end] !== 0) end++;
        number(end - at);
        for (; at < end; at++) {
            const step = depth[at] - last;
            number(step < 0 ? -2 * step - 1 : 2 * step);
            last = depth[at];
        }
    }
    while (nibbles) nibble(0);
    return Buffer.concat([words(width, height), words(...packed)]);
}

/** 8 bits of a grey palette: every 40 mm. */
function bmp({ depth, width, height }) {
    const stride = Math.ceil(width / 4) * 4;
    const at = 54 + 1024;
    const file = Buffer.alloc(at + stride * height);
    file.write("BM");
    const head = [[2, file.length], [10, at], [14, 40], [18, width], [22, height], [26, 1 | 8 << 16], [34, stride * height], [46, 256]];
    for (const [place, value] of head) file.writeUInt32LE(value, place);
    for (let grey = 0; grey < 256; grey++) file.fill(grey, 54 + 4 * grey, 57 + 4 * grey);
    for (let v = 0; v < height; v++) {
        for (let u = 0; u < width; u++) file[at + (height - 1 - v) * stride + u] = Math.min(255, depth[v * width + u] / 40);
    }
    return file;
}

/** OpenEXR of one float channel, not packed: attributes, where each row starts, and the rows. */
function exr(map) {
    const { width, height } = map;
    const attribute = (name, type, value) => Buffer.concat([Buffer.from(`${name}\0${type}\0`), words(value.length), value]);
    const channel = Buffer.concat([Buffer.from("Z\0"), words(2), Buffer.from([1, 0, 0, 0]), words(1, 1), Buffer.from([0])]);
    const window = words(0, 0, width - 1, height - 1);
    const head = Buffer.concat([
        Buffer.from("\x76\x2f\x31\x01\x02\x00\x00\x00", "latin1"),
        attribute("channels", "chlist", channel), attribute("compression", "compression", Buffer.from([0])),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", Buffer.from([0])), attribute("pixelAspectRatio", "float", bytes([1], Float32Array)),
        attribute("screenWindowCenter", "v2f", bytes([0, 0], Float32Array)), attribute("screenWindowWidth", "float", bytes([1], Float32Array)),
        Buffer.from([0]),
    ]);
    const values = metres(map);
    const row = 8 + 4 * width;
    const places = Array.from({ length: height }, (_, at) => BigInt(head.length + 8 * height + row * at));
    const rows = places.map((_, at) => Buffer.concat([words(at, 4 * width), bytes(values.subarray(at * width, (at + 1) * width), Float32Array)]));
    return Buffer.concat([head, bytes(places, BigUint64Array), ...rows]);
}

/** The writers by the name of the format in the library's table: the ending of the file, and its bytes, of a map and its PNG. */
export const WRITERS = {
    "png": ["png", (map, png) => png],
    "compressed-depth": ["compressedDepth", (map, png) => Buffer.concat([Buffer.alloc(12), png])],
    "bmp": ["bmp", bmp],
    "pnm": ["pgm", pgm],
    "pfm": ["pfm", pfm],
    "npy": ["npy", npy],
    "npz": ["npz", npz],
    "tiff": ["tiff", tiff],
    "pcd": ["pcd", pcd],
    "pclzf": ["pclzf", pclzf],
    "rvl": ["rvl", rvl],
    "exr": ["exr", exr],
    "raw": ["raw", u16],
};
