// Wires the parts of the page to the connection.
//
// Tests read the page by `window.montelux`, which cannot change anything:
//   state()            a copy of the state: see below
//   layers()           names of the scene's layers
//   connected()        whether the WebSocket is open
//   readPixel(x, y)    displayed 8-bit [red, green, blue] of a pixel of the picture; null without a picture
//   readPicture()      {width, height, rgba: number[]}: all of them, from the top
//   values(name, x, y) values of a pixel of a layer (or of "light mix") as the page holds them

import {AutoExposure} from "./auto_exposure.js";
import {ErrorChart} from "./chart.js";
import {Compare} from "./compare.js";
import {addresses, Connection} from "./connection.js";
import {Controls} from "./controls.js";
import {DisplayRules, lightMix} from "./display.js";
import {Exposure} from "./exposure.js";
import {Histogram} from "./histogram.js";
import {listenToKeys} from "./keys.js";
import {fillLayers, stepOption} from "./layer_menu.js";
import {LayerStore} from "./layer_store.js";
import {Lights} from "./lights.js";
import {Orbit} from "./orbit.js";
import {PathTree} from "./path_tree.js";
import {PictureView} from "./picture_view.js";
import {Readout} from "./readout.js";
import {savePicture} from "./save.js";
import {Status} from "./status.js";
import {decodeTiles, MalformedMessage} from "./tiles.js";
import {listenToView} from "./view_input.js";

const get = id => document.getElementById(id);
const noteTime = 8000; // ms
const arrowPan = 60; // CSS pixels

let scene = null, progress = null, chosen = null, hovered = null;
let subscribed = "", ignored = 0, noteTimer, connection = null;

const send = message => connection?.send(message) ?? false;
const isOpen = () => connection?.state === "open";
const filmOf = (x, y) => [x + (scene?.x0 ?? 0), y + (scene?.y0 ?? 0)];

const stem = () => scene ? scene.name.replace(/\.[^.]*$/, "") : "picture";
const updateLinks = () => controls.updateLinks(exposure.exposure, exposure.tone, isOpen(), stem());

function note(text) {
    get("note").textContent = text;
    clearTimeout(noteTimer);
    noteTimer = setTimeout(() => get("note").textContent = "", noteTime);
}

const {token, socket} = addresses(location);
const layerA = get("layer-a"), layerB = get("layer-b");
const store = new LayerStore();
const exposure = new Exposure(document, () => {
    updateLinks();
    picture.invalidate();
});
const autoExposure = new AutoExposure(exposure, store);
const lights = new Lights(get("lights"), {send, onChange: () => {
    if (layerA.value !== lightMix && !(compare.isOn && layerB.value === lightMix)) {
        layerA.value = lightMix;
        changeLayers();
    }
    picture.invalidate();
}});
const rules = new DisplayRules(store, () => lights.weights());
const compare = new Compare(document, changeLayers);
const names = () => [layerA.value, compare.isOn ? layerB.value : null];
const controls = new Controls(document, {send, note, token});
const status = new Status(get("status"));
const chart = new ErrorChart(get("curve")), histogram = new Histogram(get("histogram"));
const orbit = new Orbit(get("orbit"), get("stage"), send);
const readout = new Readout(get("readout"), {send, filmOf,
    localValues: (x, y) => [...new Set(names())].filter(Boolean)
        .map(name => [name, rules.valuesAt(name, x, y)]).filter(([, values]) => values),
    kindOf: name => store.get(name)?.kind});
const path = new PathTree(get("replay"), {send, filmOf});
const picture = new PictureView(document, {store, rules, compare, exposure, names, chosen: () => chosen,
    onDraw: () => autoExposure.update(progress)});

/** Asks for the layers that are displayed, and for the mean while the exposure follows it. */
function subscribe() {
    if (!scene) return;
    const wanted = new Set(names().filter(Boolean).flatMap(name => rules.needs(name)));
    if (autoExposure.isActive) wanted.add("mean");
    const layers = scene.layers.map(layer => layer.name).filter(name => wanted.has(name));
    if (layers.join("\n") === subscribed) return;
    if (send({type: "show", layers})) subscribed = layers.join("\n");
}

