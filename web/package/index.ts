/** A tactile sensor's gel, by finite elements, in a browser or in Node.js. */

import type { Engine } from "../page/engine.ts";
import { ModuleEngine } from "../page/module.ts";

export type { Engine, Frame, Indenter, Mesh, Outline, Pose, Quaternion, Sensor, Shape, Taxel, Vector } from "../page/engine.ts";

/** Written here when the package is made. */
declare const PHYSTAC: string;

/** The description of PhysTac, a sensor of eight barometers under a flat gel: `engine.open("phystac.toml", phystac)`. */
export const phystac = PHYSTAC;

/** Starts an engine in this thread; in a worker of yours, a page stays free. `wasm` is the module, where it is not beside this file. */
export async function load(wasm?: BufferSource): Promise<Engine> {
  return ModuleEngine.of(wasm ?? (await beside(new URL("twintac.wasm", import.meta.url))));
}

async function beside(address: URL): Promise<BufferSource> {
  if (address.protocol !== "file:") return (await fetch(address)).arrayBuffer();
  const files = "node:fs/promises";
  const { readFile } = await import(/* @vite-ignore */ files);
  return readFile(address);
}
