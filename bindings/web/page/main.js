// The page: a map, how it is read and searched, and what is drawn of it.

import { Drop } from "../../../crates/depthplanes-serve/page/src/drop.js";
import { Stages, showGround, showPlanes } from "../../../crates/depthplanes-serve/page/src/panels.js";
import { Pick } from "../../../crates/depthplanes-serve/page/src/pick.js";
import { Sliders, node } from "../../../crates/depthplanes-serve/page/src/sliders.js";
import { View2d } from "../../../crates/depthplanes-serve/page/src/view2d.js";
import { View3d } from "../../../crates/depthplanes-serve/page/src/view3d.js";
import { Choices } from "./choices.js";
import { Client } from "./client.js";
import { offer } from "./downloads.js";
import { keys } from "./keys.js";

const FIRST = "room:sensor=kinect";
const MOST_BYTES = 2 ** 30;
/** A picked pixel without a plane is explained anew when nothing else has changed for so long. */
const EXPLAIN_AGAIN_MS = 300;
const NOTHING = { map: { scene: FIRST }, bytes: undefined, reading: {}, method: "planar", parameters: {} };

const find = id => document.getElementById(id);
/* global WORKER: the text of the worker's script */
const client = new Client(WORKER);
/** What is shown: `state` made `frame`; `due` is being found, `wanted` comes next. */
const page = { tables: null, state: NOTHING, due: null, wanted: null, isBusy: false, frame: null, serial: 0, cameras: 0, chosen: null };

const view2d = new View2d(find("view2d"), at => look(at));
const view3d = new View3d(find("view3d"), "state them under “Map and method”");
const pick = new Pick(find("pixel"), choose, ask);
const setParameter = (name, value) => want(({ parameters }) => ({ parameters: { ...parameters, [name]: value } }));
const sliders = new Sliders(find("parameters"), setParameter, () => want({ parameters: {} }));
const stages = new Stages(find("stages"), find("total"));
const choices = new Choices(find("choices"), want, banner);
globalThis.depthplanes = Object.assign(page, { view2d, view3d, client }); // for the browser's console, and for tests

/** What is stated of a map; the size of files without a header is not that of others. */
function stated({ file }, { raw_size, ...others }) {
    const { extensions } = page.tables.formats.find(({ name }) => name === "raw");
    const isRaw = extensions.some(end => file?.toLowerCase().endsWith(`.${end}`));
    return isRaw ? { raw_size, ...others } : others;
}

/** The request of what is wanted. */
function request(ask, { map, reading, method, parameters }) {
    return { ask, map, words: { ...stated(map, reading), ...(ask === "camera" ? {} : { method, ...parameters }) } };
}

/** Shows something else: changes of what was wished last, or a function that makes them of it. While it is found only the newest wish waits. */
function want(change) {
    const last = page.wanted ?? page.due ?? page.state;
    page.wanted = { ...last, ...(typeof change === "function" ? change(last) : change) };
    if (!page.isBusy) work();
}

async function work() {
    page.isBusy = true;
    find("speed").classList.add("busy");
    while (page.wanted) {
        const wanted = page.due = page.wanted;
        page.wanted = null;
        try {
            await show(wanted);
            banner(null);
        } catch (error) {
            banner(error.message);
            if (!page.wanted) showState(); // controls go back
        }
    }
    find("speed").classList.remove("busy");
    page.due = null;
    page.isBusy = false;
}

async function show(wanted) {
    const frame = await client.ask(request("show", wanted), wanted.bytes);
    const { state } = page;
    const isOther = wanted.map !== state.map || !page.frame;
    if (isOther || wanted.reading !== state.reading) {
        const camera = await client.ask(request("camera", wanted), wanted.bytes);
        page.camera = camera.rays ? camera : null;
        page.cameras++;
        if (page.camera) view3d.setCamera(camera);
    }
    if (isOther) page.chosen = view2d.chosen = view3d.chosen = view2d.at = null;
    page.state = wanted;
    frame.serial = ++page.serial;
    frame.camera = page.camera ? page.cameras : null;
    if (isOther) pick.clear();
    draw(frame, isOther);
}

