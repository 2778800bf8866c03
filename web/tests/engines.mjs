// The WebAssembly engine, and the same engine as a native program.

import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export const root = dirname(dirname(dirname(fileURLToPath(import.meta.url))));
export const page = join(root, "target/web/twintac.html");
export const wasmFile = join(root, "target/wasm32-unknown-unknown/web/twintac_web.wasm");
const native = join(root, "target/release/examples/answer");

/** The engine as the page has it. */
export async function wasmEngine() {
  const outfile = join(root, "target/web/module.mjs");
  await build({ entryPoints: [join(root, "web/page/module.ts")], bundle: true, format: "esm", outfile, logLevel: "error" });
  const { ModuleEngine } = await import(pathToFileURL(outfile));
  return ModuleEngine.of(readFileSync(wasmFile));
}

/** What the native program answers to requests, with files that it stores first. */
export function nativeAnswers(requests, files = []) {
  const input = requests.map((request) => JSON.stringify(request)).join("\n") + "\n";
  const output = execFileSync(native, files, { input, maxBuffer: 1 << 28 }).toString();
  return output.trim().split("\n").map((line) => JSON.parse(line));
}

export const surrogateFile = join(root, "crates/twin/fast/built_in/phystac.safetensors");

export const sensorText = readFileSync(join(root, "sensors/phystac.toml"), "utf8");

/** The largest difference of two frames' readings over the largest reading, and of their forces over the force. */
export function deviation(found, expected) {
  const largest_kpa = Math.max(...expected.pressure_kpa.map(Math.abs));
  const off_kpa = Math.max(...found.pressure_kpa.map((kpa, taxel) => Math.abs(kpa - expected.pressure_kpa[taxel])));
  const off_n = Math.hypot(...found.force_n.map((force_n, axis) => force_n - expected.force_n[axis]));
  return { readings: off_kpa / largest_kpa, force: off_n / Math.hypot(...expected.force_n) };
}
