// Files that are dragged in, or opened.

export class Drop {
    /** `read` takes the files, at most `most` of them, and fails with words; `fail` is told these, and null before it is known;
     * `limit()` is how many bytes are accepted of each. */
    constructor({ zone, button, input }, limit, fail, read, most = 1) {
        Object.assign(this, { limit, fail, read, most });
        const over = event => {
            if (!event.dataTransfer?.types.includes("Files")) return;
            event.preventDefault();
            zone.hidden = event.type === "dragleave" && event.relatedTarget === null || event.type === "drop";
            if (event.type === "drop") this.send(event.dataTransfer.files);
        };
        for (const type of ["dragover", "dragleave", "drop"]) document.addEventListener(type, over);
        button.onclick = () => input.click();
        input.onchange = () => {
            this.send([...input.files]);
            input.value = "";
        };
    }

    async send(files) {
        if (files.length === 0) return;
        this.fail(null); // what was said of another file
        if (files.length > this.most) return this.fail(`${files.length} files were dropped; one map at a time is shown`);
        const large = [...files].find(({ size }) => size > this.limit());
        if (large) {
            return this.fail(`${large.name}: ${(large.size / 2 ** 20).toFixed(0)} MB, and ${this.limit() / 2 ** 20} MB are accepted`);
        }
        try {
            await this.read(...files);
        } catch (error) {
            this.fail(error.message);
        }
    }
}
