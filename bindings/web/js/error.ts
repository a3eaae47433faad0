/** Something was wrong with what was given; the message says what is accepted. */
export class InputError extends Error {
    override name = "InputError";
}
