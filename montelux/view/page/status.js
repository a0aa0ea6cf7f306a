// The status line: state, progress, error, samples.

import {duration, percent, sampleCount, short, wholePercent} from "./text.js";

const endings = {samples: "all samples taken", error: "error target met", time: "time limit reached",
    cancelled: "stopped"};

/** @returns {string} the state in words */
export function stateText(progress) {
    if (!progress) return "Waiting for the program";
    if (progress.state === "ended")
        return endings[progress.ended_by] ? `Ended: ${endings[progress.ended_by]}` : "Ended";
    return {preparing: "Preparing", rendering: "Rendering", paused: "Paused"}[progress.state] ?? progress.state;
}

export class Status {
    /** @param {HTMLElement} element of the line */
    constructor(element) {
        this.part = name => element.querySelector(`.${name}`);
        this.announced = "";
        this.element = element;
    }

    /** @param {object | null} progress @param {string} name of the scene @param {string} connection */
    update(progress, name, connection) {
        const share = progress?.share ?? 0;
        const isLost = connection === "lost" || connection === "ended";
        const isRunning = !isLost && (progress?.state === "rendering" || progress?.state === "paused");
        this.part("percent").textContent = wholePercent(share);
        this.part("bar").value = share;
        this.element.dataset.state = isLost ? "lost" : progress?.state ?? "preparing";
        const set = (part, text) => {
            const element = this.part(part);
            element.hidden = text === null;
            if (text !== null && element.textContent !== text) element.textContent = text;
        };
        const known = v => typeof v === "number" && Number.isFinite(v);
        set("elapsed", known(progress?.seconds) ? `${duration(progress.seconds)} elapsed` : null);
        set("left", isRunning && known(progress?.seconds_left) ? `${duration(progress.seconds_left)} left` : null);
        set("error", known(progress?.error) ? `error ± ${percent(progress.error)}${targetText(progress)}`
            : known(progress?.target_error) ? `error not known yet${targetText(progress)}` : null);
        set("samples", known(progress?.samples) ? `${sampleCount(progress.samples)} samples per pixel` : null);
        set("speed", isRunning && known(progress?.samples_per_second)
            ? `${short(progress.samples_per_second)} samples/s` : null);
        set("visible", known(progress?.visible) ? `noise visible in ${percent(progress.visible)} of the pixels` : null);

        const title = progress?.state === "ended" ? `${name} · ${stateText(progress).toLowerCase()}`
            : name ? `${wholePercent(share)} ${name}` : "Montelux";
        if (document.title !== title) document.title = title;
        // Screen readers announce each change of this text; numbers would never let them finish.
        const state = connection === "ended" ? "The program has ended. The picture stays."
            : connection === "lost" ? "Connection lost. The picture stays; reconnecting." : stateText(progress);
        if (state !== this.announced) this.part("state").textContent = this.announced = state;
    }
}

function targetText({target_error: target, target_quantile: quantile}) {
    if (typeof target !== "number") return "";
    const share = typeof quantile === "number" ? ` for ${percent(quantile)} of the pixels` : "";
    return `, target ${percent(target)}${share}`;
}
