// The keyboard: modes, buttons, and the pixel that is looked at.

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export function keys({ page, look, modes, setMode, buttons }) {
    document.addEventListener("keydown", event => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select, dialog *")) return;
        if (modes[event.key]) return setMode(modes[event.key]);
        if (buttons[event.key]) return buttons[event.key].click();
        const step = STEPS[event.key];
        if (!step || !event.target.matches(".drawing") || !page.frame) return;
        event.preventDefault();
        const size = [page.frame.map.width, page.frame.map.height];
        const from = page.view2d.at ?? size.map(length => length >> 1);
        const far = event.shiftKey ? 10 : 1;
        look(from.map((x, axis) => Math.min(size[axis] - 1, Math.max(0, x + far * step[axis]))));
    });
}
