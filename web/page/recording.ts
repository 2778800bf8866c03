/** Frames of a press, as a table. */

import type { Frame, Sensor } from "./engine.ts";
import { FIELDS, type Placement } from "./placement.ts";

export class Recording {
  private readonly rows: string[] = [];
  private readonly columns: string;
  private readonly started = performance.now();

  constructor(
    sensor: Sensor,
    private readonly indenter: string,
  ) {
    const forces = ["force_x_n", "force_y_n", "force_z_n", "torque_x_n_mm", "torque_y_n_mm", "torque_z_n_mm", "contact_mm2"];
    const taxels = sensor.taxels.map(({ name }) => `${name}_kpa`);
    this.columns = ["time_s", "indenter", ...FIELDS, ...forces, ...taxels, "converged", "ood_score", "n_shapes", "provenance"].join(",");
  }

  get n_frames(): number {
    return this.rows.length;
  }

  /** Adds a frame; empty cells are for what it does not have. */
  add(frame: Frame, at: Placement, n_shapes: number): void {
    const numbers = [
      ...FIELDS.map((field) => at[field]),
      ...frame.force_n,
      ...frame.torque_n_mm,
      frame.contact_mm2,
      ...frame.pressure_kpa,
    ].map((number) => (number === undefined ? "" : String(Number(number.toPrecision(7)))));
    const time_s = ((performance.now() - this.started) / 1000).toFixed(4);
    const { converged = "", ood_score = "", provenance } = frame;
    this.rows.push([time_s, this.indenter, ...numbers, converged, ood_score, n_shapes, provenance].join(","));
  }

  get csv(): string {
    return [this.columns, ...this.rows, ""].join("\n");
  }
}