function changeLayers() {
    document.querySelector("#wipe .a").textContent = layerA.value;
    document.querySelector("#wipe .b").textContent = layerB.value;
    subscribe();
    readout.draw();
    picture.invalidate();
}

function update() {
    status.update(progress, scene?.name ?? "", connection?.state ?? "connecting");
    controls.update(progress, isOpen(), Boolean(scene?.stays));
    updateLinks();
    get("retry").hidden = !["lost", "ended"].includes(connection?.state);
}

function adoptScene(message) {
    const hasSameLayers = store.adopt(message);
    const known = message.layers.map(layer => layer.name);
    const isFirst = scene === null;
    scene = message;
    const lightLayers = rules.lightLayers();
    lights.update(lightLayers.length ? scene.lights : [], Boolean(scene.can_group_lights));
    fillLayers(layerA, known, lightLayers.length > 0, layerA.value, "mean");
    fillLayers(layerB, known, lightLayers.length > 0, isFirst ? "reference" : layerB.value,
        known.includes("reference") ? "reference" : "relative error");
    get("name").textContent = scene.name;
    orbit.enable(Boolean(scene.can_orbit), scene.orbit);
    exposure.start(scene);
    if (chosen && (chosen.x >= scene.width || chosen.y >= scene.height)) choose(null);
    picture.adopt(scene, hasSameLayers);
    subscribed = "";
    changeLayers();
    update();
}

const receivers = {
    scene: adoptScene,
    progress(message) {
        if (message.epoch !== scene?.epoch) return;
        progress = message;
        update();
        chart.draw(message.curve ?? [], message.target_error, message.state !== "ended");
        histogram.draw(message.histogram);
        readout.refresh();
        if (autoExposure.isActive) picture.invalidate();
    },
    pixel: message => readout.receive(message),
    replay: message => path.receive(message),
    refused: message => note(`Refused: ${message.why}`),
    goodbye: message => note(message.why ? `The program has ended: ${message.why}.` : "The program has ended."),
};

function receiveTiles(buffer) {
    try {
        const decoded = decodeTiles(buffer, scene);
        if (!decoded) return;
        const layer = store.byIndex(decoded.layer);
        for (const tile of decoded.tiles) {
            layer.put(tile);
            picture.upload(layer, tile);
        }
        picture.invalidate();
        readout.draw();
        autoExposure.update(progress);
    } catch (error) {
        if (!(error instanceof MalformedMessage)) throw error;
        ignoreMessage(`${buffer.byteLength} bytes, ${error.message}`);
    }
}

function ignoreMessage(what) {
    ++ignored;
    note(`A message was ignored: ${what}.`);
}

function changeConnection(state) {
    if (state === "open") {
        subscribed = "";
        readout.reset();
    }
    update();
}

function choose(pixel) {
    chosen = pixel;
    path.choose(pixel);
    readout.show(hovered ?? chosen);
    if (pixel && get("replay").open) path.ask();
    picture.invalidate();
}

function moveChosen(dx, dy) {
    if (!scene) return;
    const from = chosen ?? {x: Math.floor(scene.width / 2), y: Math.floor(scene.height / 2)};
    const clamp = (v, size) => Math.min(Math.max(v, 0), size - 1);
    hovered = null;
    choose({x: clamp(from.x + dx, scene.width), y: clamp(from.y + dy, scene.height)});
    picture.view.reveal(chosen.x, chosen.y);
}

function moveView(action) {
    action(picture.view);
    picture.invalidate();
}

listenToView(get("stage"), {
    isOrbit: event => orbit.isPossible && (orbit.isOn || event.altKey),
    onOrbit: (dx, dy, factor) => orbit.drag(dx, dy, factor),
    onPan: (dx, dy) => moveView(view => view.pan(dx, dy)),
    onZoom: (factor, x, y) => moveView(view => view.zoomTo(view.scale * factor, x, y)),
    onHover: (x, y) => readout.show((hovered = picture.view.pixelAt(x, y)) ?? chosen),
    onLeave: () => {
        // Without a chosen pixel the last one stays, so that the panels do not jump.
        hovered = null;
        if (chosen) readout.show(chosen);
    },
    onChoose: (x, y) => choose(picture.view.pixelAt(x, y)),
});

