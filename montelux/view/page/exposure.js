// Exposure and tone curve: act in the shader only, without a message to the program.

import {toneLabels, toneNames} from "./tone.js";
import {stops} from "./text.js";

const step = 0.5;

export class Exposure {
    /** @param {Document} document @param {() => void} onChange */
    constructor(document, onChange) {
        this.slider = document.getElementById("exposure");
        this.output = document.getElementById("exposure-value");
        this.select = document.getElementById("tone");
        this.auto = document.getElementById("auto-exposure");
        this.onChange = onChange;
        /** In stops. */
        this.exposure = 0;
        this.tone = "srgb";
        /** Follows the first picture until that is complete. */
        this.isAutomatic = false;
        this.isChosen = false;
        for (const name of toneNames) this.select.add(new Option(toneLabels[name], name));
        this.slider.addEventListener("input", () => this.set(Number(this.slider.value)));
        this.slider.addEventListener("dblclick", () => this.set(0));
        this.select.addEventListener("change", () => this.setTone(this.select.value));
        this.show();
    }

    /** Values of the first scene message; later ones keep what the person chose. */
    start(scene) {
        if (this.isChosen) return;
        this.isChosen = true;
        this.isAutomatic = typeof scene.exposure !== "number";
        if (!this.isAutomatic) this.exposure = scene.exposure;
        if (toneNames.includes(scene.tone)) this.tone = scene.tone;
        this.show();
        this.onChange();
    }

    /** By a person: ends the automatic choice. */
    set(exposure) {
        this.isAutomatic = false;
        this.apply(exposure);
    }

    change(direction) { this.set(Math.round(this.exposure / step + direction) * step); }

    /** The exposure that brings a luminance to 0.18. @param {number} luminance */
    adapt(luminance) {
        if (luminance > 0 && luminance < Infinity) this.apply(Math.log2(0.18 / luminance));
    }

    apply(exposure) {
        const rounded = Math.round(Math.min(Math.max(exposure, -60), 60) * 100) / 100;
        if (rounded === this.exposure) return;
        this.exposure = rounded;
        this.show();
        this.onChange();
    }

    setTone(tone) {
        this.tone = tone;
        this.show();
        this.onChange();
    }

    nextTone() { this.setTone(toneNames[(toneNames.indexOf(this.tone) + 1) % toneNames.length]); }

    show() {
        this.slider.value = this.exposure;
        this.output.textContent = stops(this.exposure);
        this.slider.setAttribute("aria-valuetext", `${stops(this.exposure)} stops`);
        this.select.value = this.tone;
    }
}
