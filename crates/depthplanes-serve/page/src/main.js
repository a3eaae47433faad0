// The page: what the server sends goes to the views and panels, what people ask for to the server.

import { Drop } from "./drop.js";
import { Stages, showGround, showPlanes } from "./panels.js";
import { Pick } from "./pick.js";
import { Sliders, node } from "./sliders.js";
import { Socket } from "./socket.js";
import { Timeline } from "./timeline.js";
import { View2d } from "./view2d.js";
import { View3d } from "./view3d.js";

/** Tables and figures are renewed no more often: nobody reads faster. */
const PANELS_MS = 150;

const find = id => document.getElementById(id);
const page = { hello: null, frame: null, state: null, chosen: null, drawn: [], panelsAt: 0, dismissed: null };

const socket = new Socket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`, receive, connected);
const ask = (type, more) => socket.ask(type, more);
/** Asks for parameters; what was refused before is over. */
const setParameters = (type, more) => {
    banner(null);
    ask(type, more);
};
const view2d = new View2d(find("view2d"), at => {
    pick.pick(page.frame, at);
    view2d.at = at;
    view2d.redraw();
});
const view3d = new View3d(find("view3d"), "start with --preset SENSOR, --intrinsics FX,FY,CX,CY or --camera FILE");
const pick = new Pick(find("pixel"), choose, ask);
const sliders = new Sliders(find("parameters"), (name, value) => setParameters("set", { name, value }), () => setParameters("reset"));
const timeline = new Timeline(document.querySelector("footer"), ask);
const stages = new Stages(find("stages"), find("total"));
globalThis.depthplanes = Object.assign(page, { view2d, view3d }); // for the browser's console, and for tests
new Drop({ zone: find("drop"), button: find("open"), input: find("file") }, () => page.hello?.upload_bytes ?? Infinity, banner, upload);

/** Sends a file to the server, which reads it. */
async function upload(file) {
    const answer = await fetch(`/file/${encodeURIComponent(file.name)}`, { method: "POST", body: file }).catch(() => null);
    if (!answer) throw new Error(`${file.name}: the server did not answer`);
    if (!answer.ok) throw new Error(await answer.text() || `${file.name}: ${answer.statusText}`);
}

function receive(message) {
    ({ hello: begin, state: showState, camera: of => view3d.setCamera(of), frame: wait, explanation: of => pick.answer(of), refused: refuse })[message.type]?.(message);
}

function begin(hello) {
    page.hello = hello;
    find("source").textContent = hello.source;
    find("method").textContent = hello.method.name;
    find("method").title = hello.method.about;
    find("version").textContent = `depthplanes ${hello.version}`;
    document.title = `${hello.source} – depthplanes`;
    sliders.make(hello.parameters);
}

function connected(yes) {
    find("link").textContent = yes ? "live" : "no connection, trying again";
    find("link").classList.toggle("off", !yes);
    if (yes) {
        wait.next = null;
        banner(null);
    }
    banner(yes ? page.state?.error : page.hello ? "The connection is lost. The page connects again as soon as the program answers." : null, "connection");
}

/** A frame is drawn when the browser draws; only then the server sends one more. */
function wait(frame) {
    if (wait.next) ask("drawn");
    else requestAnimationFrame(() => {
        const next = wait.next;
        wait.next = null;
        if (!next) return;
        draw(next);
        ask("drawn");
    });
    wait.next = frame;
}

function draw(frame) {
    const before = page.frame;
    const anew = !before || before.camera !== frame.camera || Math.abs(before.index - frame.index) > 1 || before.unit !== frame.unit;
    page.frame = frame;
    view2d.show(frame, anew);
    view3d.show(frame, anew);
    stages.add(frame);
    const now = performance.now();
    page.drawn = [...page.drawn.filter(at => now - at < 2000), now];
    if (now - page.panelsAt >= PANELS_MS || !page.state?.is_playing) showPanels(now);
    document.body.dataset.serial = frame.serial;
}

function showPanels(now) {
    const { frame } = page;
    page.panelsAt = now;
    const [first] = page.drawn;
    const rate = page.drawn.length > 1 ? 1000 * (page.drawn.length - 1) / (now - first) : 0;
    find("rate").textContent = page.state?.is_playing ? `${rate.toFixed(0)} frames/s` : "paused";
    const time = frame.time_s === null ? "" : ` · ${frame.time_s.toFixed(2)} s`;
    find("frame-name").textContent = `${frame.name}${time} · ${frame.map.width} × ${frame.map.height} · ${frame.encoding}`;
    find("plane-count").textContent = frame.planes.length + (frame.lost ? `, ${frame.lost} out of sight` : "");
    showPlanes(find("planes"), frame, page.chosen, id => {
        pick.clear();
        choose(id === page.chosen ? null : id);
    });
    showGround(find("ground"), frame);
    stages.show();
    pick.show(frame);
    find("notes-panel").hidden = frame.notes.length === 0;
    find("note-count").textContent = frame.notes.length;
    find("notes").replaceChildren(...frame.notes.map(textContent => node("li", { textContent })));
}

function showState(state) {
    page.state = state;
    timeline.show(state);
    sliders.show(state.values);
    find("leave-file").hidden = state.file === null;
    if (state.file) find("notes-panel").open = true;
    banner(state.error, "state");
    if (!state.is_playing && page.frame) showPanels(performance.now());
}

/** What this page asked for is not done: its sliders go back. */
function refuse({ error }) {
    banner(error);
    sliders.show(page.state.values);
}

/** Shows why something failed, or nothing; `about` says whose words these are, so that others' stay. */
function banner(text, about = "answer") {
    if (!text && banner.about !== about) return;
    if (text) banner.about = about;
    find("banner").hidden = !text;
    find("banner-text").textContent = text ?? "";
}

function choose(id) {
    page.chosen = view2d.chosen = view3d.chosen = id;
    if (!page.frame) return;
    view2d.redraw();
    view3d.redraw();
    showPanels(performance.now());
}

find("banner-close").onclick = () => find("banner").hidden = true;
find("leave-file").onclick = () => {
    banner(null);
    ask("return");
};
find("view-reset").onclick = () => view3d.reset();

function setMode(mode) {
    view2d.mode = view3d.mode = mode;
    document.querySelectorAll("#mode button").forEach(button => button.ariaChecked = String(button.dataset.mode === mode));
    find("opacity").disabled = mode === "depth";
    view2d.redraw();
    view3d.wake();
}
document.querySelectorAll("#mode button").forEach(button => button.onclick = () => setMode(button.dataset.mode));
setMode("planes");

find("opacity").value = view2d.opacity;
find("opacity").oninput = ({ target }) => {
    view2d.opacity = Number(target.value);
    view2d.redraw();
};
for (const [name, view] of [["outlines", view2d], ["ids", view2d], ["floor", view3d], ["obstacles", view3d], ["sectors", view3d]]) {
    find(name).onchange = ({ target }) => {
        view[name] = target.checked;
        view.redraw();
    };
}
