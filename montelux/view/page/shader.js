// The shaders: layers to displayed pixels at the picture's size, and those onto the canvas at any zoom.

import {falseColorGlsl} from "./false_colors.js";
import {toneGlsl} from "./tone.js";

/** Most lights that can be mixed: the size of an array of uniforms. */
export const mostLights = 128;

/** How a layer is displayed, as the shader's `mode`. */
export const modes = {color: 0, scale: 1, logScale: 2, diverging: 3, vector: 4, encoded: 5};

/** One triangle that covers the viewport. */
export const vertexShader = `#version 300 es
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

/** Tone curve, false colours and light mix. Row 0 of the target is the picture's top row. */
export const developShader = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DArray;
uniform sampler2DArray layer;
uniform int mode, first, count, channels;
// Ends of the scale.
uniform vec2 range;
// One for each slice of a light mix.
uniform vec3 weights[${mostLights}];
uniform bool is_mix;
uniform float exposure;
uniform int tone;
out vec4 color;
${toneGlsl}
${falseColorGlsl}
bool is_finite(float v) { return (floatBitsToUint(v) & 0x7f800000u) != 0x7f800000u; }

vec4 texel(ivec2 p) {
    if (!is_mix) return texelFetch(layer, ivec3(p, first), 0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; ++i)
        // A light that is off adds nothing, not even NaN.
        if (weights[i] != vec3(0.0)) sum += weights[i] * texelFetch(layer, ivec3(p, first + i), 0).rgb;
    return vec4(sum, 1.0);
}

vec3 displayed(vec4 v) {
    if (mode == ${modes.color}) return tone_curve(channels < 3 ? v.rrr : v.rgb, exposure, tone);
    if (mode == ${modes.encoded}) return v.rgb;
    if (!is_finite(v.r)) return unknown_color;
    if (mode == ${modes.vector}) return clamp(0.5 * v.rgb + 0.5, 0.0, 1.0);
    float t = (v.r - range.x) / (range.y - range.x);
    if (mode == ${modes.diverging}) return diverging_color(t);
    if (mode == ${modes.logScale})
        t = v.r > 0.0 ? log2(v.r / range.x) / log2(range.y / range.x) : 0.0;
    return viridis_color(t);
}

void main() { color = vec4(displayed(texel(ivec2(gl_FragCoord.xy))), 1.0); }`;

/** Displayed pixels of one or two layers onto the canvas. */
export const placeShader = `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D picture_a, picture_b;
// In pixels of the canvas, from its top left: its height, the picture's corner, the size of a picture's pixel.
uniform float canvas_height;
uniform vec2 corner;
uniform float scale;
uniform ivec2 size;
// The first column of the canvas that shows layer b.
uniform float split;
uniform bool grid;
out vec4 color;

vec3 at(ivec2 p, bool b) { return b ? texelFetch(picture_b, p, 0).rgb : texelFetch(picture_a, p, 0).rgb; }

void main() {
    vec2 target = vec2(gl_FragCoord.x, canvas_height - gl_FragCoord.y);
    vec2 image = (target - corner) / scale;
    color = vec4(0.0);
    if (any(lessThan(image, vec2(0.0))) || any(greaterThanEqual(image, vec2(size)))) return;
    bool b = target.x >= split;
    if (scale >= 0.99) {
        color = vec4(at(ivec2(image), b), 1.0);
    } else {
        // A reduced picture shows means of displayed pixels; single ones would look noisier than the picture is.
        int n = clamp(int(ceil(1.0 / scale)), 2, 6);
        vec3 sum = vec3(0.0);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                vec2 shift = (vec2(i, j) + 0.5) / float(n) - 0.5;
                sum += at(clamp(ivec2(floor(image + shift / scale)), ivec2(0), size - 1), b);
            }
        color = vec4(sum / float(n * n), 1.0);
    }
    vec2 inside = fract(image) * scale;
    if (grid && min(inside.x, inside.y) < 1.0) color.rgb = mix(color.rgb, vec3(0.5), 0.5);
}`;
