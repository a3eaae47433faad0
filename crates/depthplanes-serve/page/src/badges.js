// Where the id of a plane is written: at the pixel of it that lies farthest from its border.

/** Samples along the longer side of the picture; more would move no id by more than itself. */
const SAMPLES = 160;
/** An id stays where it was in the frame before while it lies at least so deep in its plane, against the deepest place. */
const DEEP_ENOUGH = 0.7;
/** Distances to neighbours aside and across, in thirds. */
const [ASIDE, ACROSS] = [3, 4];

/** For each label that has one: the place in the picture, as an index, and how deep it lies. `before` has those of the last frame,
 * by the planes' ids. */
export function badgesOf(frame, before = new Map()) {
    const { labels, width, planes } = frame;
    const stride = Math.max(1, Math.ceil(Math.max(width, frame.height) / SAMPLES));
    const columns = Math.ceil(width / stride);
    const rows = Math.ceil(frame.height / stride);
    const placeOf = at => Math.floor(at / columns) * stride * width + at % columns * stride;
    const samples = Uint16Array.from({ length: columns * rows }, (_, at) => labels[placeOf(at)]);
    const depths = depthsOf(samples, columns, rows);
    const deepest = new Map();
    samples.forEach((label, at) => {
        if (label && depths[at] > (deepest.get(label)?.depth ?? 0)) deepest.set(label, { place: placeOf(at), sample: at, depth: depths[at] });
    });
    const badges = new Map();
    for (const { id, label } of planes) {
        const best = deepest.get(label) ?? { place: Math.max(0, labels.indexOf(label)), sample: -1, depth: 0 };
        const last = before.get(id);
        const stays = last && samples[last.sample] === label && depths[last.sample] >= DEEP_ENOUGH * best.depth;
        badges.set(id, stays ? last : best);
    }
    return badges;
}

/** How far each sample is from the nearest of another label, or from the edge of the picture: a chamfer distance, in thirds. */
function depthsOf(samples, columns, rows) {
    const depths = new Int32Array(samples.length);
    const least = (u, v, neighbours, most) => neighbours.reduce((found, [du, dv, step]) => {
        const [x, y] = [u + du, v + dv];
        const isIn = x >= 0 && y >= 0 && x < columns && y < rows && samples[y * columns + x] === samples[v * columns + u];
        return Math.min(found, step + (isIn ? depths[y * columns + x] : 0));
    }, most);
    const above = [[-1, 0, ASIDE], [-1, -1, ACROSS], [0, -1, ASIDE], [1, -1, ACROSS]];
    const below = above.map(([du, dv, step]) => [-du, -dv, step]);
    for (let at = 0; at < samples.length; at++) depths[at] = least(at % columns, Math.floor(at / columns), above, Infinity);
    for (let at = samples.length - 1; at >= 0; at--) depths[at] = least(at % columns, Math.floor(at / columns), below, depths[at]);
    return depths;
}
