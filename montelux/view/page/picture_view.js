// The picture on the stage: surface, overlay, zoom, legend; draws when something has changed.

import {Legend} from "./legend.js";
import {Overlay} from "./overlay.js";
import {Surface} from "./surface.js";
import {ViewTransform} from "./view_transform.js";

// From this zoom on, in CSS pixels per pixel, lines separate the pixels.
const gridScale = 8;
const rangeDelay = 500; // ms: ranges of false colours change no more often

export class PictureView {
    /**
     * @param {Document} document
     * @param {{store: import("./layer_store.js").LayerStore, rules: import("./display.js").DisplayRules,
     *          compare: import("./compare.js").Compare, exposure: import("./exposure.js").Exposure,
     *          names: () => [string, string | null], chosen: () => {x: number, y: number} | null,
     *          onDraw: () => void}} model
     */
    constructor(document, model) {
        Object.assign(this, model);
        this.stage = document.getElementById("stage");
        this.canvas = document.getElementById("picture");
        this.overlayCanvas = document.getElementById("overlay");
        this.zoomValue = document.getElementById("zoom-value");
        this.message = document.getElementById("message");
        this.legend = new Legend(document.getElementById("legend"));
        this.overlay = new Overlay(this.overlayCanvas);
        this.view = new ViewTransform();
        this.surface = new Surface(this.canvas, () => this.uploadAll());
        if (!this.surface.gl) this.say("This browser offers no WebGL2, which the picture needs.");
        new ResizeObserver(() => this.resize()).observe(this.stage);
        this.resize();
    }

    /** Over the stage; "" removes it. */
    say(text) {
        this.message.hidden = text === "";
        this.message.textContent = text;
    }

    resize() {
        const {clientWidth: width, clientHeight: height} = this.stage;
        for (const canvas of [this.canvas, this.overlayCanvas]) {
            canvas.width = Math.max(1, Math.round(width * devicePixelRatio));
            canvas.height = Math.max(1, Math.round(height * devicePixelRatio));
        }
        this.view.setStage(width, height);
        // A canvas of a new size is empty: no frame may pass before it is drawn.
        this.draw();
    }

    /** A scene message. @param {boolean} hasSameLayers the textures fit */
    adopt(scene, hasSameLayers) {
        this.view.setPicture(scene.width, scene.height);
        if (!this.surface.gl) return;
        const limit = this.surface.largestSide, isTooLarge = Math.max(scene.width, scene.height) > limit;
        this.say(isTooLarge ? `This device shows pictures of at most ${limit} x ${limit} pixels.` : "");
        this.isBlocked = isTooLarge;
        if (hasSameLayers) return;
        this.surface.clear();
        this.uploadAll();
    }

    uploadAll() {
        for (const layer of this.store.layers.values())
            if (layer.version > 0)
                this.upload(layer, {x: 0, y: 0, width: layer.width, height: layer.height, values: layer.values});
        this.invalidate();
    }

    upload(layer, tile) {
        if (!this.isBlocked) this.surface.upload(this.rules.placeOf(layer.name), layer, tile);
    }

    invalidate() {
        this.frame ??= requestAnimationFrame(() => this.draw());
    }

    /** @returns {import("./surface.js").Display | null} */
    display() {
        const [a, b] = this.names().map(name => name === null ? null : this.rules.shown(name));
        return a && {shown: [a, b], exposure: this.exposure.exposure, tone: this.exposure.tone};
    }

    draw() {
        cancelAnimationFrame(this.frame);
        this.frame = undefined;
        const display = this.store.scene ? this.display() : null;
        if (!display || this.isBlocked) return;
        this.onDraw();
        display.exposure = this.exposure.exposure;
        const ratio = devicePixelRatio, {scale, x, y} = this.view;
        this.surface.show(display, {scale: scale * ratio, x: Math.round(x * ratio), y: Math.round(y * ratio),
            split: this.compare.share * this.canvas.width, grid: scale >= gridScale});
        this.overlay.draw(this.view, this.chosen(), (px, py) => this.valuesAt(px, py));
        this.legend.update(display.shown);
        const zoom = `${Number((100 * scale).toPrecision(3))} %`;
        if (this.zoomValue.textContent !== zoom) this.zoomValue.textContent = zoom;
        const ranges = display.shown.map(s => s ? this.rules.isRangeOld(s.layer) : false);
        clearTimeout(this.later);
        if (ranges.includes(true)) this.later = setTimeout(() => this.invalidate(), rangeDelay);
    }

    // The layer of the side of the wipe on which the pixel's centre lies.
    valuesAt(px, py) {
        const [a, b] = this.names(), split = this.compare.share * this.view.stage.width;
        return this.rules.valuesAt(b !== null && this.view.toStage(px + 0.5, py).x >= split ? b : a, px, py);
    }

    /** Displayed pixels of a rectangle of the picture. @returns {Uint8ClampedArray | null} RGBA from the top */
    read(x, y, width, height) {
        const display = this.store.scene ? this.display() : null;
        if (!display || this.isBlocked) return null;
        const split = (this.compare.share * this.view.stage.width - this.view.x) / this.view.scale;
        return this.surface.read(display, split, x, y, width, height);
    }

    /** All of them. */
    readAll() { return this.read(0, 0, this.store.scene?.width, this.store.scene?.height); }
}
