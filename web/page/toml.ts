/** The text of an indenter, as a description has it. */

import type { Indenter } from "./engine.ts";

export function indenterText({ name, shape, friction }: Indenter): string {
  const lines = [`name = ${valueText(name)}`, `shape = ${valueText(shape)}`];
  if (friction !== undefined && friction !== null) lines.push(`friction = ${friction}`);
  return `${lines.join("\n")}\n`;
}

function valueText(value: unknown): string {
  if (typeof value === "number") return Number.isInteger(value) ? value.toFixed(1) : String(value);
  if (typeof value === "string") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(valueText).join(", ")}]`;
  const fields = Object.entries(value as object).filter(([, found]) => found !== undefined && found !== null);
  return `{ ${fields.map(([name, found]) => `${name} = ${valueText(found)}`).join(", ")} }`;
}

/** The length by which people know a shape, and its name. */
const LENGTHS: Record<string, [field: string, name: string]> = {
  sphere: ["radius_mm", "Radius"],
  cylinder: ["radius_mm", "Radius"],
  ring: ["outer_radius_mm", "Outer radius"],
  box: ["size_mm", "Width"],
  x: ["length_mm", "Length"],
  triangle: ["side_mm", "Side"],
  wedge: ["length_mm", "Length"],
};

/** That length, mm; nothing for a shape that has none. */
export function sizeOf({ shape }: Indenter): { name: string; size_mm: number } | undefined {
  const known = LENGTHS[shape.kind];
  if (!known) return undefined;
  const found = shape[known[0]];
  return { name: known[1], size_mm: Array.isArray(found) ? found[0] : (found as number) };
}

/** The same shape, all its lengths longer or shorter. */
export function resized(indenter: Indenter, size_mm: number): Indenter {
  const factor = size_mm / sizeOf(indenter)!.size_mm;
  const scaled = (value: unknown): unknown =>
    Array.isArray(value) ? value.map(scaled) : Number(((value as number) * factor).toPrecision(12));
  const fields = Object.entries(indenter.shape).map(([name, value]) => [name, name.endsWith("_mm") ? scaled(value) : value]);
  return { ...indenter, shape: Object.fromEntries(fields) };
}
