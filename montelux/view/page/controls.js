// Pause, stop, quit, limits, and the links that save the picture.

export class Controls {
    /**
     * @param {Document} document
     * @param {{send: (message: object) => boolean, note: (text: string) => void, token: string}} source
     */
    constructor(document, source) {
        this.source = source;
        const get = id => document.getElementById(id);
        this.pause = get("pause");
        this.stop = get("stop");
        this.quit = get("quit");
        this.form = get("limits");
        this.error = get("target-error");
        this.time = get("target-time");
        this.links = [get("save-png"), get("save-exr")];
        this.links[1].addEventListener("click", event => this.isOpen || event.preventDefault());
        this.progress = null;
        this.isOpen = false;
        this.pause.addEventListener("click", () => this.togglePause());
        this.stop.addEventListener("click", () => source.send({type: "stop"}));
        const dialog = get("quit-dialog");
        this.quit.addEventListener("click", () => dialog.showModal());
        dialog.addEventListener("close", () => {
            if (dialog.returnValue === "quit") source.send({type: "quit"});
            dialog.returnValue = "";
        });
        this.form.addEventListener("submit", event => {
            event.preventDefault();
            this.sendTarget();
        });
        this.form.addEventListener("input", () => this.isEdited = true);
        this.form.addEventListener("focusout", event => {
            // Left without a change: follows the program again.
            if (!this.form.contains(event.relatedTarget)) {
                this.isEdited = false;
                this.showLimits();
            }
        });
    }

    togglePause() {
        if (this.pause.disabled) return;
        this.source.send({type: this.progress?.state === "paused" ? "resume" : "pause"});
    }

    sendTarget() {
        const read = (field, factor) => field.value.trim() === "" ? null : Number(field.value) * factor;
        const error = read(this.error, 0.01), time = read(this.time, 1);
        const isBad = v => v !== null && !(v > 0 && v < Infinity);
        if (isBad(error) || isBad(time)) {
            this.source.note("Limits are positive numbers; an empty field means no limit.");
            return;
        }
        // 0.3 * 0.01 has a tail of digits.
        const rounded = error === null ? null : Number(error.toPrecision(12));
        if (this.source.send({type: "target", error: rounded, time})) this.isEdited = false;
    }

    /** @param {object | null} progress @param {boolean} isOpen connection @param {boolean} stays */
    update(progress, isOpen, stays) {
        this.progress = progress;
        this.isOpen = isOpen;
        const state = progress?.state;
        const isActive = isOpen && (state === "rendering" || state === "paused");
        this.pause.disabled = !isActive;
        this.pause.dataset.state = state === "paused" ? "paused" : "running";
        this.pause.querySelector("span").textContent = state === "paused" ? "Resume" : "Pause";
        this.stop.disabled = !isActive;
        this.quit.hidden = !stays;
        this.quit.disabled = !isOpen;
        for (const field of this.form.elements) field.disabled = !isOpen;
        this.showLimits();
    }

    showLimits() {
        if (this.isEdited) return;
        const text = v => typeof v === "number" ? String(Number(v.toPrecision(6))) : "";
        const target = this.progress?.target_error;
        this.error.value = text(typeof target === "number" ? 100 * target : null);
        this.time.value = text(this.progress?.target_time);
    }

    /**
     * Addresses of the picture so far.
     * @param {number} exposure @param {string} tone @param {boolean} isOpen @param {string} stem of the files' names
     */
    updateLinks(exposure, tone, isOpen, stem) {
        const [png, exr] = this.links, token = encodeURIComponent(this.source.token);
        png.href = `/picture.png?token=${token}&exposure=${exposure}&tone=${tone}`;
        exr.href = `/picture.exr?token=${token}`;
        exr.toggleAttribute("aria-disabled", !isOpen);
        png.download = `${stem}.png`;
        exr.download = `${stem}.exr`;
        exr.title = isOpen ? "Save all layers as EXR" : "EXR needs the program, which does not answer";
        this.isOpen = isOpen;
    }
}
