/** A sensor on the desk and its twin: bars and maps in the same colours, and the difference. */

import { Scale } from "./colours.ts";
import type { DeskFrame, Frame, Sensor } from "./engine.ts";
import { Readings, valuesOf } from "./readings.ts";

const byId = <Kind extends HTMLElement = HTMLElement>(id: string) => document.getElementById(id) as Kind;
const readings = (id: string, scale: Scale) => new Readings(byId(`${id}-bars`), byId<HTMLCanvasElement>(`${id}-map`), scale);

export class SideBySide {
  private readonly scale = new Scale();
  private readonly offScale = new Scale();
  private readonly desk = readings("desk", this.scale);
  private readonly twin = readings("twin", this.scale);
  private readonly off = readings("off", this.offScale);

  sensor(sensor: Sensor): void {
    for (const one of [this.desk, this.twin, this.off]) one.sensor(sensor);
  }

  show(sensor: Sensor, desk: DeskFrame, twin: Frame): void {
    byId("desk").hidden = false;
    byId("desk-provenance").textContent = desk.provenance;
    byId("desk-status").textContent = this.told(desk);
    const off = {
      pressure_kpa: twin.pressure_kpa.map((kpa, taxel) => {
        const read_kpa = desk.pressure_kpa[taxel] ?? null;
        return read_kpa === null ? null : read_kpa - kpa;
      }),
      map_kpa: desk.map_kpa.length === twin.map_kpa.length ? desk.map_kpa.map((kpa, cell) => kpa - twin.map_kpa[cell]!) : new Float32Array(),
    };
    const both_kpa = [desk, twin].flatMap((read) => Array.from(valuesOf(read)));
    this.desk.show(sensor, desk, both_kpa);
    this.twin.show(sensor, twin, both_kpa);
    this.off.show(sensor, off);
    for (const [id, scale] of [["desk", this.scale], ["off", this.offScale]] as const) {
      byId(`${id}-least`).textContent = String(Number(scale.least.toPrecision(3)));
      byId(`${id}-most`).textContent = `${Number(scale.most.toPrecision(3))} kPa`;
    }
  }

  private told(desk: DeskFrame): string {
    const frames = `${desk.source}: ${desk.n_frames.toLocaleString("en")} frames`;
    const zeroing = desk.is_zeroing ? "finding what it reads untouched: keep off it" : "";
    return [frames, zeroing, ...desk.remarks].filter((text) => text).join("; ");
  }
}
