// The connection to the server. It connects again by itself, for as long as the page is open.

import { decode } from "./message.js";

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 3000;

/** Messages from the server, and wishes to it. */
export class Socket {
    /** `receive` takes each message, `connected` whether there is a connection. */
    constructor(url, receive, connected) {
        Object.assign(this, { url, receive, connected, wait: FIRST_WAIT_MS });
        this.open();
    }

    open() {
        const socket = new WebSocket(this.url);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => {
            this.wait = FIRST_WAIT_MS;
            this.connected(true);
        };
        socket.onmessage = ({ data }) => this.receive(typeof data === "string" ? JSON.parse(data) : decode(data));
        socket.onclose = () => {
            this.connected(false);
            setTimeout(() => this.open(), this.wait);
            this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
        };
        this.socket = socket;
    }

    /** Asks for something; without a connection nothing is asked for. */
    ask(type, more = {}) {
        if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ type, ...more }));
    }
}
