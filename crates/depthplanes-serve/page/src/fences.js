// Where the near side of each obstacle runs, from the pixels that are marked as such.

import { valueAt } from "./message.js";

const OBSTACLE = 2;
const DROP = 4;
/** Columns of the picture for each post of a fence, at most, and rows that are looked at. */
const COLUMNS = 48;
const ROWS = 64;
/** What is nearer than the obstacle is another's. */
const NEARER = 0.97;
/** Neighbouring posts whose distances differ by more are not joined. */
const JOINED = 1.15;

/** For each obstacle its posts from left to right, in the world of the view in space; null where it is interrupted. */
export function fences(frame, rays) {
    const { floor, obstacles } = frame.ground;
    if (!rays || !frame.marks || rays.length !== 2 * frame.depth.length) return [];
    return obstacles.map(obstacle => ({ is_drop: obstacle.is_drop, posts: postsOf(obstacle, frame, rays, floor) }));
}

function postsOf({ is_drop, distance_m, bounding_box }, frame, rays, floor) {
    const [left, top, right, bottom] = ["u_min", "v_min", "u_max", "v_max"].map(side => Math.floor(bounding_box[side] / frame.step));
    const [across, down] = [stride(left, right, COLUMNS), stride(top, bottom, ROWS)];
    const mark = is_drop ? DROP : OBSTACLE;
    const posts = [];
    for (let u = left; u <= right; u += across) {
        let post = null;
        let height = 0;
        for (let v = top; v <= bottom; v += down) {
            const at = v * frame.width + u;
            if (frame.marks[at] !== mark) continue;
            const spot = placeOf(frame, rays, floor, at);
            if (!spot || spot.distance < NEARER * distance_m) continue;
            if (!post || spot.distance < post.distance) post = spot;
        }
        for (let v = top; post && v <= bottom; v += down) {
            const at = v * frame.width + u;
            const spot = frame.marks[at] === mark && placeOf(frame, rays, floor, at);
            if (spot && spot.distance < JOINED * post.distance && Math.abs(spot.height) > Math.abs(height)) height = spot.height;
        }
        const before = posts.at(-1);
        const isApart = post && before && Math.max(post.distance, before.distance) > JOINED * Math.min(post.distance, before.distance);
        if (isApart) posts.push(null);
        posts.push(post && { ...post, height });
    }
    return posts;
}

const stride = (from, to, most) => Math.max(1, Math.ceil((to - from + 1) / most));

/** Where a pixel is from the floor: x to the right, z behind the camera, its distance along the floor and its height. */
function placeOf(frame, rays, floor, at) {
    const depth = valueAt(frame, at);
    const point = [rays[2 * at] * depth, rays[2 * at + 1] * depth, depth];
    if (!Number.isFinite(point[0])) return null;
    const dot = axis => axis[0] * point[0] + axis[1] * point[1] + axis[2] * point[2];
    const [x, ahead] = [dot(floor.right), dot(floor.ahead)];
    return { x, z: -ahead, distance: Math.hypot(x, ahead), height: dot(floor.plane.normal) + floor.plane.distance };
}