function draw(frame, isOther) {
    page.frame = frame;
    if (isOther) view3d.hasLooked = false;
    view2d.show(frame, true); // nothing moves here from frame to frame
    view3d.show(frame, true);
    stages.means.clear();
    stages.add(frame);
    showState();
    showPanels();
    document.body.dataset.serial = frame.serial;
    clearTimeout(draw.asks);
    if (view2d.at) draw.asks = setTimeout(() => view2d.at && look(view2d.at), EXPLAIN_AGAIN_MS);
}

/** The controls show what counts now. */
function showState() {
    const { state, tables } = page;
    const { parameters } = tables.methods.find(({ name }) => name === state.method);
    if (sliders.of !== parameters) sliders.make(sliders.of = parameters);
    sliders.show(parameters.map(({ name, default: usual }) => state.parameters[name] ?? usual));
    choices.show(state);
}

function showPanels() {
    const { frame, state, tables } = page;
    find("frame-name").textContent = `${frame.name} · ${frame.map.width} × ${frame.map.height} · ${frame.encoding}`;
    document.title = `${frame.name} – depthplanes`;
    find("sample").value = state.map.scene ?? "";
    find("method-name").textContent = state.method;
    find("plane-count").textContent = frame.planes.length;
    showPlanes(find("planes"), frame, page.chosen, id => {
        pick.clear();
        view2d.at = null;
        choose(id === page.chosen ? null : id);
    });
    showGround(find("ground"), frame);
    stages.show();
    const { stages: of } = tables.methods.find(({ name }) => name === state.method);
    const ms = frame.stages.filter(([name]) => of.includes(name)).reduce((sum, [, ms]) => sum + ms, 0);
    find("speed").textContent = `${frame.planes.length} planes in ${ms.toFixed(1)} ms`;
    pick.show(frame);
    find("notes-panel").hidden = frame.notes.length === 0;
    find("note-count").textContent = frame.notes.length;
    find("notes").replaceChildren(...frame.notes.map(textContent => node("li", { textContent })));
}

function choose(id) {
    page.chosen = view2d.chosen = view3d.chosen = id;
    if (!page.frame) return;
    view2d.redraw();
    view3d.redraw();
    showPanels();
}

/** Looks at a pixel of the map. */
function look(at) {
    view2d.at = at;
    pick.pick(page.frame, at);
    view2d.redraw();
}

/** What a picked pixel asks for. */
async function ask(type, { at, name, value } = {}) {
    if (type === "set") setParameter(name, value);
    if (type !== "explain") return;
    try {
        pick.answer(await client.ask(request({ explain: at }, page.state), page.state.bytes));
    } catch (error) {
        pick.answer({ at, error: error.message });
    }
}

/** Says why something failed, or nothing. */
function banner(text) {
    find("banner").hidden = !text;
    find("banner-text").textContent = text ?? "";
}

async function open(file) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    want({ map: { file: file.name }, bytes });
}

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
view3d.sectors = find("sectors").checked;
for (const [name, view] of [["outlines", view2d], ["ids", view2d], ["floor", view3d], ["obstacles", view3d], ["sectors", view3d]]) {
    find(name).onchange = ({ target }) => {
        view[name] = target.checked;
        view.redraw();
    };
}
find("banner-close").onclick = () => banner(null);
find("view-reset").onclick = () => view3d.reset();
find("licences").onclick = () => find("licence-text").showModal();
find("sample").onchange = ({ target }) => target.value && want({ map: { scene: target.value }, bytes: undefined });
new Drop({ zone: find("drop"), button: find("open"), input: find("file") }, () => MOST_BYTES, banner, open);
keys({ page, look, modes: { 1: "planes", 2: "depth", 3: "ground" }, setMode, buttons: { o: find("open"), r: find("view-reset") } });

/** The page begins with a sample, so that there is something to see. */
async function begin() {
    try {
        page.tables = await client.ask({ ask: "tables" });
    } catch (error) {
        return banner(error.message);
    }
    const { tables } = page;
    find("version").textContent = `depthplanes ${tables.version}`;
    const samples = tables.scenes.map(({ name, about }) => node("option", { value: `${name}:sensor=kinect`, textContent: `Sample: ${name}`, title: about }));
    find("sample").replaceChildren(node("option", { value: "", textContent: "Samples", disabled: true }), ...samples);
    choices.make(tables);
    offer(find("downloads"), tables.outputs, page, (output, extension) => client.ask(request({ encode: [output, extension] }, page.state), page.state.bytes), banner);
    want({});
    want({}); // once more: the first time the browser still compiles, and that is no time of the method
}
begin();
