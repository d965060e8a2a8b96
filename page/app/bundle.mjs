// node bundle.mjs CAROM.mjs CAROM.wasm OUT.html: the page as one file, with the engine in it.
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [factory, wasm, out] = process.argv.slice(2);
if (!out) {
  console.error("usage: node bundle.mjs CAROM.mjs CAROM.wasm OUT.html");
  process.exit(2);
}

const packages = new Set(["uplot"]); // its style sheet

async function bundle(entry) {
  const { outputFiles, metafile } = await build({
    entryPoints: [resolve(here, entry)],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: "iife",
    target: ["chrome110", "firefox113", "safari16.4"],
    alias: { "carom-engine": resolve(factory) },
    external: ["module", "fs", "path", "url", "worker_threads", "perf_hooks", "ws", "crypto"], // of emscripten's Node branches, never taken
    define: { "import.meta.url": '"file:///"' }, // never fetched: the bytes are given
    legalComments: "inline",
    logLevel: "warning",
  });
  for (const input of Object.keys(metafile.inputs)) {
    const name = /node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1];
    if (name) packages.add(name);
  }
  return outputFiles[0].text;
}

/** The licences of what is bundled, which go with it. */
function licences() {
  return [...packages].sort().map((name) => {
    const folder = resolve(here, "../node_modules", name);
    const { version, license } = JSON.parse(readFileSync(resolve(folder, "package.json"), "utf8"));
    return `${name} ${version} (${license})\n${readFileSync(resolve(folder, "LICENSE"), "utf8").trim()}`;
  }).join("\n\n");
}

// A script's text may not hold the sign that ends it.
const script = (text) => text.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");

const parts = {
  CSS: readFileSync(resolve(here, "page.css"), "utf8") + readFileSync(resolve(here, "../node_modules/uplot/dist/uPlot.min.css"), "utf8"),
  WASM: gzipSync(readFileSync(wasm), { level: 9 }).toString("base64"),
  WORKER: script(await bundle("worker.ts")),
  MAIN: script(await bundle("main.ts")),
};
parts.LICENCES = script(licences());
const page = readFileSync(resolve(here, "index.html"), "utf8").replace(/\/\*(CSS|WASM|WORKER|MAIN|LICENCES)\*\//g, (_, name) => parts[name]);
writeFileSync(out, page);
console.log(`${out}: ${(Buffer.byteLength(page) / 1e6).toFixed(2)} MB`);
