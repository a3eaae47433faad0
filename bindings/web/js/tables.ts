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

/** A method with its parameters. */
export interface Method extends Row {
    stages: string[];
    parameters: Parameter[];
}

/** A format or an output, with the ends of its files' names. */
export interface FileRow extends Row {
    extensions: string[];
}

/** All tables. */
export interface Tables {
    version: string;
    methods: Method[];
    sensors: Row[];
    units: Row[];
    formats: FileRow[];
    outputs: FileRow[];
    scenes: Row[];
    scene_sensors: Row[];
}
