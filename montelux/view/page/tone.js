// Tone curves in GLSL: the formulas and constants of montelux/image/tone_curve.cpp, which names their sources.

/** In the order of the shader's `tone`. */
export const toneNames = ["linear", "srgb", "aces", "agx", "filmic"];

/** What people read. */
export const toneLabels = {linear: "Linear", srgb: "sRGB", aces: "ACES", agx: "AgX", filmic: "Filmic"};

/** vec3 tone_curve(vec3 rgb, float exposure, int tone): linear sRGB light to code values in [0, 1]. */
export const toneGlsl = `
float encoded(float v) {
    if (!(v > 0.0)) return 0.0;
    if (v >= 1.0) return 1.0;
    return v <= 0.04045 / 12.92 ? v * 12.92 : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}
vec3 encoded(vec3 v) { return vec3(encoded(v.r), encoded(v.g), encoded(v.b)); }

// GLSL matrices are written by columns: v * m multiplies by the rows below.
const mat3 aces_in = mat3(0.59719, 0.35458, 0.04823,
                          0.07600, 0.90834, 0.01566,
                          0.02840, 0.13383, 0.83777);
const mat3 aces_out = mat3(1.60475, -0.53108, -0.07367,
                           -0.10208, 1.10813, -0.00605,
                           -0.00327, -0.07276, 1.07602);
vec3 aces(vec3 light) {
    vec3 v = light * aces_in;
    vec3 fit = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return encoded(fit * aces_out);
}

const mat3 agx_in = mat3(0.842479062253094, 0.0784335999999992, 0.0792237451477643,
                         0.0423282422610123, 0.878468636469772, 0.0791661274605434,
                         0.0423756549057051, 0.0784336, 0.879142973793104);
const mat3 agx_out = mat3(1.19687900512017, -0.0980208811401368, -0.0990297440797205,
                          -0.0528968517574562, 1.15190312990417, -0.0989611768448433,
                          -0.0529716355144438, -0.0980434501171241, 1.15107367264116);
vec3 agx(vec3 light) {
    const float least = -12.47393, most = 4.026069;
    // log2(0) is undefined in GLSL; 1e-5 is below 2^least.
    vec3 x = (clamp(log2(max(light * agx_in, vec3(1e-5))), least, most) - least) / (most - least);
    vec3 contrast = -0.00232 +
        x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    vec3 v = clamp(contrast * agx_out, 0.0, 1.0);
    return encoded(mix(vec3(0.0), pow(max(v, vec3(1e-12)), vec3(2.2)), vec3(greaterThan(v, vec3(0.0)))));
}

vec3 filmic_curve(vec3 x) {
    const float a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - d * e / (d * f);
}
vec3 filmic(vec3 light) { return encoded(filmic_curve(2.0 * light) / filmic_curve(vec3(11.2)).r); }

// NaN and negative components count as 0. Beyond the bound all curves have ended.
float light_of(float v, float scale) { return v > 0.0 ? min(v * scale, 1e9) : 0.0; }

vec3 tone_curve(vec3 rgb, float exposure, int tone) {
    float scale = exp2(exposure);
    vec3 light = vec3(light_of(rgb.r, scale), light_of(rgb.g, scale), light_of(rgb.b, scale));
    if (tone == 0) return min(light, 1.0);
    if (tone == 2) return aces(light);
    if (tone == 3) return agx(light);
    if (tone == 4) return filmic(light);
    return encoded(light);
}
`;
