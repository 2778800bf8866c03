/** Where the indenter is, in the terms of a hand. */

import type { Pose, Quaternion } from "./engine.ts";

/** Depth counts from first touch in the middle of the gel, downwards; negative above. Turns are about the indenter's origin: twist first, then tilt. */
export interface Placement {
  x_mm: number;
  y_mm: number;
  depth_mm: number;
  tilt_x_deg: number;
  tilt_y_deg: number;
  twist_deg: number;
}

export const FIELDS = ["x_mm", "y_mm", "depth_mm", "tilt_x_deg", "tilt_y_deg", "twist_deg"] as const;

/** A turn of a degree counts as this much travel: that of the rim of an indenter. */
const MM_PER_DEGREE = (8 * Math.PI) / 180;

export function poseOf(placement: Placement, touch_mm: number): Pose {
  return {
    position_mm: [placement.x_mm, placement.y_mm, touch_mm - placement.depth_mm],
    rotation: rotationOf(placement),
  };
}

export function rotationOf({ tilt_x_deg, tilt_y_deg, twist_deg }: Placement): Quaternion {
  const [x, y, z] = [tilt_x_deg, tilt_y_deg, twist_deg].map((degrees) => (degrees * Math.PI) / 360) as [number, number, number];
  const tilt = product([0, Math.sin(y), 0, Math.cos(y)], [Math.sin(x), 0, 0, Math.cos(x)]);
  return product(tilt, [0, 0, Math.sin(z), Math.cos(z)]);
}

function product([ax, ay, az, aw]: Quaternion, [bx, by, bz, bw]: Quaternion): Quaternion {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

export function isSame(a: Placement, b: Placement): boolean {
  return FIELDS.every((field) => Math.abs(a[field] - b[field]) < 1e-6);
}

/** The placement on the straight way to another, at most so far, mm. */
export function toward(from: Placement, to: Placement, most_mm: number): Placement {
  const moved = (field: (typeof FIELDS)[number]) => (to[field] - from[field]) * (field.endsWith("deg") ? MM_PER_DEGREE : 1);
  const part = Math.min(1, most_mm / Math.max(1e-9, Math.hypot(...FIELDS.map(moved))));
  if (part === 1) return { ...to };
  const between = (field: (typeof FIELDS)[number]) => [field, from[field] + part * (to[field] - from[field])];
  return Object.fromEntries(FIELDS.map(between)) as unknown as Placement;
}
