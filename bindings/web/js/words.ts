// The program's messages in words of JavaScript: its flags are options of the package, and fields of the page.

/** Flags whose option has another name. The others differ in spelling alone: `--raw-size` is `raw_size`. */
const OTHERS: Record<string, string> = { preset: "sensor", encoding: "unit", intrinsics: "camera" };

/** Phrases that speak of the program, as they are before its flags are translated. */
const PHRASES: readonly (readonly [RegExp, string])[] = [
    [/see `detect --curved`/g, "--curved labels it"],
    [/ \(cargo install [^)]*\)/g, ""],
    [/`depthplanes encodings` lists them/g, "the list of --encoding has them"],
    [/--intrinsics fx,fy,cx,cy, --camera FILE or --preset SENSOR/g, "--camera or --preset"],
    [/--intrinsics(?:,| and) --camera\b(?!-)/g, "--camera"],
    [/(--[a-z-]+) (?:WIDTHxHEIGHT|WxH)\b/g, "$1"],
    [/--rectified=no/g, "--rectified=false"],
];

const FLAG = /--([a-z]+(?:-[a-z]+)*)(?:=(?=\S))?/g;

function translated(text: string, spell: (option: string) => string): string {
    const plain = PHRASES.reduce((said, [phrase, other]) => said.replace(phrase, other), text);
    return plain.replace(FLAG, (flag, name: string) => {
        const option = spell(OTHERS[name] ?? name.replaceAll("-", "_"));
        return flag.endsWith("=") ? `${option} ` : option;
    });
}

/** What a field of the page is called. */
export function fieldOf(option: string): string {
    return option[0]!.toUpperCase() + option.slice(1).replaceAll("_", " ");
}

/** A message of the program with the names of this package's options. */
export function inOptions(text: string): string {
    return translated(text, option => `\`${option}\``).replace(/parameter `[^`]+`/g, name => name.replaceAll("-", "_"));
}

/** A message of the program with the names of the page's fields. */
export function inFields(text: string): string {
    return translated(text, option => `“${fieldOf(option)}”`);
}
