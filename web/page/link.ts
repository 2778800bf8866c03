/** A press as a link: what stands after `#` says all that makes its readings. */

import type { Placed } from "./engine.ts";
import { FIELDS, type Placement } from "./placement.ts";
import type { Colouring } from "./scene.ts";

/** All that a link restores. */
export interface Shared {
  version: 1;
  /** The file of a description, and its text where the page does not have it. */
  sensor: { file: string; text?: string };
  indenter: string;
  /** The description of the indenter, where the sensor does not have it as it is pressed. */
  indenter_text?: string;
  placement: Placement;
  /** The surrogate that the page has, where one is asked in place of finite elements. */
  surrogate?: string;
  /** Shapes that were left in the gel. */
  left?: Placed[];
  max_nodes: number;
  colouring: Colouring;
  magnified: number;
  across: 0 | 1;
}

const DAMAGED = "This link is damaged, so the page starts with its own settings. Copy the whole link again.";

/** The text after `#`. */
export async function encode(shared: Shared): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(shared)), new CompressionStream("deflate"));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** What a text after `#` says. The checksum of the compression finds most damages, and what is read is checked. */
export async function decode(fragment: string): Promise<Shared> {
  let read: unknown;
  try {
    const text = atob(fragment.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    read = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(await through(bytes, new DecompressionStream("deflate"))));
  } catch {
    throw new Error(DAMAGED);
  }
  if (!isShared(read)) throw new Error(DAMAGED);
  return read;
}

function isShared(read: unknown): read is Shared {
  const shared = read as Shared;
  return (
    shared?.version === 1 &&
    typeof shared.sensor?.file === "string" &&
    ["string", "undefined"].includes(typeof shared.sensor.text) &&
    typeof shared.indenter === "string" &&
    ["string", "undefined"].includes(typeof shared.indenter_text) &&
    FIELDS.every((field) => Number.isFinite(shared.placement?.[field])) &&
    ["string", "undefined"].includes(typeof shared.surrogate) &&
    (shared.left === undefined || (Array.isArray(shared.left) && shared.left.every(isPlaced))) &&
    Number.isInteger(shared.max_nodes) &&
    ["pressure", "von-mises", "plain"].includes(shared.colouring) &&
    Number.isFinite(shared.magnified) &&
    [0, 1].includes(shared.across)
  );
}

function isPlaced(read: unknown): read is Placed {
  const placed = read as Placed;
  const { position_mm, rotation } = placed?.gel_from_indenter ?? {};
  const areNumbers = (values: unknown, length: number) => Array.isArray(values) && values.length === length && values.every(Number.isFinite);
  return typeof placed?.shape?.kind === "string" && areNumbers(position_mm, 3) && areNumbers(rotation, 4);
}

async function through(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  const passed = new Blob([bytes]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array<ArrayBuffer>, Uint8Array<ArrayBuffer>>);
  return new Uint8Array(await new Response(passed).arrayBuffer());
}
