// What is stated of maps, and of how planes are looked for. The names are the program's, with `_` for `-`.

import type { MethodName } from "./tables.js";

/** What is stated of a map beside its numbers. */
export interface Reading {
    /** A known sensor, such as `"kinect1"`: its unit, its nominal camera and its noise. `sensors()` lists them. */
    sensor?: string;
    /** fx, fy, cx, cy in pixels, or what stands in a camera file of ROS, OpenCV, RealSense, COLMAP, KITTI and others. Without a
     * camera planes have labels and no metres. */
    camera?: readonly [number, number, number, number] | string;
    /** What the numbers mean, such as `"mm"`, `"m"`, `"tum"`, `"disparity"`; `tables().units` lists them. Without it 16-bit numbers
     * are millimetres, floats metres, and 8-bit numbers grey levels without a unit. */
    unit?: string;
    /** Columns and rows of the picture that the camera is for. */
    camera_size?: readonly [number, number];
    /** Whether lens distortion is ignored. */
    rectified?: boolean;
    /** Map units per metre. */
    scale?: number;
    /** Metres per map unit. */
    depth_scale?: number;
    /** The numbers are distances along the rays. */
    ray_distance?: boolean;
    /** The numbers are disparities. */
    disparity?: boolean;
    /** Focal length of a stereo rig, pixels. */
    focal?: number;
    /** Baseline of a stereo rig, metres. */
    baseline?: number;
    /** Difference of the principal points of a stereo rig, pixels. */
    doffs?: number;
    /** A number that means "not measured", beside 0, NaN and infinity. */
    missing?: number;
    /** Smallest and largest valid number, map units. */
    valid_range?: readonly [number, number];
    /** The noise of depth: rows of range and standard deviation, metres. */
    noise_table?: readonly (readonly [number, number])[];
    /** The two bytes of 16-bit numbers are swapped. */
    swap_bytes?: boolean;
    /** Which file of an archive (NPZ). */
    member?: string;
    /** Columns and rows of a file without a header. */
    raw_size?: readonly [number, number];
    /** Type of the numbers of a file without a header, in NumPy's words. */
    raw_type?: string;
}

/** Names of the methods' parameters. `methods()` says which method has which, with defaults and ranges. */
export type ParameterName =
    | "angle" | "block" | "continuity" | "delta" | "distance" | "draws" | "eps" | "epsilon" | "inlier_threshold" | "lateral_noise"
    | "margin" | "max_rms" | "min_area" | "min_fill" | "min_pixels" | "misses" | "noise" | "noise_growth" | "noise_scale"
    | "overlooked" | "passes" | "radius" | "reach" | "seed" | "smooth_noise" | "smooth_noise_growth" | "spacing" | "theta"
    | "theta_gradient" | "votes" | "window";

/** Parameters of the method. */
export type Parameters = { [Name in ParameterName]?: number };

/** How planes are looked for. */
export interface Search extends Parameters {
    /** `"planar"`, which needs no parameter, or another of `methods()`. */
    method?: MethodName;
    /** Whether curved surfaces are wanted as well. */
    curved?: boolean;
    /** Degrees and metres within which pieces of one plane are joined. */
    merge_coplanar?: readonly [number, number];
}

export interface DetectorOptions extends Reading, Search {}
