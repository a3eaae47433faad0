/** The head of a message, with its arrays as members. */
export function decode(buffer: ArrayBuffer): any;
