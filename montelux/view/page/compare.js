// A and B side by side: a wipe with a handle between two layers.

export class Compare {
    /**
     * @param {Document} document
     * @param {() => void} onChange
     */
    constructor(document, onChange) {
        this.toggle = document.getElementById("compare");
        this.select = document.getElementById("layer-b");
        this.row = document.getElementById("layer-b-row");
        this.handle = document.getElementById("wipe");
        this.stage = document.getElementById("stage");
        this.onChange = onChange;
        this.isOn = false;
        /** Share of the stage that shows layer A. */
        this.share = 0.5;
        this.toggle.addEventListener("click", () => this.switch(!this.isOn));
        this.handle.addEventListener("pointerdown", event => {
            event.stopPropagation();
            this.handle.setPointerCapture(event.pointerId);
        });
        this.handle.addEventListener("pointermove", event => {
            event.stopPropagation();
            if (!this.handle.hasPointerCapture(event.pointerId)) return;
            const box = this.stage.getBoundingClientRect();
            this.move((event.clientX - box.left) / box.width);
        });
        this.handle.addEventListener("pointerup", event => event.stopPropagation());
        this.handle.addEventListener("keydown", event => {
            const by = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[event.key];
            if (by === undefined) return;
            event.preventDefault();
            event.stopPropagation();
            this.move(this.share + by);
        });
        this.show();
    }

    switch(isOn) {
        this.isOn = isOn;
        this.show();
        this.onChange();
    }

    move(share) {
        this.share = Math.min(Math.max(share, 0), 1);
        this.show();
        this.onChange();
    }

    show() {
        this.toggle.setAttribute("aria-pressed", this.isOn);
        this.row.hidden = !this.isOn;
        this.handle.hidden = !this.isOn;
        this.handle.style.left = `${100 * this.share}%`;
        this.handle.setAttribute("aria-valuenow", Math.round(100 * this.share));
    }
}
