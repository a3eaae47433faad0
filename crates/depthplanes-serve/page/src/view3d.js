// The map in space: points in the colours of their planes, outlines, ids, floor, obstacles and free sectors.
//
// The world of this view has y up and -z ahead. Where there is a floor it is y = 0, and the origin lies below the camera.

import {
    BufferAttribute, BufferGeometry, DoubleSide, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial,
    PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { MARKS, css } from "./colours.js";
import { fences } from "./fences.js";
import { fitted, writeId } from "./labels.js";
import { valueAt } from "./message.js";
import { PointCloud } from "./points.js";

const BACKGROUND = 0x0f1216;
/** How far a frame moves the camera's place towards what it says: floors differ by a little from frame to frame. */
const SLOW = 0.25;
const GRID_M = 8;
const LEAST_FOR_ID = 0.004;
/** Metres of the free sectors above the floor, so that they are seen on it. */
const FAN_M = 0.012;

export class View3d {
    /** `remedy` says how to state the camera of a map. */
    constructor(element, remedy) {
        this.remedy = remedy;
        this.stage = element.querySelector(".stage");
        this.hint = element.querySelector(".hint");
        Object.assign(this, { floor: true, obstacles: true, sectors: true, chosen: null, mode: "planes" });
        try {
            this.renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
        } catch {
            return this.say("This browser has no WebGL 2, so the view in space is not shown. All else works without it.");
        }
        this.renderer.setClearColor(BACKGROUND);
        this.labels = Object.assign(document.createElement("canvas"), { className: "overlay" });
        this.stage.prepend(this.renderer.domElement, this.labels);
        this.camera = new PerspectiveCamera(50, 1, 0.02, 200);
        this.controls = new OrbitControls(this.camera, this.renderer.domElement);
        this.controls.addEventListener("change", () => this.wake());
        this.scene = new Scene();
        this.points = new PointCloud();
        this.outlines = lines(0xffffff, { vertexColors: true });
        this.sensor = new Group().add(this.points.object, this.outlines, frustum());
        this.sensor.matrixAutoUpdate = false;
        this.grid = grid();
        this.fences = new Group();
        this.fan = new Group();
        this.scene.add(this.sensor, this.grid, this.fences, this.fan);
        new ResizeObserver(() => this.resize()).observe(this.stage);
        this.renderer.domElement.addEventListener("webglcontextlost", () => this.say("The graphics processor was lost; reload the page for the view in space."));
    }

    say(text) {
        Object.assign(this.hint, { textContent: text, hidden: !text });
    }

    /** Looks from above and behind the camera, from as far as the map is deep. */
    reset() {
        if (!this.renderer || !this.frame) return;
        const [far, height] = [medianDepth(this.frame), this.position?.y ?? 1];
        this.camera.position.set(0.35 * far, height + 0.45 * far, 0.55 * far);
        this.controls.target.set(0, 0.45 * height, -0.85 * far);
        this.controls.update();
        this.wake();
    }

    /** The rays of the frames that follow. */
    setCamera(camera) {
        this.rays = camera.rays;
        if (this.renderer) this.points.setCamera(camera);
    }

    show(frame, anew) {
        if (!this.renderer) return;
        this.frame = frame;
        const metric = frame.camera !== null && frame.unit === "m";
        for (const canvas of [this.renderer.domElement, this.labels]) canvas.hidden = !metric;
        this.say(metric ? "" : `Points in space need the unit of the map and its camera: ${this.remedy}.`);
        this.scene.visible = metric;
        if (metric) {
            this.place(frame.ground, anew);
            if (!this.hasLooked) this.reset();
            this.hasLooked = true;
            this.points.show(frame);
            this.showOutlines(frame);
            this.showGround(frame);
        }
        this.wake();
    }

    redraw() {
        if (this.frame) this.show(this.frame, false);
    }

    /** Puts the sensor where the floor, or else what is up, says. */
    place(ground, anew) {
        const [position, turn] = standing(ground);
        const slow = anew || !this.turn ? 1 : SLOW;
        this.turn = (this.turn ?? turn).slerp(turn, slow);
        this.position = (this.position ?? position).lerp(position, slow);
        this.sensor.matrix.compose(this.position, this.turn, new Vector3(1, 1, 1));
        this.sensor.matrixWorldNeedsUpdate = true;
    }

    showOutlines({ rings, planes, corners_m: corners }) {
        const colours = new Map(planes.map(plane => [plane.label, plane.id === this.chosen ? [255, 255, 255] : plane.colour]));
        const [places, shades] = [[], []];
        let start = 0;
        for (const [label, , count] of rings) {
            const shade = colours.get(label).map(x => (x / 255) ** 2.2);
            for (let at = 0; at < count && Number.isFinite(corners[3 * start]); at++) {
                for (const corner of [start + at, start + (at + 1) % count]) {
                    places.push(corners[3 * corner], corners[3 * corner + 1], corners[3 * corner + 2]);
                    shades.push(...shade);
                }
            }
            start += count;
        }
        refill(this.outlines, places, shades);
    }

    showGround({ ground }) {
        this.grid.visible = this.floor && Boolean(ground?.floor);
        for (const group of [this.fences, this.fan]) {
            group.traverse(object => {
                object.geometry?.dispose();
                object.material?.dispose();
            });
            group.clear();
        }
        if (!ground?.floor) return;
        const free = this.sectors ? ground.sectors.filter(sector => sector.free_m > 0) : [];
        free.forEach(sector => this.fan.add(sectorMesh(sector)));
        const around = this.obstacles ? fences(this.frame, this.rays) : [];
        around.forEach(obstacle => this.fences.add(fence(obstacle)));
    }

    /** Draws once, as soon as the browser draws. */
    wake() {
        if (this.waiting || !this.renderer) return;
        this.waiting = requestAnimationFrame(() => {
            this.waiting = null;
            this.points.setView(this.camera, this.renderer, this.frame, this);
            this.renderer.render(this.scene, this.camera);
            this.writeIds();
        });
    }

    writeIds() {
        const { context, width, height } = fitted(this.labels);
        if (!this.frame || !this.scene.visible) return;
        const least = LEAST_FOR_ID * this.frame.map.width * this.frame.map.height;
        for (const plane of this.frame.planes.toReversed()) {
            const chosen = plane.id === this.chosen;
            if (!plane.centroid_m || (plane.pixel_count < least && !chosen)) continue;
            const point = new Vector3(...this.badgeOf(plane)).applyMatrix4(this.sensor.matrix).project(this.camera);
            if (Math.abs(point.z) > 1) continue;
            writeId(context, String(plane.id), [(point.x + 1) / 2 * width, (1 - point.y) / 2 * height], css(plane.colour), chosen);
        }
    }

    /** Where the id of a plane stands, in the sensor's axes; the centroid where nothing was measured. */
    badgeOf({ id, centroid_m }) {
        const { place } = this.frame.badges.get(id);
        const depth = valueAt(this.frame, place);
        const point = [this.rays[2 * place] * depth, this.rays[2 * place + 1] * depth, depth];
        return point.every(Number.isFinite) ? point : centroid_m;
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.stage;
        if (width === 0 || height === 0) return;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.wake();
    }
}

function medianDepth(frame) {
    const depths = frame.depth.filter((code, at) => at % 97 === 0 && code > 0).sort();
    return depths.length ? frame.low + (depths[depths.length >> 1] - 1) * frame.scale : 2;
}

/** Where the sensor stands in this view's world: position and turn. */
function standing(ground) {
    const [right, up, back] = [new Vector3(), new Vector3(0, -1, 0), new Vector3()];
    const floor = ground?.floor;
    if (floor) {
        right.set(...floor.right);
        up.set(...floor.plane.normal);
        back.set(...floor.ahead).negate();
    } else {
        if (ground?.up) up.set(...ground.up);
        back.set(0, 0, -1).projectOnPlane(up).normalize();
        right.crossVectors(up, back);
    }
    const toWorld = new Matrix4().makeBasis(right, up, back).transpose();
    return [new Vector3(0, floor ? floor.height_m : 1, 0), new Quaternion().setFromRotationMatrix(toWorld)];
}

function lines(color, more = {}) {
    const object = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color, ...more }));
    object.frustumCulled = false;
    return object;
}

