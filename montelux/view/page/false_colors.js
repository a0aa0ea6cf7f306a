// False colours: viridis for magnitudes and a diverging map (ColorBrewer RdBu) for z-scores, by tables.

// Encoded sRGB at equal steps from 0 to 1, linear between.
const viridis = ["440154", "482475", "414487", "355f8d", "2a788e", "21918c", "22a884", "44bf70", "7ad151", "bddf26",
    "fde725"];
const diverging = ["053061", "2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b",
    "67001f"];

/** Of pixels whose value is not finite, 0 to 255. */
export const unknownColor = [128, 128, 128];

const channels = hex => [0, 2, 4].map(i => parseInt(hex.slice(i, i + 2), 16));

/** @param {"viridis" | "diverging"} map @param {number} t in [0, 1] @returns {number[]} sRGB, 0 to 255 */
export function falseColor(map, t) {
    const table = map === "diverging" ? diverging : viridis;
    const at = Math.min(Math.max(t, 0), 1) * (table.length - 1);
    const i = Math.min(Math.floor(at), table.length - 2);
    const [low, high] = [channels(table[i]), channels(table[i + 1])];
    return low.map((v, c) => v + (at - i) * (high[c] - v));
}

/** Of a 32-bit id: a bright colour; neighbouring ids differ. @returns {number[]} sRGB, 0 to 255 */
export function idColor(id) {
    if (id === 0xffffffff) return unknownColor; // no id
    let h = id + 0x9e3779b9 | 0;
    h = Math.imul(h ^ h >>> 16, 0x85ebca6b);
    h = Math.imul(h ^ h >>> 13, 0xc2b2ae35);
    h ^= h >>> 16;
    return [h, h >>> 8, h >>> 16].map(v => 40 + (v & 255) * 200 / 255 | 0);
}

const glslTable = (name, table) => `const vec3 ${name}[${table.length}] = vec3[](${
    table.map(hex => `vec3(${channels(hex).map(v => `${v}.0`)})`).join(", ")});
vec3 ${name}_color(float t) {
    float at = clamp(t, 0.0, 1.0) * ${table.length - 1}.0;
    int i = min(int(at), ${table.length - 2});
    return mix(${name}[i], ${name}[i + 1], at - float(i)) / 255.0;
}
`;

/** vec3 viridis_color(float), vec3 diverging_color(float) and vec3 unknown_color. */
export const falseColorGlsl = glslTable("viridis", viridis) + glslTable("diverging", diverging) +
    `const vec3 unknown_color = vec3(${unknownColor.map(v => `${v}.0`)}) / 255.0;\n`;