function replay() {
    if (!chosen) moveChosen(0, 0);
    get("replay").open = true;
    path.ask();
    get("replay").scrollIntoView({block: "nearest"});
}

const arrow = (dx, dy) => ({move: () => orbit.isOn ? orbit.turn(-5 * dx, 5 * dy, 1)
    : moveView(view => view.pan(arrowPan * dx, arrowPan * dy)), choose: () => moveChosen(-dx, -dy)});
const arrows = {ArrowLeft: arrow(1, 0), ArrowRight: arrow(-1, 0), ArrowUp: arrow(0, 1), ArrowDown: arrow(0, -1)};
const zoom = by => orbit.isOn ? orbit.turn(0, 0, 2 ** (by / 4)) : moveView(view => view.step(by));
listenToKeys(document, {
    ...Object.fromEntries(Object.entries(arrows).flatMap(([key, {move, choose: go}]) =>
        [[key, move], [`Shift+${key}`, go]])),
    "+": () => zoom(1), "=": () => zoom(1), "-": () => zoom(-1),
    "0": () => moveView(view => view.fit()), "1": () => moveView(view => view.zoomTo(1)),
    " ": () => controls.togglePause(),
    e: () => exposure.change(1), E: () => exposure.change(-1), a: () => get("auto-exposure").click(),
    t: () => exposure.nextTone(), "[": () => stepOption(layerA, -1), "]": () => stepOption(layerA, 1),
    c: () => compare.switch(!compare.isOn), r: replay, ",": () => path.step(-1), ".": () => path.step(1),
    o: () => orbit.switch(!orbit.isOn), "?": () => get("help-dialog").showModal(),
    Escape: () => orbit.isOn ? orbit.switch(false) : choose(null),
});
for (const select of [layerA, layerB]) select.addEventListener("change", changeLayers);
for (const [id, action] of [["zoom-in", () => zoom(1)], ["zoom-out", () => zoom(-1)],
    ["zoom-fit", () => moveView(view => view.fit())], ["zoom-one", () => moveView(view => view.zoomTo(1))],
    ["help-button", () => get("help-dialog").showModal()], ["retry", () => connection.retry()],
    ["auto-exposure", () => {
        exposure.isAutomatic = false;
        autoExposure.now();
    }]])
    get(id).addEventListener("click", action);
get("replay").addEventListener("toggle", () => get("replay").open && chosen && path.ask());
get("save-png").addEventListener("click", event => {
    const rgba = isOpen() ? null : picture.readAll();
    if (!rgba) return;
    event.preventDefault();
    savePicture(rgba, scene, `${stem()}.png`);
});

window.montelux = Object.freeze({
    /** `progress` is the last message; `shown` are the displayed layers; `scale` is the zoom. */
    state: () => structuredClone({epoch: scene?.epoch ?? null, progress, connection: connection?.state ?? null,
        exposure: exposure.exposure, tone: exposure.tone, isExposureAutomatic: exposure.isAutomatic, shown: names(),
        wipe: compare.share, chosen, hovered, scale: picture.view.scale, corner: [picture.view.x, picture.view.y],
        ignored, weights: lights.weights(), ranges: names().map(name => name && rules.shown(name)?.range)}),
    layers: () => [...store.layers.keys()],
    connected: isOpen,
    readPixel(x, y) {
        const rgba = picture.read(x, y, 1, 1);
        return rgba && [...rgba.slice(0, 3)];
    },
    readPicture() {
        const rgba = picture.readAll();
        return rgba && {width: scene.width, height: scene.height, rgba: [...rgba]};
    },
    values: (name, x, y) => rules.valuesAt(name, x, y),
});

update();
readout.draw();
connection = new Connection(socket, {onText: message => receivers[message.type]?.(message), onBinary: receiveTiles,
    onBadText: () => ignoreMessage("not an object of the protocol"), onState: changeConnection});
