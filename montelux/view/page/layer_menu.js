// The selects of layers: all layers of the scene and the light mix.

import {lightMix} from "./display.js";

/**
 * @param {HTMLSelectElement} select
 * @param {string[]} names of the layers
 * @param {boolean} hasMix
 * @param {string} wanted stays selected where it exists
 * @param {string} fallback
 */
export function fillLayers(select, names, hasMix, wanted, fallback) {
    const all = hasMix ? [names[0], lightMix, ...names.slice(1)] : names;
    select.replaceChildren(...all.map(name => new Option(name, name)));
    select.value = all.includes(wanted) ? wanted : fallback;
}

/** Selects the option before or after, and tells its listeners. @param {HTMLSelectElement} select */
export function stepOption(select, by) {
    const count = select.options.length;
    if (!count) return;
    select.selectedIndex = (select.selectedIndex + by + count) % count;
    select.dispatchEvent(new Event("change"));
}
