// Values of the pixel under the pointer, or of the chosen one: mean ± error, samples, layers.

import {numberOf, percent, sampleCount, significant, withError} from "./text.js";

const interval = 120, refreshInterval = 1000, patience = 2000; // ms

export class Readout {
    /**
     * @param {HTMLElement} element
     * @param {{send: (message: object) => boolean, localValues: (x: number, y: number) => [string, number[]][],
     *          kindOf: (name: string) => string | undefined,
     *          filmOf: (x: number, y: number) => [number, number]}} source
     */
    constructor(element, source) {
        this.element = element;
        this.source = source;
        /** @type {{x: number, y: number} | null} */
        this.pixel = null;
        this.answer = null;
        this.asked = 0;
        this.waits = false;
    }

    /** @param {{x: number, y: number} | null} pixel */
    show(pixel) {
        if (pixel?.x === this.pixel?.x && pixel?.y === this.pixel?.y) return;
        this.pixel = pixel;
        this.answer = null;
        this.draw();
        this.ask();
    }

    /** New samples: asks again. */
    refresh() {
        this.draw();
        this.ask(refreshInterval);
    }

    // At most one open request, and none sooner than `least` after the last one.
    ask(least = interval) {
        clearTimeout(this.timer);
        if (!this.pixel) return;
        const now = performance.now(), since = now - this.asked;
        const delay = this.waits && since < patience ? patience - since : least - since;
        if (delay > 0) {
            this.timer = setTimeout(() => this.ask(), delay);
            return;
        }
        this.asked = now;
        this.waits = this.source.send({type: "pixel", x: this.pixel.x, y: this.pixel.y});
    }

    /** @param {object} message of type "pixel" */
    receive(message) {
        this.waits = false;
        if (!this.pixel) return;
        if (message.x !== this.pixel.x || message.y !== this.pixel.y) {
            this.ask();
            return;
        }
        this.answer = message;
        this.draw();
    }

    /** A new connection: the open request is lost. */
    reset() {
        this.waits = false;
        this.ask();
    }

    text(name, values) {
        const isRatio = this.source.kindOf(name) === "ratio";
        return values.map(v => isRatio ? percent(v) : significant(v, 4)).join("  ");
    }

    draw() {
        if (!this.pixel) {
            this.element.replaceChildren(note("Point at a pixel, or choose one by a click."));
            return;
        }
        const {x, y} = this.pixel, [filmX, filmY] = this.source.filmOf(x, y);
        const list = document.createElement("dl");
        const row = (name, text, cls) => {
            const term = document.createElement("dt"), value = document.createElement("dd");
            term.textContent = name;
            value.textContent = text;
            if (cls) value.className = cls;
            list.append(term, value);
        };
        row("pixel", `${filmX}, ${filmY}`);
        const answer = this.answer;
        if (answer) {
            const mean = answer.mean.map(numberOf), error = answer.error.map(numberOf);
            ["red", "green", "blue"].forEach((name, c) => row(name, withError(mean[c], error[c]), `mean ${name}`));
            row("samples", sampleCount(numberOf(answer.samples)));
        }
        const shown = new Set();
        for (const [name, values] of this.source.localValues(x, y)) {
            shown.add(name);
            if (answer && name === "mean") continue;
            row(name, this.text(name, values));
        }
        for (const [name, values] of Object.entries(answer?.layers ?? {}))
            if (!shown.has(name) && name !== "mean" && name !== "samples")
                row(name, this.text(name, values.map(numberOf)));
        this.element.replaceChildren(list);
    }
}

function note(text) {
    const p = document.createElement("p");
    p.className = "note";
    p.textContent = text;
    return p;
}
