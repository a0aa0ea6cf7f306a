// SVG elements and logarithmic axes for the charts.

/** @returns {SVGElement} */
export function svg(name, attributes = {}, text) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    return element;
}

/** @returns {(v: number) => number} a logarithmic axis */
export function logAxis(least, most, from, to) {
    const base = Math.log10(least), span = Math.log10(most) - base;
    return v => from + (to - from) * (Math.log10(v) - base) / span;
}

/** @returns {number[]} about `count` round numbers from least to most: powers of ten, or with 2 and 5 */
export function logTicks(least, most, count = 5) {
    const decades = Math.log10(most / least);
    const steps = decades < 1.2 ? [1, 2, 5] : decades < 2.4 ? [1, 3] : [1];
    const stride = Math.max(1, Math.ceil(decades / count));
    const ticks = [];
    for (let power = Math.floor(Math.log10(least)); power <= Math.log10(most); power += stride)
        for (const step of steps) {
            const v = step * 10 ** power;
            if (v >= least * (1 - 1e-9) && v <= most * (1 + 1e-9)) ticks.push(v);
        }
    return ticks;
}
