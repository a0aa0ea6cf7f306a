// Zoom and position of the picture on the stage, in CSS pixels.

const leastScale = 1 / 64, mostScale = 256;

export class ViewTransform {
    constructor() {
        /** CSS pixels per pixel of the picture. */
        this.scale = 1;
        /** Top left corner of the picture on the stage. */
        this.x = 0;
        this.y = 0;
        /** Follows the size of the stage. */
        this.isFitted = true;
        this.stage = {width: 1, height: 1};
        this.picture = {width: 1, height: 1};
    }

    setStage(width, height) {
        if (!this.isFitted) {
            this.x += (width - this.stage.width) / 2;
            this.y += (height - this.stage.height) / 2;
        }
        this.stage = {width, height};
        if (this.isFitted) this.fit();
    }

    setPicture(width, height) {
        if (width === this.picture.width && height === this.picture.height) return;
        this.picture = {width, height};
        this.fit();
    }

    /** The whole picture, in the middle; an enlarged one at a whole factor. */
    fit() {
        const {stage, picture} = this;
        const scale = Math.min(stage.width / picture.width, stage.height / picture.height);
        this.scale = Math.max(leastScale, scale >= 2 ? Math.floor(scale) : scale);
        this.center();
        this.isFitted = true;
    }

    center() {
        this.x = (this.stage.width - this.scale * this.picture.width) / 2;
        this.y = (this.stage.height - this.scale * this.picture.height) / 2;
    }

    /** Keeps the point (x, y) of the stage in its place; in the middle where it is left out. */
    zoomTo(scale, x = this.stage.width / 2, y = this.stage.height / 2) {
        scale = Math.min(Math.max(scale, leastScale), mostScale);
        const factor = scale / this.scale;
        this.x = x - factor * (x - this.x);
        this.y = y - factor * (y - this.y);
        this.scale = scale;
        this.isFitted = false;
        this.keepInSight();
    }

    /** The next power of two, by keys and buttons. */
    step(direction) {
        const power = Math.log2(this.scale);
        this.zoomTo(2 ** (direction > 0 ? Math.floor(power + 1 + 1e-6) : Math.ceil(power - 1 - 1e-6)));
    }

    pan(dx, dy) {
        this.x += dx;
        this.y += dy;
        this.isFitted = false;
        this.keepInSight();
    }

    keepInSight() {
        const margin = 32;
        const clamp = (v, size, stage) => Math.min(Math.max(v, margin - size), stage - margin);
        this.x = clamp(this.x, this.scale * this.picture.width, this.stage.width);
        this.y = clamp(this.y, this.scale * this.picture.height, this.stage.height);
    }

    /** Moves the stage as little as possible, so that a pixel is visible. */
    reveal(px, py) {
        const point = this.toStage(px + 0.5, py + 0.5), margin = Math.min(40, this.scale / 2 + 8);
        const shift = (v, size) => v < margin ? margin - v : v > size - margin ? size - margin - v : 0;
        const dx = shift(point.x, this.stage.width), dy = shift(point.y, this.stage.height);
        if (dx || dy) this.pan(dx, dy);
    }

    /** @returns {{x: number, y: number} | null} the pixel under a point of the stage */
    pixelAt(x, y) {
        const px = Math.floor((x - this.x) / this.scale), py = Math.floor((y - this.y) / this.scale);
        const isInside = px >= 0 && py >= 0 && px < this.picture.width && py < this.picture.height;
        return isInside ? {x: px, y: py} : null;
    }

    toStage(px, py) { return {x: this.x + px * this.scale, y: this.y + py * this.scale}; }
}
