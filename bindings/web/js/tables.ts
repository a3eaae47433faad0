// The library's tables as JavaScript has them.

/** A row: a name that is accepted, and one sentence. */
export interface Row {
    name: string;
    about: string;
}

/** A parameter of a method. */
export interface Parameter {
    name: string;
    default: number;
    /** The smallest value accepted. */
    min: number;
    /** The largest; `null` for no end. */
    max: number | null;
    /** Which values between them: any, whole numbers, odd numbers and 0. */
    kind: "real" | "whole" | "odd";
    unit: string;
    meaning: string;
    /** The values accepted, in words. */
    accepted: string;
}

/** Names of the methods; the first is the default. */
export type MethodName = "planar" | "ngaf" | "ransac" | "ppdfdm" | "fpdidm" | "hough" | "normals" | "mdl" | "gradient";

/** A method with its parameters. */
export interface Method extends Row {
    name: MethodName;
    /** Whether it tells curved surfaces from planes. */
    curved: boolean;
    stages: string[];
    parameters: Parameter[];
}

/** A format, with the ends of its files' names. */
export interface FileRow extends Row {
    extensions: string[];
}

/** What there is of planes to write. */
export type OutputName = "labels" | "overlay" | "planes" | "cloud" | "mesh" | "curved-labels";

/** In which forms it can be written: the ends of files' names. */
export type Extension = "png" | "npy" | "json" | "csv" | "geojson" | "coco.json" | "ply";

/** An output, with its forms. */
export interface Output extends Row {
    name: OutputName;
    extensions: Extension[];
}

/** All tables. */
export interface Tables {
    version: string;
    methods: Method[];
    sensors: Row[];
    units: Row[];
    formats: FileRow[];
    outputs: Output[];
    scenes: Row[];
    scene_sensors: Row[];
}
