// Results: the documents of the program, with their names. docs/planes-schema.md describes each field.

/** A plane in metres; x right, y down, z forward. */
export interface Metric {
    /** Unit normal, towards the camera. */
    normal: [number, number, number];
    /** Of the camera from the plane, perpendicular: normal . point + distance_m = 0. */
    distance_m: number;
    rms_m: number;
    centroid_m: [number, number, number];
    area_m2: number | null;
    /** 4 x 4, row by row, of (normal, distance_m). */
    covariance: number[][];
    covariance_from: "noise" | "residuals";
}

/** A plane. */
export interface Plane {
    /** Its value in the label image, from 1. */
    label: number;
    pixel_count: number;
    share_of_valid: number;
    /** All inclusive. */
    bounding_box: { u_min: number; v_min: number; u_max: number; v_max: number };
    /** Column and row. */
    centroid_px: [number, number];
    /** In map units: value = gradient[0] u + gradient[1] v + offset. */
    fit: { gradient: [number, number]; offset: number; rms: number } | null;
    /** `null` without camera and unit. */
    metric: Metric | null;
    /** What was joined, with `merge_coplanar`. */
    parts?: Plane[];
}

/** The document of `depthplanes detect --json`. */
export interface PlanesRecord {
    schema: "depthplanes.planes/1";
    source: string;
    encoding: string;
    width: number;
    height: number;
    method: string;
    parameters: Record<string, number>;
    valid_pixels: number;
    labelled_share: number;
    /** What a person should know of the map and of the result. */
    warnings: string[];
    planes: Plane[];
    [field: string]: unknown;
}

/** What a stage saw at a pixel. */
export interface Finding {
    stage: string;
    subject: string;
    quantities: {
        name: string;
        value: number | null;
        unit: string;
        limit?: { kind: "at_most" | "at_least" | "more_than"; value: number; holds: boolean };
    }[];
    outcome: string;
    refuses: boolean;
}

/** The document of `depthplanes explain --json`. */
export interface Explanation {
    schema: "depthplanes.explain/1";
    source: string;
    method: string;
    parameters: Record<string, number>;
    at: [number, number];
    findings: Finding[];
    verdict: { kind: string; text: string };
    /** Parameters that give the pixel a plane; each was tried. */
    suggestions: { parameters: Record<string, number>; plane_pixels: number; planes_before: number; planes_after: number }[];
}
