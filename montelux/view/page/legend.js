// The legend of false colours: a bar with numbers.

import {falseColor, unknownColor} from "./false_colors.js";
import {modes} from "./shader.js";
import {percent, significant} from "./text.js";

const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

export class Legend {
    /** @param {HTMLElement} element with a .bar and .ticks */
    constructor(element) {
        this.element = element;
        this.text = "";
    }

    /** @param {import("./surface.js").Shown[]} shown at most one legend: of the first layer in false colours */
    update(shown) {
        const scaled = shown.find(s => s && [modes.scale, modes.logScale, modes.diverging].includes(s.mode));
        this.element.hidden = !scaled;
        if (!scaled) return;
        const {mode, range: [low, high], layer} = scaled;
        const text = `${layer.name} ${mode} ${low} ${high}`;
        if (text === this.text) return;
        this.text = text;
        const map = mode === modes.diverging ? "diverging" : "viridis";
        const colors = Array.from({length: 21}, (_, i) => css(falseColor(map, i / 20)));
        this.element.querySelector(".bar").style.background = `linear-gradient(to right, ${colors.join(", ")})`;
        this.element.querySelector(".unknown i").style.background = css(unknownColor);
        this.element.querySelector(".name").textContent = {error: "error of luminance", z: "z-score"}[layer.kind]
            ?? layer.name;
        const at = share => mode === modes.logScale ? low * (high / low) ** share : low + share * (high - low);
        const format = v => layer.kind === "ratio" ? percent(v, 1) : significant(v, 2);
        // Logarithmic scales of whole decades get a number at each.
        const decades = Math.round(Math.log10(high / low) * 2) / 2;
        const parts = mode === modes.logScale && Number.isInteger(decades) && decades <= 5 ? Math.max(1, decades) : 2;
        this.element.querySelector(".ticks").replaceChildren(...Array.from({length: parts + 1}, (_, i) => {
            const tick = document.createElement("span");
            tick.textContent = format(at(i / parts));
            return tick;
        }));
    }
}
