// Picking a pixel: its plane is chosen, and where there is none it is asked why.

import { showPixel } from "./panels.js";
import { node } from "./sliders.js";

export class Pick {
    /** `choose` is told the id of the plane, or null; `ask` asks for what is not known here. */
    constructor(element, choose, ask) {
        Object.assign(this, { element, choose, ask });
        this.clear();
    }

    clear() {
        this.at = this.explained = null;
        this.id = undefined; // no choice of the pixel's
        this.missed = false;
        this.element.replaceChildren(node("p", { className: "muted", textContent: "Click a pixel to see its plane, or why it has none." }));
    }

    /** A pixel of the map was picked. */
    pick(frame, at) {
        this.at = at;
        const plane = planeAt(frame, at);
        this.explained = null;
        this.mark(plane);
        if (plane) return this.show(frame);
        this.ask("pause"); // what is explained is what is seen
        this.ask("explain", { serial: frame.serial, at });
        this.explained = frame;
        showPixel(this.element, frame, at, null, [node("p", { className: "muted", textContent: "No plane here. Asking why …" })]);
    }

    /** A new frame: the pixel may be another's now. */
    show(frame) {
        if (!this.at) return;
        if (this.at[0] >= frame.map.width || this.at[1] >= frame.map.height) return this.clear();
        const plane = planeAt(frame, this.at);
        // The frame that was asked about had passed; this is the one at which the video stopped.
        if (this.missed && frame.serial !== this.explained?.serial) return this.pick(frame, this.at);
        if (!plane && this.explained) return;
        this.explained = null;
        this.mark(plane);
        showPixel(this.element, frame, this.at, plane, plane ? [] : [node("p", { className: "muted", textContent: "No plane here now." })]);
    }

    /** Chooses the pixel's plane, once. */
    mark(plane) {
        this.missed = false;
        const id = plane?.id ?? null;
        if (id !== this.id) this.choose(this.id = id);
    }

    /** The answer to `explain`; `remedies` are other things to do, each a text and what acts. */
    answer({ at, verdict, findings, suggestions, error, remedies = [] }) {
        if (!this.at || at.some((x, i) => x !== this.at[i]) || !this.explained) return;
        this.missed = Boolean(error);
        const more = error ? [node("p", { className: "verdict", textContent: error })] : [
            node("p", { className: "verdict", textContent: verdict.text }),
            node("div", { className: "try" }, ...remedies.map(({ text, act }) => this.remedy(text, act)),
                ...suggestions.map(suggestion => this.suggestion(suggestion))),
            node("details", { className: "inner" }, node("summary", { textContent: "What each stage saw" }),
                node("ul", { className: "why" }, ...findings.map(finding))),
        ];
        showPixel(this.element, this.explained, at, null, more);
    }

    suggestion({ parameters, plane_pixels, planes_before, planes_after }) {
        const wanted = Object.entries(parameters);
        const values = wanted.map(([name, value]) => `${name} ${value}`).join(", ");
        const title = `The pixel is then on a plane of ${plane_pixels} pixels; ${planes_after} planes instead of ${planes_before}.`;
        return this.remedy(`Try ${values}`, () => wanted.forEach(([name, value]) => this.ask("set", { name, value })), title);
    }

    /** A button that changes something, after which the pixel is looked at anew. */
    remedy(textContent, act, title = "") {
        const button = node("button", { textContent, title });
        button.onclick = () => {
            this.explained = null;
            act();
        };
        return button;
    }
}

function planeAt(frame, [u, v]) {
    const label = frame.labels[Math.floor(v / frame.step) * frame.width + Math.floor(u / frame.step)];
    return label ? frame.planes[label - 1] : undefined;
}

function finding({ stage, subject, quantities, outcome, refuses }) {
    const parts = quantities.map(({ name, value, unit, limit }) => {
        const words = limit?.kind.replace("_", " ");
        const of = unit === "standard deviations" ? "sd" : unit;
        return `${name} ${value === null ? "–" : Number(value.toPrecision(3))}${of ? ` ${of}` : ""}${words ? ` (${words} ${Number(limit.value.toPrecision(3))})` : ""}`;
    });
    const text = `${stage} · ${subject}: ${[...parts, outcome].filter(Boolean).join(", ")}`;
    return node("li", { textContent: text, className: refuses ? "no" : "" });
}
