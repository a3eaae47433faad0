// Asks the thread that finds planes.

import { decode } from "../../../crates/depthplanes-serve/page/src/message.js";
import { inFields } from "../js/words.ts";

/** What the program says, in words of the page. */
function inWordsOfThePage(head) {
    if (head.error) head.error = inFields(head.error);
    if (head.notes) head.notes = head.notes.map(inFields);
    if (head.verdict) head.verdict.text = inFields(head.verdict.text);
    for (const row of [head.units, head.outputs].flat()) if (row) row.about = inFields(row.about);
    return head;
}

/** Starts it from the text of its script. */
export class Client {
    constructor(script) {
        this.waiting = new Map();
        this.number = 0;
        this.worker = new Worker(URL.createObjectURL(new Blob([script], { type: "text/javascript" })));
        this.worker.onmessage = ({ data: { number, answer, error } }) => {
            const { resolve, reject } = this.waiting.get(number);
            this.waiting.delete(number);
            const head = answer && inWordsOfThePage(decode(answer));
            error || head.error ? reject(new Error(error ?? head.error)) : resolve(head);
        };
        this.worker.onerror = event => this.stop(event.message || "the browser did not start it");
    }

    /** The answer to a request, a head with its arrays; fails with words. */
    ask(request, bytes) {
        if (this.stopped) return Promise.reject(new Error(this.stopped));
        return new Promise((resolve, reject) => {
            const number = this.number++;
            this.waiting.set(number, { resolve, reject });
            this.worker.postMessage({ number, request, bytes });
        });
    }

    stop(why) {
        this.stopped = `The part of the page that finds planes does not run: ${why}`;
        for (const { reject } of this.waiting.values()) reject(new Error(this.stopped));
        this.waiting.clear();
    }
}