function refill(object, places, shades) {
    object.geometry.dispose();
    object.geometry = new BufferGeometry();
    object.geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
    if (shades) object.geometry.setAttribute("color", new BufferAttribute(new Float32Array(shades), 3));
}

/** The camera itself. */
function frustum() {
    const corners = [[-1, -0.75], [1, -0.75], [1, 0.75], [-1, 0.75]].map(([x, y]) => [x * 0.1, y * 0.1, 0.16]);
    const places = corners.flatMap((corner, at) => [0, 0, 0, ...corner, ...corner, ...corners[(at + 1) % 4]]);
    const object = lines(0x9fb3c8);
    refill(object, places);
    return object;
}

/** Lines a metre apart on the floor. */
function grid() {
    const places = [];
    for (let at = -GRID_M; at <= GRID_M; at++) {
        places.push(at, 0, 1, at, 0, -2 * GRID_M);
        places.push(-GRID_M, 0, -(at + GRID_M), GRID_M, 0, -(at + GRID_M));
    }
    const object = lines(0x34404d, { transparent: true, opacity: 0.8 });
    refill(object, places);
    object.visible = false;
    return object;
}

const onFloor = (bearing_deg, distance, height) => {
    const angle = bearing_deg * Math.PI / 180;
    return [distance * Math.sin(angle), height, -distance * Math.cos(angle)];
};

