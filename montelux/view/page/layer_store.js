// The layers of the scene in memory: for the readout, ranges, and textures after a lost WebGL context.

import {halfTable} from "./half.js";

/** Values of one layer, row by row, and how much of it arrived since the last restart. */
export class Layer {
    /** @param {{name: string, kind: string, channels: number, format: string}} info */
    constructor(info, width, height) {
        Object.assign(this, info);
        this.width = width;
        this.height = height;
        const count = width * height * this.channels;
        /** Halfs as their bits. */
        this.values = this.format === "half" ? new Uint16Array(count) : new Float32Array(count);
        /** Grows with each tile. */
        this.version = 0;
        this.restart();
    }

    /** Keeps the values until new ones arrive: the old picture stays visible. */
    restart() {
        this.seen = new Uint8Array(this.width * this.height);
        this.missing = this.seen.length;
    }

    get isComplete() { return this.missing === 0; }

    /** @param {import("./tiles.js").Tile} tile */
    put(tile) {
        const row = tile.width * this.channels;
        for (let y = 0; y < tile.height; ++y) {
            const pixel = (tile.y + y) * this.width + tile.x;
            this.values.set(tile.values.subarray(y * row, (y + 1) * row), pixel * this.channels);
            if (this.missing > 0)
                for (let i = pixel; i < pixel + tile.width; ++i)
                    if (!this.seen[i]) {
                        this.seen[i] = 1;
                        --this.missing;
                    }
        }
        ++this.version;
    }

    /** @returns {number} the value at an index of `values`; an id as an unsigned integer */
    valueAt(index) {
        if (this.kind === "id" && this.format !== "half") {
            this.bits ??= new Uint32Array(this.values.buffer);
            return this.bits[index];
        }
        return this.format === "half" ? halfTable[this.values[index]] : this.values[index];
    }

    /** @returns {number[]} the values of a pixel */
    at(x, y) {
        const start = (y * this.width + x) * this.channels;
        return Array.from({length: this.channels}, (_, c) => this.valueAt(start + c));
    }

    /** @returns {number} of the finite positive pixels of a colour layer; NaN without any */
    logAverageLuminance() {
        const value = this.format === "half" ? i => halfTable[this.values[i]] : i => this.values[i];
        const [g, b] = this.channels >= 3 ? [1, 2] : [0, 0];
        let sum = 0, count = 0;
        for (let i = 0; i < this.values.length; i += this.channels) {
            const luminance = 0.2126 * value(i) + 0.7152 * value(i + g) + 0.0722 * value(i + b);
            if (luminance > 0 && luminance < Infinity) {
                sum += Math.log(luminance);
                ++count;
            }
        }
        return Math.exp(sum / count);
    }

    /**
     * Quantiles 1 % and 99 % of the first channel, from at most about 20000 pixels.
     * @param {boolean} positive only positive values count
     * @returns {[number, number] | null} null: no finite value
     */
    robustRange(positive) {
        const pixels = this.width * this.height;
        // Odd, so that columns of pixels do not line up with it.
        const stride = Math.max(1, Math.floor(pixels / 20000)) | 1;
        const found = [];
        for (let i = 0; i < pixels; i += stride) {
            const v = this.valueAt(i * this.channels);
            if (Number.isFinite(v) && (!positive || v > 0)) found.push(v);
        }
        if (!found.length) return null;
        found.sort((a, b) => a - b);
        const at = share => found[Math.round(share * (found.length - 1))];
        return [at(0.01), at(0.99)];
    }
}

/** All layers of the current scene message, by name. */
export class LayerStore {
    constructor() {
        /** @type {Map<string, Layer>} */
        this.layers = new Map();
        this.scene = null;
    }

    /** Adopts a scene message; layers of the same shape keep their values. @returns {boolean} same layers */
    adopt(scene) {
        const sameSize = this.scene?.width === scene.width && this.scene?.height === scene.height;
        const layers = new Map();
        let same = sameSize && scene.layers.length === this.layers.size;
        for (const info of scene.layers) {
            const old = sameSize ? this.layers.get(info.name) : undefined;
            const fits = old && ["kind", "channels", "format"].every(key => old[key] === info[key]);
            same &&= Boolean(fits);
            layers.set(info.name, fits ? old : new Layer(info, scene.width, scene.height));
            layers.get(info.name).restart();
        }
        this.layers = layers;
        this.scene = scene;
        return same;
    }

    /** @returns {Layer | undefined} */
    get(name) { return this.layers.get(name); }

    /** @param {number} index of the scene message @returns {Layer} */
    byIndex(index) { return this.layers.get(this.scene.layers[index].name); }
}
