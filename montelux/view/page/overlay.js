// Above the picture: pixel values at high zoom and the mark of the chosen pixel.

import {significant} from "./text.js";

/** From this zoom on, in CSS pixels per pixel, values are drawn over the pixels. */
export const valueScale = 32;

export class Overlay {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        this.canvas = canvas;
        this.context = canvas.getContext("2d");
        this.isClear = true;
    }

    /**
     * @param {import("./view_transform.js").ViewTransform} view
     * @param {{x: number, y: number} | null} chosen
     * @param {(x: number, y: number) => number[] | null} valuesAt
     */
    draw(view, chosen, valuesAt) {
        const ratio = devicePixelRatio, c = this.context;
        if (this.isClear && !chosen && view.scale < valueScale) return;
        c.setTransform(1, 0, 0, 1, 0, 0);
        c.clearRect(0, 0, this.canvas.width, this.canvas.height);
        c.scale(ratio, ratio);
        this.isClear = true;
        if (view.scale >= valueScale) this.drawValues(view, valuesAt);
        if (chosen) this.drawMark(view, chosen);
    }

    drawMark(view, chosen) {
        const c = this.context, at = view.toStage(chosen.x, chosen.y), side = Math.max(view.scale, 5);
        const x = at.x + (view.scale - side) / 2, y = at.y + (view.scale - side) / 2;
        for (const [color, grow] of [["#000", 1.5], ["#fff", 0.5]]) {
            c.strokeStyle = color;
            c.lineWidth = 1;
            c.strokeRect(x - grow, y - grow, side + 2 * grow, side + 2 * grow);
        }
        this.isClear = false;
    }

    drawValues(view, valuesAt) {
        const c = this.context, {scale, stage, picture} = view;
        const size = Math.min(14, scale / 4.2);
        c.font = `${size}px ui-monospace, monospace`;
        c.textAlign = "center";
        c.textBaseline = "middle";
        c.lineJoin = "round";
        c.lineWidth = Math.max(2, size / 4);
        c.strokeStyle = "rgb(0 0 0 / 75%)";
        c.fillStyle = "#fff";
        const first = (v) => Math.max(0, Math.floor(-v / scale));
        const last = (v, length, count) => Math.min(count, Math.ceil((length - v) / scale));
        for (let y = first(view.y); y < last(view.y, stage.height, picture.height); ++y)
            for (let x = first(view.x); x < last(view.x, stage.width, picture.width); ++x) {
                const values = valuesAt(x, y);
                if (!values) continue;
                const at = view.toStage(x + 0.5, y + 0.5);
                values.forEach((v, i) => {
                    const text = compact(v), line = at.y + (i - (values.length - 1) / 2) * size * 1.15;
                    c.strokeText(text, at.x, line, scale - 2);
                    c.fillText(text, at.x, line, scale - 2);
                });
            }
        this.isClear = false;
    }
}

// At most six characters where possible.
function compact(v) {
    if (Number.isInteger(v) && Math.abs(v) < 1e6) return String(v);
    return significant(v, Math.abs(v) >= 0.01 || v === 0 ? 3 : 2);
}
