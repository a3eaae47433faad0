// Results as files, those of the program.

import { node } from "../../../crates/depthplanes-serve/page/src/sliders.js";

/** What a button is called, and the file's output and extension. */
const FILES = [
    ["Labels, 16-bit PNG", "labels", "png"],
    ["Planes, JSON", "planes", "json"],
    ["Planes, CSV", "planes", "csv"],
    ["Picture, PNG", "overlay", "png"],
    ["Points, PLY", "cloud", "ply"],
    ["Mesh, PLY", "mesh", "ply"],
];

/** Makes the buttons; `encode(output, extension)` gives the bytes of what `page` shows, `fail` is told why there are none. */
export function offer(element, outputs, page, encode, fail) {
    element.replaceChildren(...FILES.map(([textContent, output, extension]) => {
        const title = outputs.find(({ name }) => name === output).about;
        const button = node("button", { textContent, title });
        button.dataset.output = `${output}.${extension}`;
        button.onclick = async () => {
            try {
                const stem = page.frame.name.replace(/^scene:|\.[^.]*$/g, "").replace(/[^\w.-]+/g, "-");
                const { bytes } = await encode(output, extension);
                save(`${stem}.${output}.${extension}`, bytes);
                fail(null);
            } catch (error) {
                fail(error.message);
            }
        };
        return button;
    }));
}

function save(download, bytes) {
    const href = URL.createObjectURL(new Blob([bytes]));
    node("a", { download, href }).click();
    setTimeout(() => URL.revokeObjectURL(href), 60_000);
}
