// The exposure at the start, where the scene gives none: follows the first picture until that is complete.

const interval = 200, settled = 500; // ms

export class AutoExposure {
    /** @param {import("./exposure.js").Exposure} exposure @param {import("./layer_store.js").LayerStore} store */
    constructor(exposure, store) {
        this.exposure = exposure;
        this.store = store;
        this.last = 0;
    }

    get isActive() { return this.exposure.isAutomatic; }

    /** Sets it from the picture so far. */
    now() {
        const mean = this.store.get("mean");
        if (mean?.version) this.exposure.adapt(mean.logAverageLuminance());
    }

    /** @param {object | null} progress */
    update(progress) {
        const mean = this.store.get("mean"), time = performance.now();
        if (!this.isActive || !mean?.version || time - this.last < interval) return;
        this.last = time;
        this.now();
        // Tiles of the first sample may follow the message that reports it.
        if (mean.isComplete && progress?.samples >= 1) this.timer ??= setTimeout(() => this.finish(), settled);
    }

    finish() {
        if (!this.isActive) return;
        this.now();
        this.exposure.isAutomatic = false;
    }
}
