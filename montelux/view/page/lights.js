// Sliders of the lights: stops, off, tint. The picture is mixed in the shader.

import {mostLights} from "./shader.js";
import {stops} from "./text.js";

const linear = code => code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4;

/** @param {string} hex "#rrggbb" @returns {number[]} linear sRGB */
const tintOf = hex => [1, 3, 5].map(i => linear(parseInt(hex.slice(i, i + 2), 16) / 255));

export class Lights {
    /**
     * @param {HTMLElement} element
     * @param {{onChange: () => void, send: (message: object) => boolean}} events
     */
    constructor(element, events) {
        this.list = element.querySelector(".list");
        this.start = element.querySelector(".start");
        this.reset = element.querySelector(".reset");
        this.events = events;
        /** Settings survive restarts. @type {Map<string, {stops: number, off: boolean, tint: string}>} */
        this.settings = new Map();
        this.names = [];
        this.element = element;
        this.start.addEventListener("click", () => events.send({type: "light groups", on: true}));
        this.reset.addEventListener("click", () => {
            this.settings.clear();
            this.build();
            events.onChange();
        });
    }

    /** @param {string[]} names of lights that have layers @param {boolean} canGroup */
    update(names, canGroup) {
        this.element.hidden = !names.length && !canGroup;
        this.start.hidden = names.length > 0;
        this.reset.hidden = !names.length;
        this.element.querySelector(".note").hidden = names.length > 0;
        if (names.join("\n") === this.names.join("\n")) return;
        this.names = names.slice(0, mostLights);
        this.build();
    }

    of(name) { return this.settings.get(name) ?? {stops: 0, off: false, tint: "#ffffff"}; }

    /** @returns {number[][]} RGB factor of each light */
    weights() {
        return this.names.map(name => {
            const {stops: s, off, tint} = this.of(name);
            return off ? [0, 0, 0] : tintOf(tint).map(v => v * 2 ** s);
        });
    }

    change(name, values) {
        this.settings.set(name, {...this.of(name), ...values});
        this.events.onChange();
    }

    build() {
        this.list.replaceChildren(...this.names.map(name => this.row(name)));
    }

    row(name) {
        const setting = this.of(name);
        const row = document.createElement("div");
        row.className = "light";
        const title = document.createElement("span");
        title.className = "name";
        title.textContent = name;
        title.title = name;
        const input = (type, label, values) => {
            const element = Object.assign(document.createElement("input"), {type, ...values});
            element.setAttribute("aria-label", `${label} of ${name}`);
            return element;
        };
        const slider = input("range", "Stops", {min: -8, max: 8, step: 0.1, value: setting.stops});
        const value = document.createElement("output");
        value.textContent = stops(setting.stops);
        const tint = input("color", "Tint", {value: setting.tint});
        const on = input("checkbox", "Light", {checked: !setting.off});
        on.title = "On or off";
        slider.addEventListener("input", () => {
            value.textContent = stops(Number(slider.value));
            this.change(name, {stops: Number(slider.value)});
        });
        slider.addEventListener("dblclick", () => {
            slider.value = 0;
            slider.dispatchEvent(new Event("input"));
        });
        tint.addEventListener("input", () => this.change(name, {tint: tint.value}));
        on.addEventListener("change", () => this.change(name, {off: !on.checked}));
        row.append(on, title, tint, slider, value);
        return row;
    }
}
