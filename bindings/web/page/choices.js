// What is stated of the map, and the method.

import { node } from "../../../crates/depthplanes-serve/page/src/sliders.js";

export class Choices {
    /** `want` takes what is chosen, `fail` is told why a file was not read. */
    constructor(element, want, fail) {
        const of = id => element.querySelector(`#${id}`);
        Object.assign(this, { want, method: of("method"), sensor: of("sensor"), unit: of("unit"), camera: of("camera"), rawSize: of("raw-size") });
        this.names = new Map(); // of camera files, by their texts
        this.method.onchange = () => want({ method: this.method.value, parameters: {} });
        for (const name of ["sensor", "unit"]) this[name].onchange = () => this.read({ [name]: this[name].value || undefined });
        this.camera.onchange = () => this.read({ camera: numbers(this.camera.value) });
        this.rawSize.onchange = () => this.read({ raw_size: numbers(this.rawSize.value) });
        const file = of("camera-file");
        of("camera-open").onclick = () => file.click();
        file.onchange = async () => {
            const [chosen] = file.files;
            file.value = "";
            try {
                if (!chosen) return;
                const camera = await chosen.text();
                this.names.set(camera, chosen.name);
                this.read({ camera });
            } catch (error) {
                fail(`${chosen.name}: ${error.message}`);
            }
        };
    }

    /** Fills the lists. */
    make({ methods, sensors, units }) {
        const options = (rows, none) => [
            ...(none ? [node("option", { value: "", textContent: none })] : []),
            ...rows.map(({ name, about }) => node("option", { value: name, textContent: name, title: about })),
        ];
        this.method.replaceChildren(...options(methods));
        this.sensor.replaceChildren(...options(sensors, "not stated"));
        this.unit.replaceChildren(...options(units, "as the numbers look"));
    }

    /** States something else of the map. */
    read(change) {
        this.want(({ reading }) => ({ reading: { ...reading, ...change } }));
    }

    /** Shows what counts now. */
    show(state) {
        this.state = state;
        const { reading, method } = state;
        this.method.value = method;
        this.sensor.value = reading.sensor ?? "";
        this.unit.value = reading.unit ?? "";
        const { camera } = reading;
        this.camera.value = this.names.get(camera) ?? camera?.join(", ") ?? "";
        this.rawSize.value = reading.raw_size?.join(" × ") ?? "";
    }
}

/** Numbers of a text; words that are none stay, so that it is said what they are. */
function numbers(text) {
    const words = text.split(/[\s,;x×]+/).filter(Boolean);
    return words.length ? words.map(word => Number.isFinite(Number(word)) ? Number(word) : word) : undefined;
}
