// The camera about what it looks at: angles and zoom relative to the camera at the start.

const interval = 250; // ms between messages: each restarts the render
const degreesPerPixel = 0.3;

export class Orbit {
    /**
     * @param {HTMLElement} element with the buttons
     * @param {HTMLElement} stage
     * @param {(message: object) => boolean} send
     */
    constructor(element, stage, send) {
        this.element = element;
        this.stage = stage;
        this.send = send;
        this.toggle = element.querySelector(".toggle");
        this.text = element.querySelector(".values");
        this.toggle.addEventListener("click", () => this.switch(!this.isOn));
        element.querySelector(".reset").addEventListener("click", () => {
            this.clear();
            this.plan();
        });
        for (const [name, ...by] of [["left", -15, 0], ["right", 15, 0], ["up", 0, 15], ["down", 0, -15]])
            element.querySelector(`.${name}`).addEventListener("click", () => this.turn(...by, 1));
        this.last = 0;
        this.clear();
        this.switch(false);
    }

    clear() {
        /** In degrees. */
        this.azimuth = 0;
        this.elevation = 0;
        this.zoom = 1;
        this.show();
    }

    /**
     * @param {boolean} isPossible
     * @param {{azimuth: number, elevation: number, zoom: number}} [now] where the camera stands, after changes of
     *     other pages too
     */
    enable(isPossible, now) {
        this.isPossible = isPossible;
        if (now && !this.timer) {
            ({azimuth: this.azimuth, elevation: this.elevation, zoom: this.zoom} = now);
            this.show();
        }
        this.element.hidden = !isPossible;
        if (!isPossible) this.switch(false);
    }

    switch(isOn) {
        this.isOn = isOn && this.isPossible;
        this.toggle.setAttribute("aria-pressed", this.isOn);
        this.stage.classList.toggle("orbits", this.isOn);
    }

    /** By a drag in CSS pixels: the scene follows the pointer. */
    drag(dx, dy, factor) { this.turn(-dx * degreesPerPixel, dy * degreesPerPixel, factor); }

    turn(azimuth, elevation, factor) {
        if (!this.isPossible) return;
        const wrapped = v => v - 360 * Math.round(v / 360);
        this.azimuth = wrapped(this.azimuth + azimuth);
        this.elevation = Math.min(Math.max(this.elevation + elevation, -180), 180);
        this.zoom = Math.min(Math.max(this.zoom * factor, 0.01), 100);
        this.show();
        this.plan();
    }

    // The first change at once, later ones together.
    plan() {
        if (this.timer) return;
        const delay = this.last + interval - performance.now();
        const go = () => {
            this.timer = null;
            this.last = performance.now();
            const round = v => Number(v.toFixed(4));
            this.send({type: "orbit", azimuth: round(this.azimuth), elevation: round(this.elevation),
                zoom: round(this.zoom)});
        };
        if (delay > 0) this.timer = setTimeout(go, delay);
        else go();
    }

    show() {
        const round = v => Number(v.toFixed(1));
        this.text.textContent =
            `azimuth ${round(this.azimuth)}°, elevation ${round(this.elevation)}°, zoom ${Number(this.zoom.toFixed(2))}`;
    }
}
