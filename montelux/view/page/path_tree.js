// The replay of one sample: its path as an expandable outline.

const mostSample = 2 ** 32 - 1;

export class PathTree {
    /**
     * @param {HTMLElement} element
     * @param {{send: (message: object) => boolean, filmOf: (x: number, y: number) => [number, number]}} source
     */
    constructor(element, source) {
        this.source = source;
        this.tree = element.querySelector(".tree");
        this.field = element.querySelector("input");
        this.title = element.querySelector(".title");
        this.controls = [...element.querySelectorAll("button, input")];
        this.pixel = null;
        /** Headings that stay open from one sample to the next. */
        this.opened = new Set();
        element.querySelector("form").addEventListener("submit", event => {
            event.preventDefault();
            this.ask();
        });
        element.querySelector(".previous").addEventListener("click", () => this.step(-1));
        element.querySelector(".next").addEventListener("click", () => this.step(1));
        element.querySelector(".expand").addEventListener("click", () => this.toggleAll());
        this.update();
    }

    /** @param {{x: number, y: number} | null} pixel */
    choose(pixel) {
        this.pixel = pixel;
        this.update();
    }

    get sample() { return Math.min(Math.max(0, Math.floor(Number(this.field.value) || 0)), mostSample); }

    step(by) {
        const sample = Math.max(0, this.sample + by);
        if (sample === this.sample && this.field.value !== "") return;
        this.field.value = sample;
        this.ask();
    }

    /** Replays the sample of the field. */
    ask() {
        if (!this.pixel) return;
        this.field.value = this.sample;
        this.asked = {...this.pixel, sample: this.sample};
        this.source.send({type: "replay", ...this.asked});
    }

    update() {
        const [x, y] = this.pixel ? this.source.filmOf(this.pixel.x, this.pixel.y) : [];
        this.title.textContent = this.pixel ? `Pixel ${x}, ${y}` : "Choose a pixel by a click.";
        for (const control of this.controls) control.disabled = !this.pixel;
    }

    /** @param {object} message of type "replay"; answers to earlier requests are dropped */
    receive(message) {
        if (["x", "y", "sample"].some(key => message[key] !== this.asked?.[key])) return;
        const root = document.createElement("div"), parents = [{level: -1, box: root}];
        const lines = message.lines.filter(line => line.text.trim() !== "");
        lines.forEach((line, i) => {
            while (parents.at(-1).level >= line.level) parents.pop();
            const isParent = i + 1 < lines.length && lines[i + 1].level > line.level;
            const box = document.createElement(isParent ? "details" : "div");
            const label = isParent ? box.appendChild(document.createElement("summary")) : box;
            label.textContent = line.text;
            parents.at(-1).box.append(box);
            if (!isParent) return;
            const key = `${line.level} ${line.text.trim().split(/[:,]/)[0]}`;
            box.open = line.level > 0 || this.opened.has(key) || i === 0 || line.text.startsWith("end");
            box.addEventListener("toggle", () => this.opened[box.open ? "add" : "delete"](key));
            parents.push({level: line.level, box});
        });
        this.tree.replaceChildren(...root.childNodes);
    }

    toggleAll() {
        const all = [...this.tree.querySelectorAll("details")], open = all.some(box => !box.open);
        for (const box of all) box.open = open;
    }
}
