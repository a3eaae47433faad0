// The parameters of the method, each with a slider and a field. What is moved here acts at once.

/** Steps of a slider. */
const STEPS = 1000;
/** Ranges up to this are spread evenly over the slider, larger ones by ratio. */
const EVEN = 50;

export class Sliders {
    /** `set(name, value)` takes what is chosen, `reset()` that all go back. */
    constructor(element, set, reset) {
        Object.assign(this, { element, set, reset });
    }

    /** Makes the rows; `parameters` is the method's table. */
    make(parameters) {
        this.rows = parameters.map((parameter, at) => this.row(parameter, at));
        const button = node("button", { id: "reset-all", textContent: "Reset all" });
        button.onclick = () => this.reset();
        this.element.replaceChildren(...this.rows.map(row => row.element), button);
    }

    row(parameter, at) {
        const { name, unit, accepted, meaning } = parameter;
        const scale = scaleOf(parameter);
        const title = `${meaning}\nAccepted: ${accepted}. Default: ${parameter.default}.`;
        const range = node("input", { type: "range", min: 0, max: STEPS, step: 1, ariaLabel: name });
        const number = node("input", { type: "number", step: "any", min: parameter.min, ariaLabel: `${name}, ${unit}` });
        if (parameter.max !== null) number.max = parameter.max;
        const label = node("span", { className: "name", title }, `${name} `, node("small", { textContent: unit }));
        const limits = node("span", { className: "limits", title, textContent: `default ${written(parameter.default)}` });
        const element = node("div", { className: "parameter" }, label, number, range, limits);
        element.dataset.name = name;
        range.oninput = () => this.set(name, scale.value(range.value / STEPS));
        number.onchange = () => {
            const typed = number.value;
            number.value = written(this.values[at]); // until the server has taken what was typed
            if (typed !== "") this.set(name, Number(typed));
        };
        limits.ondblclick = () => this.set(name, parameter.default);
        return { parameter, scale, range, number, element };
    }

    /** Shows the values that count now, except where somebody is moving or typing. */
    show(values) {
        this.values = values;
        this.rows?.forEach(({ parameter, scale, range, number, element }, at) => {
            const value = values[at];
            if (!range.matches(":active")) range.value = Math.round(STEPS * scale.share(value));
            if (document.activeElement !== number || Number(number.value) === value) number.value = written(value);
            element.classList.toggle("changed", value !== parameter.default);
        });
    }
}

/** How a slider's share (0..1) and a value belong together. */
function scaleOf({ min, max, default: usual, kind }) {
    const whole = value => kind === "real" ? Number(value.toPrecision(3)) : kind === "odd" ? odd(value) : Math.round(value);
    if (max !== null && max - min <= EVEN) {
        return { value: share => whole(min + share * (max - min)), share: value => (value - min) / (max - min) };
    }
    const least = min > 0 ? min : usual > 0 ? usual / 100 : kind === "real" ? 0.001 : 1;
    const most = Math.min(max ?? Infinity, usual > 0 ? usual * 100 : kind === "real" ? 10 : 1000);
    const ratio = Math.log(most / least);
    return {
        value: share => share === 0 ? min : whole(Math.max(min, least * Math.exp(share * ratio))),
        share: value => value <= least ? 0 : Math.min(1, Math.log(value / least) / ratio),
    };
}

const odd = value => value < 2 ? 0 : 2 * Math.floor(value / 2) + 1;
const written = value => String(Number(value.toPrecision(6)));

/** An element with properties and children. */
export function node(name, properties = {}, ...children) {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
}
