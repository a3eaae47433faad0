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
import { contentOf, sorted } from "./opened.js";
import { Opens } from "./opens.js";
import { arrange } from "./layout.js";

const FIRST = "room:sensor=kinect";
const MOST_BYTES = 2 ** 30;
/** A picked pixel without a plane is explained anew when nothing else has changed for so long. */
const EXPLAIN_AGAIN_MS = 300;
const NOTHING = { map: { scene: FIRST }, bytes: undefined, reading: {}, carried: [], method: "planar", parameters: {}, curved: false };

const find = id => document.getElementById(id);
const main = document.querySelector("main");
/* global WORKER: the text of the worker's script */
const client = new Client(WORKER);
/** What is shown: `state` made `frame`; `due` is being found, `wanted` comes next, and `refused` is a map, or what was stated of one,
 * that waits until that is mended. Wishes have the number of what was opened last when they came. */
const page = { tables: null, state: NOTHING, due: null, wanted: null, refused: null, isBusy: false, frame: null, serial: 0, cameras: 0, chosen: null };

const view2d = new View2d(find("view2d"), at => look(at));
const view3d = new View3d(find("view3d"), "state them under “Map and method”");
const pick = new Pick(find("pixel"), choose, ask);
const setParameter = (name, value) => want(({ parameters }) => ({ parameters: { ...parameters, [name]: value } }));
const sliders = new Sliders(find("parameters"), setParameter, () => want({ parameters: {} }));
const stages = new Stages(find("stages"), find("total"));
const choices = new Choices(find("choices"), { want, wantMap, giveUp, check, openCamera });
const opens = new Opens(showReading, banner);
globalThis.depthplanes = Object.assign(page, { view2d, view3d, client }); // for the browser's console, and for tests

/** What is stated of a map; size and type of files without a header are not those of others. */
function stated({ file }, { raw_size, raw_type, ...others }) {
    const { extensions } = page.tables.formats.find(({ name }) => name === "raw");
    const isRaw = extensions.some(end => file?.toLowerCase().endsWith(`.${end}`));
    return isRaw ? { raw_size, raw_type, ...others } : others;
}

/** The request of what is wanted. */
function request(ask, { map, reading, method, parameters, curved }) {
    const isCurved = curved && choices.curvedMethods.has(method);
    return { ask, map, words: { ...stated(map, reading), ...(ask === "camera" ? {} : { method, curved: isCurved, ...parameters }) } };
}

const changed = (state, change) => ({ ...state, ...(typeof change === "function" ? change(state) : change) });

/** Looks for planes in another way: changes of what was wished last, or a function that makes them of it. */
function want(change) {
    if (page.refused) page.refused = changed(page.refused, change);
    next(changed(page.wanted ?? page.due ?? page.state, change));
}

/** Shows another map, or reads it otherwise: one that was refused, if there is one. */
function wantMap(change) {
    next(changed(page.wanted ?? page.due ?? page.refused ?? page.state, change));
}

/** While something is found only the newest wish waits. */
function next(wanted) {
    page.wanted = { ...wanted, opened: opens.number };
    if (!page.isBusy) work();
}

/** What was refused is not wanted any more. */
function giveUp() {
    page.refused = null;
    banner(null);
    showState();
}

async function work() {
    page.isBusy = true;
    find("speed").classList.add("busy");
    while (page.wanted) {
        const wanted = page.due = page.wanted;
        page.wanted = null;
        showReading();
        const isLast = () => wanted.opened === opens.number;
        try {
            await show(wanted);
            if (isLast()) banner(page.refused?.why);
        } catch (error) {
            if (isLast()) banner(error.message);
            if (isLast() && isOther(wanted)) page.refused = { ...wanted, why: error.message };
            if (!page.wanted) showState(); // controls of the method go back
        }
    }
    find("speed").classList.remove("busy");
    page.due = null;
    page.isBusy = false;
    showReading();
}

/** Says which file is being read. */
function showReading() {
    const due = page.due && page.due.map !== page.state.map ? page.due.map.file : undefined;
    const name = opens.name ?? due;
    find("reading").hidden = name === undefined;
    find("reading").textContent = name === undefined ? "" : `reading ${name}`;
}

