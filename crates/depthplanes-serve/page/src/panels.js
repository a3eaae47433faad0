// The side panel: planes, the ground, milliseconds, and what is known of a pixel.

import { css } from "./colours.js";
import { valueAt } from "./message.js";
import { node } from "./sliders.js";

const metres = (value, digits = 2) => Number.isFinite(value) ? `${value.toFixed(digits)} m` : "–";
const degrees = value => Number.isFinite(value) ? `${value.toFixed(0)}°` : "–";
const swatch = plane => {
    const mark = node("span", { className: "swatch" });
    mark.style.background = css(plane.colour);
    return mark;
};

/** Columns that are left out, one after the other, where the table is wider than its place: no number is cut off. */
const SPARE = ["tilt", "class", "area"];

/** How steep a plane is: against the floor, or else against the picture. */
export const tilt = plane => plane.slope_deg ?? (plane.normal ? Math.acos(Math.min(1, -plane.normal[2])) * 180 / Math.PI : NaN);

/** The table of planes; `choose` is told the id of the row that is clicked, or entered. */
export function showPlanes(element, { planes, unit }, chosen, choose) {
    const scroll = element.scrollTop;
    const head = [["id", "text"], ["class", "text class"], ["depth"], ["tilt", "tilt"], ["area", "area"], ["pixels"]];
    const heads = head.map(([textContent, className = ""]) => node("th", { textContent, className }));
    const rows = planes.map(plane => {
        const cells = [
            node("td", { className: "text" }, swatch(plane), String(plane.id)),
            node("td", { className: "text class", textContent: plane.class ?? "–" }),
            node("td", { textContent: metres(plane.depth_m) }),
            node("td", { className: "tilt", textContent: degrees(tilt(plane)) }),
            node("td", { className: "area", textContent: Number.isFinite(plane.area_m2) ? `${plane.area_m2.toFixed(2)} m²` : "–" }),
            node("td", { textContent: plane.pixel_count }),
        ];
        const row = node("tr", { className: plane.id === chosen ? "chosen" : "" }, ...cells);
        row.dataset.id = plane.id;
        row.tabIndex = 0;
        return row;
    });
    const table = node("table", {}, node("thead", {}, node("tr", {}, ...heads)), node("tbody", {}, ...rows));
    element.onclick = element.onkeydown = event => {
        const row = event.target.closest("tbody tr");
        if (!row || (event.key && event.key !== "Enter")) return;
        choose(Number(row.dataset.id));
    };
    const focused = element.contains(document.activeElement) && document.activeElement.dataset.id;
    element.replaceChildren(planes.length ? table : node("p", { className: "muted", textContent: "No plane in this frame." }));
    for (const column of SPARE) if (element.scrollWidth > element.clientWidth) table.classList.add(`without-${column}`);
    element.scrollTop = scroll;
    if (focused) element.querySelector(`[data-id="${focused}"]`)?.focus({ preventScroll: true });
}

export function showGround(element, { ground }) {
    if (!ground?.floor) {
        const why = ground ? "No floor in this frame." : "The floor needs the unit of the map and its camera.";
        return element.replaceChildren(node("p", { className: "muted", textContent: why }));
    }
    const { floor, obstacles, sectors, steps } = ground;
    const things = obstacles.filter(of => !of.is_drop);
    const free = Math.max(0, ...sectors.map(sector => sector.free_m));
    const near = of => of.length ? `${of.length}, nearest ${metres(of[0].distance_m)}` : "none";
    element.replaceChildren(facts([
        ["Camera height", `${floor.height_m.toFixed(3)} ± ${floor.height_sd_m.toFixed(3)} m`],
        ["Tilt, roll", `${floor.tilt_deg.toFixed(1)}°, ${floor.roll_deg.toFixed(1)}°`],
        ["Confidence", `${Math.round(100 * floor.confidence)} %`],
        ["Obstacles", near(things)],
        ["Drops", near(obstacles.filter(of => of.is_drop))],
        ["Farthest free", metres(free)],
        ...(steps.length ? [["Steps", steps.length]] : []),
    ]));
}

/** Names and what stands beside them. */
export function facts(rows) {
    return node("dl", { className: "facts" }, ...rows.flatMap(([name, value]) => [
        node("dt", { textContent: name }), node("dd", {}, ...[value].flat()),
    ]));
}

/** Milliseconds of each stage, averaged over the last frames. */
export class Stages {
    constructor(element, total) {
        Object.assign(this, { element, total, means: new Map() });
    }

    add({ stages }) {
        const names = new Set(stages.map(([name]) => name));
        for (const name of this.means.keys()) if (!names.has(name)) this.means.delete(name);
        for (const [name, ms] of stages) this.means.set(name, 0.9 * (this.means.get(name) ?? ms) + 0.1 * ms);
    }

    /** Shows them; returns the milliseconds of the stages that are named, or of all. Others are muted. */
    show(names) {
        const all = [...this.means];
        const most = Math.max(0.1, ...all.map(([, ms]) => ms));
        const isOwn = ([name]) => !names || names.includes(name);
        this.element.replaceChildren(...all.map(([name, ms]) => {
            const bar = node("i");
            bar.style.width = `${100 * ms / most}%`;
            const className = isOwn([name]) ? "stage-row" : "stage-row muted";
            return node("div", { className }, node("span", { textContent: name }),
                node("span", { className: "meter" }, bar), node("span", { textContent: `${ms.toFixed(ms < 100 ? 2 : 0)} ms` }));
        }));
        const [own, whole] = [all.filter(isOwn), all].map(rows => rows.reduce((sum, [, ms]) => sum + ms, 0));
        const rest = whole - own;
        this.total.textContent = names ? `${own.toFixed(1)} ms the method, ${rest.toFixed(1)} ms before and after it` : `${whole.toFixed(1)} ms a frame`;
        return own;
    }
}

/** What is known of a pixel of the map: its value, and its plane. */
export function showPixel(element, frame, [u, v], plane, more) {
    const at = Math.floor(v / frame.step) * frame.width + Math.floor(u / frame.step);
    const value = valueAt(frame, at);
    const unit = frame.unit === "m" ? " m" : "";
    const rows = [["Column, row", `${u}, ${v}`], ["Depth", Number.isNaN(value) ? "not measured" : value.toPrecision(4) + unit]];
    if (frame.unit !== "m") rows[1][0] = "Value";
    if (plane) {
        rows.push(["Plane", [swatch(plane), `${plane.id}${plane.class ? `, ${plane.class}` : ""}`]]);
        rows.push(["Pixels", plane.pixel_count]);
        if (plane.normal) {
            rows.push(["Normal", plane.normal.map(x => x.toFixed(3)).join(", ")]);
            rows.push(["From camera", metres(plane.distance_m, 3)]);
            rows.push(["Rough (rms)", `${(1000 * plane.rms_m).toFixed(1)} mm`]);
        }
        if (Number.isFinite(plane.height_m)) rows.push(["Above floor", metres(plane.height_m, 3)]);
        if (plane.age) rows.push(["Followed for", `${plane.age} frames`]);
    }
    const curved = frame.curved?.[at];
    if (curved) rows.push(["Curved surface", curved]);
    element.replaceChildren(facts(rows), ...more);
}
