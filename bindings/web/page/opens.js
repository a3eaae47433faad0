// What is opened, one after the other: what was begun last counts.

export class Opens {
    /** `changed()` is called when something begins or ends, and `fail` is told why something was not opened. */
    constructor(changed, fail) {
        Object.assign(this, { changed, fail, number: 0, name: undefined });
    }

    /** What was begun before does not count any more. */
    begin(name) {
        this.name = name;
        this.changed();
        return ++this.number;
    }

    /** Waits for `read()` and hands what it gives to `use`, unless something else was begun meanwhile; then its errors do not
     * count either. `name` is what is being read. */
    async run(name, read, use) {
        const number = this.begin(name);
        const isLast = () => number === this.number;
        const end = act => {
            if (!isLast()) return;
            this.name = undefined;
            act();
            this.changed();
        };
        await read().then(what => end(() => use(what)), error => end(() => this.fail(error.message)));
    }
}
