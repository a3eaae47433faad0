// Fields of what is stated of a map, one for each option of reading.

import { node } from "../../../crates/depthplanes-serve/page/src/sliders.js";
import { fieldOf } from "../js/words.ts";

/** Numbers of a text; words that are none stay, so that it is said what they are. */
export function numbers(text) {
    const words = text.split(/[\s,;x×]+/).filter(Boolean);
    return words.length ? words.map(word => Number.isFinite(Number(word)) ? Number(word) : word) : undefined;
}

const number = text => {
    const given = numbers(text);
    return given?.length === 1 ? given[0] : given;
};
const YES_OR_NO = new Map([["", undefined], ["yes", true], ["no", false]]);

/** Options that few maps need: the option, what its field takes, its placeholder, its title. */
const MORE = [
    ["scale", number, "map units per metre", "Of depth: map units per metre. Of disparity: map units per pixel"],
    ["depth_scale", number, "metres per map unit", "Metres of depth of one map unit"],
    ["disparity", "choice", "", "Whether the numbers are disparities"],
    ["baseline", number, "metres", "Distance of the two cameras of a stereo rig, metres"],
    ["focal", number, "pixels", "Focal length of a stereo rig, pixels; that of the camera if it is not stated"],
    ["doffs", number, "pixels", "Difference of the principal points of a stereo rig, pixels"],
    ["missing", number, "a number", "A number that means “not measured”, beside 0, NaN and infinity"],
    ["valid_range", numbers, "least, largest", "Smallest and largest valid number, map units"],
    ["ray_distance", "choice", "", "Whether the numbers are distances along the rays"],
    ["rectified", "choice", "", "Whether the map is of the picture without lens distortion"],
    ["camera_size", numbers, "width × height", "Columns and rows of the picture that the camera is for"],
    ["swap_bytes", "choice", "", "Whether the two bytes of 16-bit numbers are swapped"],
    ["raw_type", text => text || undefined, "uint16, float32 …", "Type of the numbers of a file without a header"],
    ["member", text => text || undefined, "name or page", "Which file of an archive (NPZ), or page of a TIFF"],
];

const shown = value => Array.isArray(value) ? value.join(", ") : String(value ?? "");

/** Makes the fields in an element; `read` takes what is stated of the map. Each has `show(reading)`. */
export function moreFields(element, read) {
    return MORE.map(([option, kind, placeholder, title]) => {
        const id = option.replaceAll("_", "-");
        const isChoice = kind === "choice";
        const field = node(isChoice ? "select" : "input", { id, title });
        if (isChoice) field.append(...["not stated", "yes", "no"].map(textContent => node("option", { value: textContent.replace("not stated", ""), textContent })));
        else Object.assign(field, { type: "text", placeholder, spellcheck: false, autocomplete: "off" });
        const valueOf = isChoice ? text => YES_OR_NO.get(text) : kind;
        field.onchange = () => read({ [option]: valueOf(field.value.trim()) });
        element.append(node("label", { htmlFor: id, textContent: fieldOf(option), title }), field);
        const written = isChoice ? value => value === undefined ? "" : value ? "yes" : "no" : shown;
        return { option, field, show: reading => field.value = written(reading[option]) };
    });
}
