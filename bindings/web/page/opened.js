// Which of the files that were dropped or opened is the map, and which its camera.

/** Files of these are never maps, and most likely cameras. */
const TREES = /\.(json|ya?ml)$/i;

/** The map and the camera among at most two files; `check(text)` fails unless a text states a camera. */
export async function sorted(files, formats, check) {
    const ends = formats.flatMap(({ extensions }) => extensions).map(end => `.${end}`.toLowerCase());
    const isMap = ({ name }) => ends.some(end => name.toLowerCase().endsWith(end));
    const others = files.filter(file => !isMap(file));
    const maps = files.filter(isMap);
    // One of another name that holds no camera may be a map all the same, since maps are told by their content.
    const camera = others.find(({ name }) => TREES.test(name)) ?? await firstWith(others, check);
    maps.push(...others.filter(file => file !== camera));
    if (maps.length > 1) throw new Error(`${files.map(({ name }) => name).join(", ")}: one map at a time is shown, with a camera file beside it`);
    return { map: maps[0], camera };
}

/** What stands in a file: its `text` or its `arrayBuffer`. Fails with words, for instance of a folder, which browsers drop like a file. */
export function contentOf(file, kind) {
    return file[kind]().catch(() => {
        throw new Error(`${file.name}: this cannot be read; accepted: files that are still there, and no folders`);
    });
}

async function firstWith(files, check) {
    for (const file of files) {
        const holds = await file.text().then(check).then(() => true, () => false);
        if (holds) return file;
    }
}
