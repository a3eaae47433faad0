// Builds the page into dist: one script, the files beside it, and the licences of what is bundled.
// `node build.mjs FOLDER` builds into another folder, which the test does to compare.
import { build } from "esbuild";
import { cp, mkdir, readFile, writeFile } from "node:fs/promises";

const folder = process.argv[2] ?? "dist";
process.chdir(import.meta.dirname);
await mkdir(folder, { recursive: true });
await build({
    absWorkingDir: import.meta.dirname,
    entryPoints: ["src/main.js"],
    outfile: `${folder}/page.js`,
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    charset: "utf8",
    legalComments: "inline",
    logLevel: "warning",
});
for (const name of ["index.html", "page.css", "icon.svg"]) await cp(`src/${name}`, `${folder}/${name}`);
const licence = await readFile("node_modules/three/LICENSE", "utf8");
const { version } = JSON.parse(await readFile("node_modules/three/package.json", "utf8"));
const line = "=".repeat(80);
await writeFile(
    `${folder}/licences.txt`,
    `The page is bundled with three.js ${version}, https://threejs.org: MIT.\n\n${line}\n\n${licence.replaceAll("\r\n", "\n").trim()}\n`,
);
