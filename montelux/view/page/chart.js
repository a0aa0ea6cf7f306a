// Error of the picture against time, both logarithmic, with the target and the forecast by 1 / sqrt(t).

import {logAxis, logTicks, svg} from "./svg.js";
import {duration, percent} from "./text.js";

const width = 340, height = 190, left = 50, right = 12, top = 10, bottom = 26;
const mostPoints = 400;

/** @returns {number | null} seconds at which the error falls to the target; null: unknown or already reached */
export function forecast(curve, target) {
    const last = curve.at(-1);
    if (!last || !(target > 0) || !(last[1] > target)) return null;
    return last[0] * (last[1] / target) ** 2;
}

export class ErrorChart {
    /** @param {HTMLElement} element */
    constructor(element) {
        this.element = element;
    }

    /**
     * @param {[number, number][]} points seconds and error
     * @param {number | null} target
     * @param {boolean} goesOn whether a forecast makes sense
     */
    draw(points, target, goesOn) {
        const curve = points.filter(([t, e]) => t > 0 && e > 0 && Number.isFinite(e));
        if (!curve.length) {
            const p = document.createElement("p");
            p.className = "note";
            p.textContent = "The error is not known yet.";
            this.element.replaceChildren(p);
            return;
        }
        const met = goesOn ? forecast(curve, target) : null;
        const last = curve.at(-1);
        // A far forecast leaves room for the curve.
        const end = met && met < 1000 * last[0] ? met : last[0];
        const times = [curve[0][0], end], errors = curve.map(p => p[1]).concat(target ?? []);
        const [t0, t1] = [times[0] / 1.1, Math.max(times[1] * 1.1, times[0] * 2)];
        const [e0, e1] = [Math.min(...errors) / 1.3, Math.max(...errors) * 1.3];
        const x = logAxis(t0, t1, left, width - right), y = logAxis(e0, e1, height - bottom, top);

        const parts = [];
        for (const t of logTicks(t0, t1, 4)) {
            parts.push(svg("line", {class: "grid", x1: x(t), x2: x(t), y1: top, y2: height - bottom}));
            parts.push(svg("text", {x: x(t), y: height - 9, "text-anchor": "middle"}, timeLabel(t)));
        }
        for (const e of logTicks(e0, e1, 5)) {
            parts.push(svg("line", {class: "grid", x1: left, x2: width - right, y1: y(e), y2: y(e)}));
            parts.push(svg("text", {x: left - 6, y: y(e) + 3.5, "text-anchor": "end"}, percent(e, 1)));
        }
        if (target) {
            const at = y(target);
            parts.push(svg("line", {class: "target", x1: left, x2: width - right, y1: at, y2: at}));
            // Above the line where there is room.
            parts.push(svg("text", {class: "target", x: left + 4, y: at > top + 16 ? at - 4 : at + 12},
                `target ${percent(target)}`));
        }
        if (met) {
            const stop = Math.min(met, end * 1.1), e = last[1] * Math.sqrt(last[0] / stop);
            parts.push(svg("line", {class: "forecast", x1: x(last[0]), y1: y(last[1]), x2: x(stop), y2: y(e)}));
        }
        const stride = Math.ceil(curve.length / mostPoints);
        const line = curve.filter((_, i) => i % stride === 0 || i === curve.length - 1);
        parts.push(svg("polyline", {class: "curve", points: line.map(([t, e]) => `${x(t)},${y(e)}`).join(" ")}));
        parts.push(svg("circle", {class: "last", cx: x(last[0]), cy: y(last[1]), r: 3}));

        const text = met ? `Forecast: ${percent(target)} after ${duration(met)}.`
            : target && last[1] <= target ? `The target of ${percent(target)} is met.` : "";
        const root = svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img",
            "aria-label": `Error ${percent(last[1])} after ${duration(last[0])}. ${text}`});
        root.append(...parts);
        const caption = document.createElement("p");
        caption.className = "note";
        caption.textContent = `Error of the picture against time. ${text}`;
        this.element.replaceChildren(root, caption);
    }
}

function timeLabel(t) {
    if (t < 60) return `${Number(t.toPrecision(2))} s`;
    if (t < 3600) return `${Number((t / 60).toPrecision(2))} min`;
    return `${Number((t / 3600).toPrecision(2))} h`;
}
