// The pixels of a map as points, made on the graphics processor from depth and the camera's rays.

import {
    BufferAttribute, BufferGeometry, DataTexture, GLSL3, NearestFilter, Points, RedIntegerFormat, ShaderMaterial, Sphere,
    UnsignedByteType, UnsignedShortType,
} from "three";
import { MARKS } from "./colours.js";

const PALETTE = 4096;

const VERTEX = `
precision highp usampler2D;
uniform usampler2D depth, labels, marks;
uniform sampler2D palette;
uniform int columns, chosen;
uniform bool byMarks;
uniform float low, scale, spacing, magnification, near, far;
out vec3 shade;

const vec3 MARK[3] = vec3[3](${[1, 2, 4].map(mark => `vec3(${MARKS[mark].map(x => (x / 255).toFixed(3))})`)});

void main() {
    ivec2 at = ivec2(gl_VertexID % columns, gl_VertexID / columns);
    uint code = texelFetch(depth, at, 0).r;
    vec2 ray = position.xy;
    if (code == 0u || !(abs(ray.x) < 100.0 && abs(ray.y) < 100.0)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        gl_PointSize = 0.0;
        return;
    }
    float z = low + float(code - 1u) * scale;
    vec4 seen = modelViewMatrix * vec4(ray * z, z, 1.0);
    gl_Position = projectionMatrix * seen;
    gl_PointSize = clamp(1.35 * z * spacing * magnification / max(-seen.z, 0.05), 1.0, 14.0);
    float share = clamp((far - z) / max(far - near, 0.001), 0.0, 1.0);
    vec3 grey = vec3(0.16 + 0.3 * share);
    int label = int(texelFetch(labels, at, 0).r);
    uint mark = byMarks ? texelFetch(marks, at, 0).r : 0u;
    float light = 0.55 + 0.45 * share;
    if (byMarks) shade = mark == 1u ? MARK[0] * light : mark == 2u ? MARK[1] * light : mark == 4u ? MARK[2] * light : grey;
    else shade = label == 0 ? grey : texelFetch(palette, ivec2(min(label, ${PALETTE - 1}), 0), 0).rgb * light;
    if (chosen > 0) shade = label == chosen ? mix(shade, vec3(1.0), 0.25) : shade * 0.55;
}`;

const FRAGMENT = `
in vec3 shade;
out vec4 colour;
void main() { colour = vec4(shade, 1.0); }`;

export class PointCloud {
    constructor() {
        const names = ["depth", "labels", "marks", "palette", "columns", "chosen", "byMarks", "low", "scale", "spacing", "magnification", "near", "far"];
        this.uniforms = Object.fromEntries(names.map(name => [name, { value: 0 }]));
        const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.uniforms });
        this.object = new Points(new BufferGeometry(), material);
        this.object.visible = false;
        this.object.frustumCulled = false;
        this.uniforms.palette.value = new DataTexture(new Uint8Array(4 * PALETTE), PALETTE, 1);
        this.textures = {};
        this.uniforms.marks.value = this.texture("marks", new Uint8Array(1), 1, 1, "R8UI", UnsignedByteType);
    }

    setCamera({ rays, spacing, width, height }) {
        this.object.geometry.dispose();
        this.object.geometry = new BufferGeometry();
        this.object.geometry.setAttribute("position", new BufferAttribute(rays, 2));
        this.object.geometry.boundingSphere = new Sphere(); // rays are no points: there is nothing to work out
        Object.assign(this, { width, height });
        this.uniforms.spacing.value = spacing;
    }

    show(frame) {
        const { width, height, uniforms } = { ...frame, uniforms: this.uniforms };
        this.object.visible = width === this.width && height === this.height;
        uniforms.depth.value = this.texture("depth", frame.depth, width, height, "R16UI", UnsignedShortType);
        uniforms.labels.value = this.texture("labels", frame.labels, width, height, "R16UI", UnsignedShortType);
        if (frame.marks) uniforms.marks.value = this.texture("marks", frame.marks, width, height, "R8UI", UnsignedByteType);
        Object.assign(uniforms.columns, { value: width });
        [uniforms.low.value, uniforms.scale.value] = [frame.low, frame.scale];
        const depths = frame.planes.map(plane => plane.depth_m).filter(Number.isFinite);
        [uniforms.near.value, uniforms.far.value] = [0.3, Math.max(2, ...depths) * 1.3];
        const palette = uniforms.palette.value;
        frame.planes.slice(0, PALETTE - 1).forEach((plane, at) => palette.image.data.set([...plane.colour, 255], 4 * (at + 1)));
        palette.needsUpdate = true;
    }

    /** What the view looks like now. */
    setView(camera, renderer, frame, { chosen, mode }) {
        const { uniforms } = this;
        const height = renderer.domElement.height;
        uniforms.magnification.value = height / 2 / Math.tan(camera.fov * Math.PI / 360);
        uniforms.chosen.value = frame?.planes.find(plane => plane.id === chosen)?.label ?? 0;
        uniforms.byMarks.value = mode === "ground" && Boolean(frame?.marks);
    }

    /** The texture of that name with new numbers; made anew where its size has changed. */
    texture(name, numbers, width, height, internalFormat, type) {
        let texture = this.textures[name];
        if (texture?.image.width !== width || texture?.image.height !== height) {
            texture?.dispose();
            texture = new DataTexture(numbers, width, height, RedIntegerFormat, type);
            Object.assign(texture, { internalFormat, minFilter: NearestFilter, magFilter: NearestFilter, unpackAlignment: 1 });
            this.textures[name] = texture;
        }
        texture.image.data = numbers;
        texture.needsUpdate = true;
        return texture;
    }
}
