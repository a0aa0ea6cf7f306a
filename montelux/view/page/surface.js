// The WebGL2 surface: textures of the layers and the drawing of one or two of them.

import {idColor} from "./false_colors.js";
import {developShader, modes, placeShader, vertexShader} from "./shader.js";
import {toneNames} from "./tone.js";

/**
 * @typedef {{layer: import("./layer_store.js").Layer, array: string, slices: number, first: number, count: number,
 *            mode: number, range: [number, number], weights: number[][] | null}} Shown
 * A displayed layer: `count` slices of a texture array of `slices`. `weights`: RGB of each slice of a light mix.
 * @typedef {{shown: [Shown, Shown | null], exposure: number, tone: string}} Display
 * @typedef {{scale: number, x: number, y: number, split: number, grid: boolean}} Placement
 * In pixels of the canvas: size of a picture's pixel, the picture's top left corner, first column of layer b.
 */

export class Surface {
    /** @param {HTMLCanvasElement} canvas @param {() => void} onRestored after a lost context */
    constructor(canvas, onRestored) {
        this.canvas = canvas;
        /** null: no WebGL2. @type {WebGL2RenderingContext | null} */
        this.gl = canvas.getContext("webgl2", {antialias: false, depth: false, alpha: true});
        if (!this.gl) return;
        canvas.addEventListener("webglcontextlost", event => event.preventDefault());
        canvas.addEventListener("webglcontextrestored", () => {
            this.prepare();
            onRestored();
        });
        this.prepare();
    }

    get isUsable() { return Boolean(this.gl) && !this.gl.isContextLost(); }
    get largestSide() { return this.gl.getParameter(this.gl.MAX_TEXTURE_SIZE); }

    prepare() {
        const gl = this.gl;
        /** @type {Map<string, WebGLTexture>} */
        this.arrays = new Map();
        /** How often each array changed. @type {Map<string, number>} */
        this.versions = new Map();
        this.targets = [null, null];
        this.developer = program(gl, developShader);
        this.placer = program(gl, placeShader);
        if (gl.isContextLost()) return;
        gl.bindVertexArray(gl.createVertexArray());
        // Rows of tiles have any number of bytes.
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    }

    /** Of values with so many channels: internal format, format, type. Ids become colours. */
    formatOf(layer) {
        const gl = this.gl, c = layer.channels - 1;
        if (layer.kind === "id") return [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE];
        const format = [gl.RED, gl.RG, gl.RGB, gl.RGBA][c];
        return layer.format === "half"
            ? [[gl.R16F, gl.RG16F, gl.RGB16F, gl.RGBA16F][c], format, gl.HALF_FLOAT]
            : [[gl.R32F, gl.RG32F, gl.RGB32F, gl.RGBA32F][c], format, gl.FLOAT];
    }

    /** Drops all textures, before those of another size. */
    clear() {
        const gl = this.gl;
        for (const texture of this.arrays.values()) gl.deleteTexture(texture);
        for (const target of this.targets) {
            gl.deleteTexture(target?.texture ?? null);
            gl.deleteFramebuffer(target?.framebuffer ?? null);
        }
        this.arrays.clear();
        this.targets = [null, null];
    }

