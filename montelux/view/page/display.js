// How each layer is displayed: its place in the textures, its scale, and the light mix.

import {mostLights} from "./shader.js";
import {modeOfKind} from "./surface.js";

/** Name of the mix of all lights, which is no layer of the program. */
export const lightMix = "light mix";

const rangeLifetime = 500; // ms

/** Ranges of relative errors and z-scores do not move, so that convergence is visible. */
const fixedRanges = {ratio: [0.001, 1], z: [-4, 4]};

// 1, 3 or 10 times a power of ten, at most or at least v.
function snapped(v, up) {
    const power = 10 ** Math.floor(Math.log10(v));
    const steps = [1, 3, 10].map(step => step * power);
    return up ? steps.find(step => step >= v * (1 - 1e-9)) : steps.findLast(step => step <= v * (1 + 1e-9));
}

export class DisplayRules {
    /** @param {import("./layer_store.js").LayerStore} store @param {() => number[][]} mixWeights */
    constructor(store, mixWeights) {
        this.store = store;
        this.mixWeights = mixWeights;
        this.ranges = new Map();
    }

    /** @returns {string[]} names of the light layers, in the order of the scene's lights */
    lightLayers() {
        const names = (this.store.scene?.lights ?? []).slice(0, mostLights).map(name => `light ${name}`);
        return names.every(name => this.store.get(name)?.kind === "color") ? names : [];
    }

    /** @returns {string[]} the layers of the program that a displayed layer needs */
    needs(name) { return name === lightMix ? this.lightLayers() : [name]; }

    /** All lights share one texture array, so that the shader can add them. */
    placeOf(name) {
        const lights = this.lightLayers(), slice = lights.indexOf(name);
        return slice < 0 ? {array: `layer ${name}`, slice: 0, slices: 1}
            : {array: "lights", slice, slices: lights.length};
    }

    /** @returns {import("./surface.js").Shown | null} null: there is no such layer */
    shown(name) {
        const lights = this.lightLayers();
        const isMix = name === lightMix && lights.length > 0;
        const layer = this.store.get(isMix ? lights[0] : name);
        if (!layer) return null;
        const place = this.placeOf(layer.name);
        return {layer, array: place.array, slices: place.slices, first: isMix ? 0 : place.slice,
            count: isMix ? lights.length : 1, mode: modeOfKind[layer.kind] ?? modeOfKind.scalar,
            range: this.rangeOf(layer), weights: isMix ? this.mixWeights() : null};
    }

    /** @returns {[number, number]} ends of the scale of false colours */
    rangeOf(layer) {
        if (fixedRanges[layer.kind]) return fixedRanges[layer.kind];
        if (!["error", "scalar", "count"].includes(layer.kind)) return [0, 1];
        const old = this.ranges.get(layer.name), now = performance.now();
        if (old && (old.version === layer.version || now - old.time < rangeLifetime)) return old.range;
        const isError = layer.kind === "error";
        let [low, high] = layer.robustRange(isError) ?? (isError ? [0.01, 1] : [0, 1]);
        if (isError) {
            high = snapped(high, true);
            low = Math.min(snapped(low, false), high / 10);
        } else if (!(high > low)) {
            [low, high] = [Math.min(0, low), Math.max(low, low > 0 ? 0 : 1, high)];
        }
        const range = [low, high];
        // A range of nothing must not stay for a while.
        if (layer.version > 0) this.ranges.set(layer.name, {range, version: layer.version, time: now});
        return range;
    }

    /** @returns {boolean} whether the range was not computed from the newest values */
    isRangeOld(layer) {
        const range = this.ranges.get(layer.name);
        return Boolean(range) && range.version !== layer.version;
    }

    /** @returns {number[] | null} displayed values of a pixel before the tone curve; null: none arrived */
    valuesAt(name, x, y) {
        const shown = this.shown(name);
        if (!shown?.layer.version) return null;
        if (!shown.weights) return shown.layer.at(x, y);
        const sum = [0, 0, 0];
        this.lightLayers().forEach((light, i) => {
            const values = this.store.get(light).at(x, y);
            for (let c = 0; c < 3; ++c)
                if (shown.weights[i].some(w => w !== 0)) sum[c] += shown.weights[i][c] * values[c];
        });
        return sum;
    }
}
