// Play, pause, step and seek.

export class Timeline {
    constructor(element, ask) {
        const find = id => element.querySelector(`#${id}`);
        Object.assign(this, { ask, back: find("back"), play: find("play"), on: find("on"), seek: find("seek"), position: find("position") });
        this.play.onclick = () => this.toggle();
        this.back.onclick = () => ask("step", { back: true });
        this.on.onclick = () => ask("step");
        this.seek.oninput = () => ask("seek", { index: Number(this.seek.value) });
        document.addEventListener("keydown", event => {
            if (event.target.matches("input, button, summary") && event.key === " ") return;
            if (event.target.matches("input")) return;
            const action = { " ": () => this.toggle(), ArrowLeft: () => this.back.click(), ArrowRight: () => this.on.click() }[event.key];
            if (action) event.preventDefault();
            action?.();
        });
    }

    toggle() {
        this.ask(this.state?.is_playing ? "pause" : "play");
    }

    show(state) {
        this.state = state;
        this.play.classList.toggle("playing", state.is_playing);
        this.play.disabled = state.has_ended && !state.file;
        this.back.disabled = !state.can_seek;
        this.on.disabled = state.has_ended;
        this.seek.disabled = !state.can_seek || state.frames === null;
        this.seek.max = Math.max(0, (state.frames ?? 1) - 1);
        if (!this.seek.matches(":active")) this.seek.value = state.index ?? 0;
        const of = state.frames === null ? "" : ` / ${state.frames - 1}`;
        this.position.textContent = state.file ? "a file" : state.index === null ? "" : `${state.index}${of}${state.has_ended ? ", the end" : ""}`;
    }
}
