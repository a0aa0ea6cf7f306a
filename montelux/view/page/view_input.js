// Pointer and wheel on the picture: drag, pinch, wheel, hover and choice of a pixel.

const tapDistance = 5; // CSS pixels

/**
 * Events, all in CSS pixels of the stage: onPan(dx, dy), onZoom(factor, x, y), onHover(x, y), onLeave(),
 * onChoose(x, y). While isOrbit(event) a drag and the zoom go to onOrbit(dx, dy, factor) instead.
 * @param {HTMLElement} stage
 */
export function listenToView(stage, events) {
    const pointers = new Map();
    let moved = 0, waiting = {dx: 0, dy: 0}, isOrbit = false;
    const place = event => {
        const box = stage.getBoundingClientRect();
        return {x: event.clientX - box.left, y: event.clientY - box.top};
    };
    // Unlike place() independent of the stage, which moves when the text above it grows.
    const client = event => ({x: event.clientX, y: event.clientY});
    const gesture = () => {
        const [a, b] = [...pointers.values()];
        return b ? {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, span: Math.hypot(a.x - b.x, a.y - b.y)} : {...a, span: 0};
    };

    stage.addEventListener("pointerdown", event => {
        if (event.button > 1) return;
        stage.setPointerCapture(event.pointerId);
        pointers.set(event.pointerId, client(event));
        if (pointers.size === 1) {
            moved = 0;
            waiting = {dx: 0, dy: 0};
            isOrbit = events.isOrbit(event);
        } else {
            moved = Infinity;
        }
        stage.classList.add("dragging");
    });

    stage.addEventListener("pointermove", event => {
        if (!pointers.has(event.pointerId)) {
            const at = place(event);
            events.onHover(at.x, at.y);
            return;
        }
        const before = gesture();
        pointers.set(event.pointerId, client(event));
        const after = gesture();
        let dx = after.x - before.x, dy = after.y - before.y;
        moved += Math.hypot(dx, dy);
        // A tap may tremble; a drag then catches up.
        dx += waiting.dx;
        dy += waiting.dy;
        waiting = moved < tapDistance ? {dx, dy} : {dx: 0, dy: 0};
        if (moved < tapDistance) return;
        const factor = before.span > 0 && after.span > 0 ? after.span / before.span : 1;
        if (isOrbit) {
            events.onOrbit(dx, dy, factor);
            return;
        }
        events.onPan(dx, dy);
        if (factor === 1) return;
        const box = stage.getBoundingClientRect();
        events.onZoom(factor, after.x - box.left, after.y - box.top);
    });

    const end = event => {
        if (!pointers.delete(event.pointerId)) return;
        if (event.type === "pointerup" && moved < tapDistance) {
            const at = place(event);
            events.onChoose(at.x, at.y);
        }
        if (!pointers.size) stage.classList.remove("dragging");
    };
    stage.addEventListener("pointerup", end);
    stage.addEventListener("pointercancel", end);
    stage.addEventListener("pointerleave", event => {
        if (!pointers.size && event.pointerType !== "touch") events.onLeave();
    });

    stage.addEventListener("wheel", event => {
        event.preventDefault();
        const at = place(event);
        // Lines and pages instead of pixels; a pinch on a touchpad arrives as a fine wheel with Ctrl.
        const unit = event.deltaMode === 0 ? 1 : event.deltaMode === 1 ? 20 : 400;
        const factor = Math.exp(-event.deltaY * unit * (event.ctrlKey ? 0.01 : 0.002));
        if (events.isOrbit(event)) events.onOrbit(0, 0, factor);
        else events.onZoom(factor, at.x, at.y);
    }, {passive: false});
}
