// Makes the page: one HTML file that needs no server and no network.
// node build.mjs MODULE.wasm PAGE.html

import { build } from "esbuild";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const root = dirname(here);
const [module, page] = process.argv.slice(2);
if (!module || !page) {
  console.error("usage: node build.mjs MODULE.wasm PAGE.html");
  process.exit(2);
}

/** A program in one text. */
async function bundled(entry, define = {}) {
  const options = { bundle: true, minify: true, format: "iife", target: "es2022", write: false, legalComments: "inline", charset: "utf8" };
  const { outputFiles } = await build({ ...options, entryPoints: [join(here, "page", entry)], define });
  return outputFiles[0].text;
}

/** Texts of the files of a folder, by name. */
function texts(folder) {
  const names = readdirSync(join(root, folder)).filter((name) => name.endsWith(".toml"));
  return Object.fromEntries(names.map((name) => [name, readFileSync(join(root, folder, name), "utf8")]));
}

/** Surrogates of the gels of these sensors, compressed. */
function surrogates() {
  const folder = join(root, "crates/twin/fast/built_in");
  const names = readdirSync(folder).filter((name) => name.endsWith(".safetensors"));
  return Object.fromEntries(names.map((name) => [name, gzipSync(readFileSync(join(folder, name)), { level: 9 }).toString("base64")]));
}

const wasm = readFileSync(module);
const compressed = gzipSync(wasm, { level: 9 });
const program = await bundled("main.ts", {
  SENSORS: JSON.stringify(texts("sensors")),
  MATERIALS: JSON.stringify(texts("materials")),
  LINES: JSON.stringify(texts("firmware/lines")),
  SURROGATES: JSON.stringify(surrogates()),
  WORKER_PROGRAM: JSON.stringify(await bundled("worker.ts")),
  MODULE_GZIP: JSON.stringify(compressed.toString("base64")),
});
const licence = readFileSync(join(here, "node_modules/three/LICENSE"), "utf8").replaceAll("&", "&amp;").replaceAll("<", "&lt;");
const parts = {
  "/*PAGE_CSS*/": readFileSync(join(here, "page/page.css"), "utf8"),
  "/*THREE_LICENCE*/": licence,
  // A program must not end its own element.
  "/*PAGE_JS*/": program.replaceAll("</script", "<\\/script"),
};
let html = readFileSync(join(here, "page/page.html"), "utf8");
for (const [mark, text] of Object.entries(parts)) html = html.replace(mark, () => text);
writeFileSync(page, html);
const mb = (bytes) => `${(bytes / 1e6).toFixed(2)} MB`;
console.error(`${page}: ${mb(html.length)}; its WebAssembly module is ${mb(wasm.length)}, ${mb(compressed.length)} with gzip`);
