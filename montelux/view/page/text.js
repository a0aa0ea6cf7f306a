// Numbers and durations as text.

/** Numbers that JSON cannot hold are strings in the protocol. @returns {number} */
export function numberOf(v) {
    if (typeof v === "number") return v;
    return {inf: Infinity, "-inf": -Infinity}[v] ?? NaN;
}

const special = v => Number.isNaN(v) ? "nan" : v > 0 ? "inf" : "-inf";

/** @returns {string} `digits` significant digits; powers of ten far from 1 */
export function significant(v, digits = 3) {
    if (!Number.isFinite(v)) return special(v);
    if (v === 0) return "0";
    const size = Math.abs(v);
    if (size >= 1e6 || size < 1e-4) return v.toExponential(digits - 1).replace("e+", "e");
    const text = v.toPrecision(digits);
    return text.includes("e") ? String(Number(text)) : text;
}

/** @returns {string} the error with two digits, the mean to the same decimal place */
export function withError(mean, error) {
    if (!Number.isFinite(mean) || !Number.isFinite(error)) return `${significant(mean, 4)} ± ${significant(error, 2)}`;
    if (error <= 0) return `${significant(mean, 4)} ± 0`;
    const decimals = 1 - Math.floor(Math.log10(error));
    if (decimals < 0 || decimals > 7) return `${significant(mean, 4)} ± ${significant(error, 2)}`;
    return `${mean.toFixed(decimals)} ± ${error.toFixed(decimals)}`;
}

/** @param {number} share 1 is 100 % */
export function percent(share, digits = 2) {
    const v = 100 * share;
    if (!Number.isFinite(v)) return special(v);
    return `${Math.abs(v) >= 10 ** digits ? Math.round(v) : significant(v, digits)} %`;
}

/** Whole percents. */
export const wholePercent = share => `${Math.floor(100 * share + 1e-9)} %`;

/** @returns {string} "12.3 s", "4:05" (minutes and seconds) or "2:04:05" */
export function duration(seconds) {
    if (!Number.isFinite(seconds)) return special(seconds);
    if (seconds < 10) return `${seconds.toFixed(1)} s`;
    const s = Math.round(seconds);
    if (s < 60) return `${s} s`;
    const two = v => String(v).padStart(2, "0");
    if (s < 3600) return `${Math.floor(s / 60)}:${two(s % 60)}`;
    return `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
}

/** @returns {string} "1.2 M" and the like */
export function short(v) {
    if (!Number.isFinite(v)) return special(v);
    for (const [size, name] of [[1e9, " G"], [1e6, " M"], [1e3, " k"]])
        if (v >= 0.9995 * size) return significant(v / size) + name;
    return significant(v);
}

/** Samples of a pixel or of the mean of all pixels. */
export const sampleCount = v => Number.isInteger(v) ? String(v) : v >= 100 ? v.toFixed(0) : v.toFixed(1);

/** @returns {string} "1.25 stops" */
export const stops = v => `${v > 0 ? "+" : ""}${Number(v.toFixed(2))}`;
