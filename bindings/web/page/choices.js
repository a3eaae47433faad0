// What is stated of the map, and the method.

import { facts } from "../../../crates/depthplanes-serve/page/src/panels.js";
import { node } from "../../../crates/depthplanes-serve/page/src/sliders.js";
import { fieldOf } from "../js/words.ts";
import { moreFields, numbers } from "./fields.js";
import { contentOf } from "./opened.js";

export class Choices {
    /** `want` takes how planes are looked for, `wantMap` what is stated of the map, `giveUp()` is that a map that was refused is not
     * wanted any more, `check(camera)` fails unless a text states a camera, and `openCamera` takes a camera file. */
    constructor(element, { want, wantMap, giveUp, check, openCamera }) {
        const of = id => element.querySelector(`#${id}`);
        Object.assign(this, { wantMap, check, method: of("method"), curved: of("curved"), inUse: of("in-use"), refused: of("refused"), carried: of("carried") });
        this.names = new Map(); // of camera files, by their texts
        this.method.onchange = () => want({ method: this.method.value, parameters: {} });
        this.curved.onchange = () => want({ curved: this.curved.checked });
        of("give-up").onclick = giveUp;
        of("clear-carried").onclick = () => this.read(Object.fromEntries(this.state.carried.map(name => [name, undefined])));
        const read = change => this.read(change);
        const field = (option, id, valueOf, show) => {
            of(id).onchange = () => read({ [option]: valueOf(of(id).value) });
            return { option, field: of(id), show: reading => of(id).value = show(reading[option]) };
        };
        const text = value => value ?? "";
        this.fields = [
            field("sensor", "sensor", value => value || undefined, text),
            field("unit", "unit", value => value || undefined, text),
            field("camera", "camera", numbers, camera => this.names.get(camera) ?? camera?.join(", ") ?? ""),
            field("raw_size", "raw-size", numbers, size => size?.join(" × ") ?? ""),
            ...moreFields(of("more"), read),
        ];
        const file = of("camera-file");
        of("camera-open").onclick = () => file.click();
        file.onchange = () => {
            const [chosen] = file.files;
            file.value = "";
            if (chosen) openCamera(chosen);
        };
    }

    /** What a camera file states; fails with its name and with words. */
    async cameraOf(file) {
        const camera = await contentOf(file, "text");
        await this.check(camera).catch(error => {
            throw new Error(`${file.name}: ${error.message}`);
        });
        this.names.set(camera, file.name);
        return { camera };
    }

    /** Fills the lists. */
    make({ methods, sensors, units }) {
        const options = (rows, none) => [
            ...(none ? [node("option", { value: "", textContent: none })] : []),
            ...rows.map(({ name, about }) => node("option", { value: name, textContent: name, title: about })),
        ];
        this.method.replaceChildren(...options(methods));
        const [sensor, unit] = this.fields;
        sensor.field.replaceChildren(...options(sensors, "not stated"));
        unit.field.replaceChildren(...options(units, "as the numbers look"));
        this.curvedMethods = new Set(methods.filter(({ curved }) => curved).map(({ name }) => name));
    }

    /** States something else of the map. */
    read(change) {
        this.wantMap(({ reading, carried }) => ({ reading: { ...reading, ...change }, carried: carried.filter(name => !(name in change)) }));
    }

    /** Shows what counts now: what is stated of the map that is shown, or of one that was refused. */
    show(state, isRefused) {
        this.state = state;
        const { reading, method, carried } = state;
        this.method.value = method;
        Object.assign(this.curved, { checked: state.curved && this.curvedMethods.has(method), disabled: !this.curvedMethods.has(method) });
        for (const { option, field, show } of this.fields) {
            show(reading);
            field.classList.toggle("carried", carried.includes(option));
        }
        this.refused.hidden = !isRefused;
        this.refused.querySelector("span").textContent = `${state.map.file ?? state.map.scene} was not read with what is stated here. What you change is tried at once. `;
        this.carried.hidden = carried.length === 0;
        this.carried.querySelector("span").textContent = `Stated for the map before: ${carried.map(fieldOf).join(", ")}. `;
    }

    /** Shows which unit and camera a frame was read with, and who said so. */
    showInUse({ known: { unit, why_unit: why, camera } }, { map, reading }) {
        const numbers = camera?.map(x => Number(x.toFixed(2))).join(", ");
        const row = (value, origin) => [value, node("small", { textContent: ` ${map.scene ? "of the scene" : origin}` })];
        const ofSensor = `of the sensor ${reading.sensor}`;
        this.inUse.replaceChildren(facts([
            ["Unit in use", row(unit, { stated: "as stated", preset: ofSensor }[why] ?? why)],
            ["Camera in use", numbers ? row(numbers, this.originOf(reading) ?? (reading.sensor ? ofSensor : "of the file")) : "none, so there are no metres"],
        ]));
    }

    /** Who states the camera, if it is stated. */
    originOf({ camera }) {
        if (camera === undefined) return undefined;
        return this.names.has(camera) ? `of ${this.names.get(camera)}` : "as stated";
    }
}