/** Whether it is about another map than the one that is shown, or states something else of it. */
const isOther = ({ map, reading }) => map !== page.state.map || reading !== page.state.reading;

async function show(wanted) {
    const frame = await client.ask(request("show", wanted), wanted.bytes);
    const { state } = page;
    const isOtherMap = wanted.map !== state.map || !page.frame;
    if (isOtherMap || isOther(wanted)) {
        page.refused = null;
        const camera = await client.ask(request("camera", wanted), wanted.bytes);
        page.camera = camera.rays ? camera : null;
        page.cameras++;
        if (page.camera) view3d.setCamera(camera);
    }
    if (isOtherMap) page.chosen = view2d.chosen = view3d.chosen = view2d.at = null;
    const { why, ...shown } = wanted; // which may have been refused before
    page.state = shown;
    frame.serial = ++page.serial;
    frame.camera = page.camera ? page.cameras : null;
    if (isOtherMap) pick.clear();
    draw(frame, isOtherMap);
}

function draw(frame, isOtherMap) {
    page.frame = frame;
    arrange(main, frame.map);
    if (isOtherMap) view3d.hasLooked = false;
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
    const { map, reading, carried, ...others } = page.refused ?? state;
    const inUse = Object.keys(stated(map, reading));
    choices.show({ map, reading, carried: carried.filter(name => inUse.includes(name)), ...others }, Boolean(page.refused));
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
    choices.showInUse(frame, state);
    const { stages: of } = tables.methods.find(({ name }) => name === state.method);
    const ms = stages.show(of);
    find("speed").textContent = `${frame.planes.length} planes in ${ms.toFixed(1)} ms`;
    find("speed").title = `What ${state.method} took; the list under “Time” has what was done before and after it as well`;
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
        const why = await client.ask(request({ explain: at }, page.state), page.state.bytes);
        const isHidden = why.verdict.kind === "curved" && !page.state.curved;
        const remedies = isHidden ? [{ text: "Show curved surfaces", act: () => want({ curved: true }) }] : [];
        pick.answer({ ...why, remedies });
    } catch (error) {
        pick.answer({ at, error: error.message });
    }
}

/** Says why something failed, or nothing. */
function banner(text) {
    find("banner").hidden = !text;
    find("banner-text").textContent = text ?? "";
}

/** Fails unless the text of a camera file states a camera. */
function check(camera) {
    return client.ask({ ask: "check", words: { camera } });
}

/** Reads a map, a camera file, or both. */
function open(...files) {
    const read = async () => {
        const { map, camera } = await sorted(files, page.tables.formats, check);
        const own = camera && await choices.cameraOf(camera);
        return { own, map: map && { map: { file: map.name }, bytes: new Uint8Array(await contentOf(map, "arrayBuffer")) } };
    };
    return opens.run(files.map(({ name }) => name).join(", "), read, ({ own, map }) => map ? openMap(map, own) : choices.read(own));
}

function openCamera(file) {
    opens.run(file.name, () => choices.cameraOf(file), own => choices.read(own));
}

function openScene(scene) {
    opens.begin();
    openMap({ map: { scene }, bytes: undefined });
}

/** What is said of files before they are read. */
function failToOpen(text) {
    opens.begin();
    banner(text);
}

/** Shows another map. What was stated for the one before counts for it as well, and is marked; `own` is stated for itself. */
function openMap(map, own = {}) {
    wantMap(({ reading }) => {
        const carried = Object.keys(reading).filter(name => reading[name] !== undefined && !(name in own));
        return { ...map, reading: { ...reading, ...own }, carried };
    });
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
find("sample").onchange = ({ target }) => target.value && openScene(target.value);
new Drop({ zone: find("drop"), button: find("open"), input: find("file") }, () => MOST_BYTES, failToOpen, open, 2);
new ResizeObserver(() => {
    if (!page.frame) return;
    arrange(main, page.frame.map);
    showPanels();
}).observe(main);
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
