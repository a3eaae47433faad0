// The map as a picture, with planes or the ground over it, outlines and ids.

import { badgesOf } from "./badges.js";
import { MARKS, Range, css, grey, viridis } from "./colours.js";
import { fitted, writeId } from "./labels.js";

/** Fewer pixels of a plane than this share of the picture get no id. */
const LEAST_FOR_ID = 0.004;
/** Colour of curved surfaces, and pixels of the picture from one of their stripes to the next: a power of two. */
const CURVED = [214, 160, 255];
const STRIPES_PX = 8;

export class View2d {
    /** `pick` is told the pixel of the map that is clicked. */
    constructor(element, pick) {
        this.stage = element.querySelector(".stage");
        this.picture = element.querySelector(".picture");
        this.drawing = element.querySelector(".drawing");
        this.scale = element.querySelector(".scale");
        Object.assign(this, { mode: "planes", opacity: 0.55, outlines: true, ids: true, chosen: null, at: null });
        this.range = new Range();
        new ResizeObserver(() => this.redraw()).observe(this.stage);
        this.drawing.addEventListener("click", event => {
            const pixel = this.pixel(event);
            if (pixel) pick(pixel);
        });
    }

    /** Shows a frame; `anew` where it has nothing to do with the one before. */
    show(frame, anew) {
        frame.badges = badgesOf(frame, anew ? undefined : this.frame?.badges);
        this.frame = frame;
        this.range.follow(frame, anew);
        this.redraw();
    }

    redraw() {
        if (!this.frame) return;
        this.paint(this.frame);
        this.draw(this.frame);
        this.drawScale(this.frame);
    }

    /** Where the picture lies on the stage: left, top, and pixels of the page for one of the map. */
    place() {
        const { width, height } = this.frame.map;
        const zoom = Math.min(this.stage.clientWidth / width, this.stage.clientHeight / height);
        return { left: (this.stage.clientWidth - zoom * width) / 2, top: (this.stage.clientHeight - zoom * height) / 2, zoom };
    }

    pixel({ offsetX, offsetY }) {
        if (!this.frame) return null;
        const { left, top, zoom } = this.place();
        const [u, v] = [Math.floor((offsetX - left) / zoom), Math.floor((offsetY - top) / zoom)];
        const { width, height } = this.frame.map;
        return u >= 0 && v >= 0 && u < width && v < height ? [u, v] : null;
    }

    paint(frame) {
        const { width, height, depth, labels, marks } = frame;
        if (this.picture.width !== width || this.picture.height !== height) Object.assign(this.picture, { width, height });
        const context = this.picture.getContext("2d");
        const image = context.createImageData(width, height);
        const pixels = new Uint32Array(image.data.buffer);
        const table = this.range.table(frame, this.mode === "depth" ? viridis : grey);
        const over = this.mode === "ground" ? marks : labels;
        const curved = this.mode === "planes" && frame.curved;
        const stripe = CURVED.map(x => x * Math.round(256 * this.opacity));
        const colours = this.mode === "ground" ? MARKS : [null, ...frame.planes.map(plane => plane.colour)];
        const share = Math.round(256 * (this.mode === "depth" ? 0 : this.opacity));
        if (!over || share === 0) {
            for (let at = 0; at < pixels.length; at++) pixels[at] = table[depth[at]];
        } else {
            const tinted = colours.map(colour => colour && colour.map(x => x * share));
            const rest = 256 - share;
            for (let at = 0; at < pixels.length; at++) {
                const below = table[depth[at]];
                const above = tinted[over[at]] ?? (curved && curved[at] && isStripe(at, frame.width) ? stripe : null);
                pixels[at] = above
                    ? 0xff000000 | (((below >>> 16 & 255) * rest + above[2]) & 0xff00) << 8
                        | ((below >>> 8 & 255) * rest + above[1]) & 0xff00 | ((below & 255) * rest + above[0]) >>> 8
                    : below;
            }
        }
        context.putImageData(image, 0, 0);
        const { left, top, zoom } = this.place();
        Object.assign(this.picture.style, {
            left: `${left}px`, top: `${top}px`, width: `${zoom * frame.map.width}px`, height: `${zoom * frame.map.height}px`,
        });
    }

    draw(frame) {
        const { context } = fitted(this.drawing);
        const { left, top, zoom } = this.place();
        const spot = (u, v) => [left + (u + 0.5) * zoom, top + (v + 0.5) * zoom];
        const planes = new Map(frame.planes.map(plane => [plane.label, plane]));
        if (this.outlines || this.chosen !== null) this.drawOutlines(context, frame, planes, spot);
        if (this.ids) {
            const least = LEAST_FOR_ID * frame.map.width * frame.map.height;
            for (const plane of frame.planes.toReversed()) {
                const chosen = plane.id === this.chosen;
                if (plane.pixel_count >= least || chosen) {
                    writeId(context, String(plane.id), spot(...placeOf(frame, plane)), css(plane.colour), chosen);
                }
            }
        }
        if (this.at) {
            const [x, y] = spot(...this.at);
            for (const [width, colour] of [[4, "#0f1216"], [2, "#ffffff"]]) {
                context.beginPath();
                context.arc(x, y, 6, 0, 2 * Math.PI);
                context.lineWidth = width;
                context.strokeStyle = colour;
                context.stroke();
            }
        }
    }

    drawOutlines(context, frame, planes, spot) {
        let start = 0;
        for (const [label, , corners] of frame.rings) {
            const plane = planes.get(label);
            const chosen = plane.id === this.chosen;
            if (this.outlines || chosen) {
                context.beginPath();
                for (let corner = start; corner < start + corners; corner++) {
                    const [x, y] = spot(frame.corners_px[2 * corner], frame.corners_px[2 * corner + 1]);
                    corner === start ? context.moveTo(x, y) : context.lineTo(x, y);
                }
                context.closePath();
                context.lineWidth = chosen ? 3 : 1.25;
                context.strokeStyle = chosen ? "#ffffff" : css(plane.colour);
                context.stroke();
            }
            start += corners;
        }
    }

    drawScale(frame) {
        const { near, far } = this.range;
        this.scale.hidden = this.mode !== "depth" || near === undefined;
        if (this.scale.hidden) return;
        const bar = Object.assign(document.createElement("canvas"), { width: 128, height: 10 });
        const context = bar.getContext("2d");
        for (let x = 0; x < 128; x++) {
            context.fillStyle = css(viridis(1 - x / 127));
            context.fillRect(x, 0, 1, 10);
        }
        const [first, last] = frame.unit === "m" ? [near, far] : [far, near];
        const text = value => frame.unit === "m" ? `${value.toFixed(2)} m` : value.toPrecision(3);
        this.scale.replaceChildren(text(first), bar, text(last));
    }
}

/** Whether a pixel lies on a stripe of the hatching. */
const isStripe = (at, width) => (at % width + Math.floor(at / width) & STRIPES_PX - 1) < STRIPES_PX / 2;

/** The pixel of the map at which the id of a plane stands. */
function placeOf(frame, { id }) {
    const { place } = frame.badges.get(id);
    return [place % frame.width * frame.step, Math.floor(place / frame.width) * frame.step];
}