const shade = mark => (MARKS[mark][0] << 16) | (MARKS[mark][1] << 8) | MARKS[mark][2];

/** A free sector; its end is red where something blocks it, and green where no more floor is seen. */
function sectorMesh({ from_deg, to_deg, free_m, is_blocked }) {
    const geometry = new BufferGeometry();
    const corners = [[0, FAN_M, 0], onFloor(from_deg, free_m, FAN_M), onFloor(to_deg, free_m, FAN_M)];
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners.flat()), 3));
    const look = { color: shade(1), transparent: true, opacity: 0.13, depthWrite: false, side: DoubleSide };
    const end = lines(shade(is_blocked ? 2 : 1));
    refill(end, [...corners[1], ...corners[2]]);
    return new Mesh(geometry, new MeshBasicMaterial(look)).add(end);
}

/** An obstacle as a fence along its near side, a drop as one down from its edge. */
function fence({ is_drop, posts }) {
    const look = { color: shade(is_drop ? 4 : 2), transparent: true };
    const [sheet, edges] = [[], []];
    for (let at = 0; at + 1 < posts.length; at++) {
        const [a, b] = [posts[at], posts[at + 1]];
        if (!a || !b) continue;
        const [p, q, r, s] = [[a.x, 0, a.z], [b.x, 0, b.z], [b.x, b.height, b.z], [a.x, a.height, a.z]];
        sheet.push(...p, ...q, ...r, ...p, ...r, ...s);
        edges.push(...p, ...q, ...s, ...r);
        if (!posts[at - 1]) edges.push(...p, ...s);
        if (!posts[at + 2]) edges.push(...q, ...r);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(sheet), 3));
    const drawn = lines(look.color, { transparent: true, opacity: 0.6 });
    refill(drawn, edges);
    return new Mesh(geometry, new MeshBasicMaterial({ ...look, opacity: 0.13, depthWrite: false, side: DoubleSide })).add(drawn);
}
