// Histogram of the pixels' relative errors over a logarithmic axis.

import {svg} from "./svg.js";
import {percent} from "./text.js";

const width = 340, height = 120, left = 24, right = 26, top = 8, bottom = 24;

export class Histogram {
    /** @param {HTMLElement} element */
    constructor(element) {
        this.element = element;
    }

    /** @param {{least: number, most: number, counts: number[], infinite: number} | null} histogram */
    draw(histogram) {
        const counts = histogram?.counts ?? [];
        const total = counts.reduce((sum, n) => sum + n, 0);
        if (!total) {
            this.element.replaceChildren();
            return;
        }
        const {least, most, infinite} = histogram, largest = Math.max(...counts);
        const bar = (width - left - right) / counts.length;
        const root = svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img",
            "aria-label": `Histogram of relative errors; median about ${percent(median(histogram, total), 1)}`});
        counts.forEach((n, i) => {
            const size = (height - top - bottom) * n / largest;
            if (n) root.append(svg("rect", {class: "count", x: left + i * bar, width: Math.max(bar - 1, 0.5),
                y: height - bottom - size, height: size}));
        });
        root.append(svg("line", {class: "axis", x1: left, x2: width - right, y1: height - bottom,
            y2: height - bottom}));
        for (let power = Math.ceil(least); power <= most; ++power) {
            const x = left + (width - left - right) * (power - least) / (most - least);
                root.append(svg("line", {class: "axis", x1: x, x2: x, y1: height - bottom, y2: height - bottom + 4}),
                svg("text", {x, y: height - 8, "text-anchor": "middle"}, percent(10 ** power, 1)));
        }
        const caption = document.createElement("p");
        caption.className = "note";
        caption.textContent = "Relative errors of the pixels." +
            (infinite ? ` Not known yet: ${percent(infinite / (total + infinite))}.` : "");
        this.element.replaceChildren(root, caption);
    }
}

function median({least, most, counts}, total) {
    let sum = 0;
    const bin = counts.findIndex(n => (sum += n) >= total / 2);
    return 10 ** (least + (bin + 0.5) * (most - least) / counts.length);
}
