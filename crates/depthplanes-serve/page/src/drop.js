// Files that are dragged in, or opened: sent to the server, which reads them.

export class Drop {
    /** `fail` is told why a file was not read, and null before it is known; `limit()` how many bytes the server accepts. */
    constructor({ zone, button, input }, limit, fail) {
        Object.assign(this, { limit, fail });
        const over = event => {
            if (!event.dataTransfer?.types.includes("Files")) return;
            event.preventDefault();
            zone.hidden = event.type === "dragleave" && event.relatedTarget === null || event.type === "drop";
            if (event.type === "drop") this.send(event.dataTransfer.files);
        };
        for (const type of ["dragover", "dragleave", "drop"]) document.addEventListener(type, over);
        button.onclick = () => input.click();
        input.onchange = () => {
            this.send(input.files);
            input.value = "";
        };
    }

    async send(files) {
        const [file, ...others] = files;
        if (!file) return;
        this.fail(null); // what was said of another file
        if (others.length) return this.fail(`${files.length} files were dropped; one map at a time is shown`);
        if (file.size > this.limit()) {
            return this.fail(`${file.name}: ${(file.size / 2 ** 20).toFixed(0)} MB, and ${this.limit() / 2 ** 20} MB are accepted`);
        }
        try {
            const answer = await fetch(`/file/${encodeURIComponent(file.name)}`, { method: "POST", body: file });
            if (!answer.ok) this.fail(await answer.text() || `${file.name}: ${answer.statusText}`);
        } catch {
            this.fail(`${file.name}: the server did not answer`);
        }
    }
}
