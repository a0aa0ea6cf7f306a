// The WebSocket to the program: reconnects with growing delays until the program says goodbye.

const firstDelay = 500, longestDelay = 10000; // ms

/** One connection at a time. Events: onText(object), onBinary(ArrayBuffer), onState(state), onBadText(). */
export class Connection {
    /** @param {string} url */
    constructor(url, events) {
        this.url = url;
        this.events = events;
        /** "connecting", "open", "lost" (it is tried again) or "ended" (after goodbye). */
        this.state = "connecting";
        this.delay = firstDelay;
        this.open();
    }

    /** @returns {boolean} whether the message was sent */
    send(message) {
        if (this.state !== "open") return false;
        this.socket.send(JSON.stringify(message));
        return true;
    }

    /** Tries again now. */
    retry() {
        if (this.state === "open" || this.state === "connecting") return;
        this.delay = firstDelay;
        this.open();
    }

    open() {
        clearTimeout(this.timer);
        if (this.state !== "lost") this.change("connecting");
        const socket = new WebSocket(this.url);
        this.socket = socket;
        socket.binaryType = "arraybuffer";
        socket.onopen = () => {
            this.delay = firstDelay;
            this.change("open");
        };
        socket.onmessage = event => {
            if (event.data instanceof ArrayBuffer) this.events.onBinary(event.data);
            else this.receive(event.data);
        };
        socket.onclose = () => {
            if (this.socket !== socket || this.state === "ended") return;
            this.change("lost");
            this.timer = setTimeout(() => this.open(), this.delay);
            this.delay = Math.min(2 * this.delay, longestDelay);
        };
    }

    receive(text) {
        let message;
        try {
            message = JSON.parse(text);
        } catch {
            message = null;
        }
        if (typeof message?.type !== "string") {
            this.events.onBadText();
            return;
        }
        // Before the program closes the socket: no attempts to reconnect follow.
        if (message.type === "goodbye") this.change("ended");
        this.events.onText(message);
    }

    change(state) {
        if (this.state === state && state !== "connecting") return;
        this.state = state;
        this.events.onState(state);
    }
}

/** @param {Location} location of the page @returns {{token: string, socket: string}} */
export function addresses(location) {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    return {token, socket: `${scheme}://${location.host}/live?token=${encodeURIComponent(token)}`};
}