    /** @returns {WebGLTexture} an array of zeros where there was none */
    arrayOf(name, layer, slices) {
        const gl = this.gl;
        let texture = this.arrays.get(name);
        if (texture) return texture;
        texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
        gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, this.formatOf(layer)[0], layer.width, layer.height, slices);
        gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        this.arrays.set(name, texture);
        return texture;
    }

    /**
     * @param {{array: string, slice: number, slices: number}} place
     * @param {import("./layer_store.js").Layer} layer
     * @param {import("./tiles.js").Tile} tile
     */
    upload(place, layer, tile) {
        if (!this.isUsable) return;
        const gl = this.gl, [, format, type] = this.formatOf(layer);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.arrayOf(place.array, layer, place.slices));
        gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, tile.x, tile.y, place.slice, tile.width, tile.height, 1, format, type,
            layer.kind === "id" ? idColors(layer, tile) : tile.values);
        this.versions.set(place.array, (this.versions.get(place.array) ?? 0) + 1);
    }

    /** Pixels of one side of the wipe, 0 or 1; nothing where they are as they were. @returns its target */
    develop(side, shown, display) {
        const gl = this.gl, {width, height} = shown.layer;
        let target = this.targets[side];
        if (!target) {
            target = {texture: gl.createTexture(), framebuffer: gl.createFramebuffer(), key: ""};
            gl.activeTexture(gl.TEXTURE0);
            gl.bindTexture(gl.TEXTURE_2D, target.texture);
            gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
            gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target.texture, 0);
            this.targets[side] = target;
        }
        const {array, slices, first, count, mode, range, weights, layer} = shown, {exposure, tone} = display;
        const key = JSON.stringify([array, slices, first, count, mode, range, weights, layer.channels, exposure, tone,
            this.versions.get(array)]);
        if (key === target.key) return target;
        target.key = key;
        const at = this.developer.use();
        gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
        gl.viewport(0, 0, width, height);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.arrayOf(array, layer, slices));
        gl.uniform1i(at("layer"), 0);
        gl.uniform1i(at("mode"), mode);
        gl.uniform1i(at("first"), first);
        gl.uniform1i(at("count"), count);
        gl.uniform1i(at("channels"), layer.channels);
        gl.uniform2f(at("range"), ...range);
        gl.uniform1i(at("is_mix"), weights ? 1 : 0);
        if (weights?.length) gl.uniform3fv(at("weights"), weights.flat());
        gl.uniform1f(at("exposure"), exposure);
        gl.uniform1i(at("tone"), toneNames.indexOf(tone));
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        return target;
    }

    /** Draws on the canvas. @param {Display} display @param {Placement} placement */
    show(display, placement) {
        if (!this.isUsable) return;
        const gl = this.gl, [a, b] = display.shown, {width, height} = a.layer;
        const targets = [this.develop(0, a, display), b && this.develop(1, b, display)];
        const at = this.placer.use();
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.viewport(0, 0, this.canvas.width, this.canvas.height);
        for (const [unit, name] of ["picture_a", "picture_b"].entries()) {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(gl.TEXTURE_2D, (targets[unit] ?? targets[0]).texture);
            gl.uniform1i(at(name), unit);
        }
        gl.uniform1f(at("canvas_height"), this.canvas.height);
        gl.uniform2f(at("corner"), placement.x, placement.y);
        gl.uniform1f(at("scale"), placement.scale);
        gl.uniform2i(at("size"), width, height);
        gl.uniform1f(at("split"), b ? placement.split : 1e9);
        gl.uniform1i(at("grid"), placement.grid ? 1 : 0);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    /**
     * Displayed pixels of a rectangle of the picture.
     * @param {Display} display @param {number} split in pixels of the picture
     * @returns {Uint8ClampedArray | null} RGBA from the top
     */
    read(display, split, x, y, width, height) {
        if (!this.isUsable) return null;
        const gl = this.gl, [a, b] = display.shown;
        const side = (index, shown) => {
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.develop(index, shown, display).framebuffer);
            const rgba = new Uint8Array(4 * width * height);
            gl.readPixels(x, y, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
            return rgba;
        };
        const left = side(0, a);
        if (b) {
            const right = side(1, b);
            // A pixel belongs to the side of its centre.
            const start = Math.min(Math.max(Math.ceil(split - 0.5 - x), 0), width);
            for (let row = 0; row < height; ++row)
                left.set(right.subarray(4 * (row * width + start), 4 * (row + 1) * width), 4 * (row * width + start));
        }
        return new Uint8ClampedArray(left.buffer);
    }
}

/** @returns {{use: () => (name: string) => WebGLUniformLocation | null}} `use` gives the uniforms by name */
function program(gl, fragmentShader) {
    const linked = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        gl.attachShader(linked, shader);
    }
    gl.linkProgram(linked);
    if (!gl.isContextLost() && !gl.getProgramParameter(linked, gl.LINK_STATUS))
        throw new Error(`shader: ${gl.getProgramInfoLog(linked)}`);
    const uniforms = new Map();
    return {use() {
        gl.useProgram(linked);
        return name => {
            if (!uniforms.has(name)) uniforms.set(name, gl.getUniformLocation(linked, name));
            return uniforms.get(name);
        };
    }};
}

// RGBA of a tile of ids.
function idColors(layer, tile) {
    const copy = tile.values.slice(), ids = layer.format === "half" ? copy : new Uint32Array(copy.buffer);
    const colors = new Uint8Array(4 * tile.width * tile.height);
    for (let i = 0; i < tile.width * tile.height; ++i)
        colors.set([...idColor(ids[i * layer.channels]), 255], 4 * i);
    return colors;
}

/** The shader's mode of a layer's kind. */
export const modeOfKind = {color: modes.color, error: modes.logScale, ratio: modes.logScale, vector: modes.vector,
    scalar: modes.scale, count: modes.scale, id: modes.encoded, z: modes.diverging};
