// Makes the package for npm: an ES module with types, and the WebAssembly module beside it.
// node package.mjs MODULE.wasm FOLDER

import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [module, folder] = process.argv.slice(2);
if (!module || !folder) {
  console.error("usage: node package.mjs MODULE.wasm FOLDER");
  process.exit(2);
}
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
await build({
  entryPoints: [join(here, "package/index.ts")],
  bundle: true,
  format: "esm",
  target: "es2022",
  outfile: join(folder, "index.js"),
  define: { PHYSTAC: JSON.stringify(readFileSync(join(here, "../sensors/phystac.toml"), "utf8")) },
  logLevel: "error",
});
// The types of the engine are one file; the package adds two names to it.
const engine = readFileSync(join(here, "page/engine.ts"), "utf8");
const added = `
/** The description of PhysTac, a sensor of eight barometers under a flat gel. */
export declare const phystac: string;

/** Starts an engine in this thread. \`wasm\` is the module, where it is not beside this file. */
export declare function load(wasm?: BufferSource): Promise<Engine>;
`;
writeFileSync(join(folder, "index.d.ts"), engine + added);
for (const file of ["package.json", "README.md", "example.html"]) copyFileSync(join(here, "package", file), join(folder, file));
for (const file of ["LICENSE-APACHE", "LICENSE-MIT"]) copyFileSync(join(here, "..", file), join(folder, file));
const licences = ["../.github/licences.py", "--manifest-path", "engine/Cargo.toml", "--out", join(folder, "LICENCES-THIRD-PARTY.txt")];
execFileSync("python3", licences, { cwd: here, stdio: ["ignore", "ignore", "inherit"] });
copyFileSync(module, join(folder, "twintac.wasm"));
execFileSync("npm", ["pack", "--silent"], { cwd: folder, stdio: ["ignore", "inherit", "inherit"] });
