// Builds the npm package and the page: node build.mjs WASM LICENCES FOLDER
//
// FOLDER/package is what npm packs, FOLDER/depthplanes.html the page, one file that needs no other.

import { execFileSync } from "node:child_process";
import { cp, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { gzipSync } from "node:zlib";

const [wasm, licences, folder] = process.argv.slice(2).map(path => resolve(path));
process.chdir(import.meta.dirname);
const livePage = "../../crates/depthplanes-serve/page";
// The packages of the live page, whose sources this page shares.
const { build } = createRequire(resolve(livePage, "build.mjs"))("esbuild");
const common = { bundle: true, target: "es2022", charset: "utf8", logLevel: "warning", write: false };

async function bundled(entry, more) {
    const { outputFiles } = await build({ ...common, entryPoints: [entry], ...more });
    return outputFiles[0].text;
}

async function makePackage(to) {
    await rm(to, { recursive: true, force: true });
    await mkdir(to, { recursive: true });
    execFileSync("node_modules/.bin/tsc", ["--outDir", to], { stdio: "inherit" });
    await writeFile(join(to, "index.js"), await bundled("js/index.ts", { format: "esm" }));
    const { devDependencies, ...about } = JSON.parse(await readFile("package.json", "utf8"));
    await writeFile(join(to, "package.json"), `${JSON.stringify(about, null, 2)}\n`);
    for (const name of ["README.md", "LICENSE-APACHE", "LICENSE-MIT"]) await cp(name, join(to, name));
    await cp(wasm, join(to, "depthplanes.wasm"));
    await cp("js/wasm.d.ts", join(to, "wasm.d.ts"));
    await cp(licences, join(to, "THIRD-PARTY"));
}

async function makePage(to) {
    const packed = gzipSync(await readFile(wasm), { level: 9 }).toString("base64");
    const worker = await bundled("page/worker.js", {
        format: "iife", minify: true, define: { WASM: JSON.stringify(packed), "import.meta.url": '"about:blank"' },
    });
    const script = await bundled("page/main.js", {
        format: "esm", minify: true, define: { WORKER: JSON.stringify(worker) }, legalComments: "inline",
    });
    const escaped = text => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
    const parts = {
        ICON: (await readFile(`${livePage}/src/icon.svg`)).toString("base64"),
        STYLE: await readFile(`${livePage}/src/page.css`, "utf8") + await readFile("page/page.css", "utf8"),
        LICENCES: escaped(await readFile(licences, "utf8")),
        SCRIPT: script.replaceAll("</script", "<\\/script"),
    };
    const html = await readFile("page/index.html", "utf8");
    await writeFile(to, html.replace(/\b(ICON|STYLE|LICENCES|SCRIPT)\b/g, name => parts[name]));
}

await makePackage(join(folder, "package"));
await makePage(join(folder, "depthplanes.html"));
