/** What the taxels read: a bar for each, and the map between them. */

import { Scale, colourOf, cssOf } from "./colours.ts";
import type { Sensor } from "./engine.ts";
import { Picture } from "./section.ts";

/** Cells of the map along each side. */
const GRID = 64;

/** What is read: none of a taxel without a reading, and no map then. */
export interface Read {
  pressure_kpa: (number | null)[];
  map_kpa: Float32Array;
}

/** What a scale of colours has to cover. */
export function valuesOf({ map_kpa, pressure_kpa }: Read): ArrayLike<number> {
  return map_kpa.length ? map_kpa : pressure_kpa.map((kpa) => kpa ?? 0);
}

export class Readings {
  private bars: { bar: HTMLElement; number: HTMLElement }[] = [];

  constructor(
    private readonly list: HTMLElement,
    private readonly canvas: HTMLCanvasElement,
    readonly scale = new Scale(),
  ) {}

  sensor(sensor: Sensor): void {
    this.list.replaceChildren();
    this.bars = sensor.taxels.map(({ name }) => {
      const row = document.createElement("li");
      const [label, track, bar, number] = ["span", "span", "span", "span"].map((tag) => document.createElement(tag)) as [
        HTMLElement,
        HTMLElement,
        HTMLElement,
        HTMLElement,
      ];
      label.textContent = name;
      track.className = "track";
      number.className = "number";
      track.append(bar);
      row.append(label, track, number);
      this.list.append(row);
      return { bar, number };
    });
  }

  /** Shows what is read, in colours for `all_kpa` where others are shown in the same. */
  show(sensor: Sensor, read: Read, all_kpa = valuesOf(read)): void {
    this.scale.take(all_kpa);
    this.bars.forEach(({ bar, number }, taxel) => {
      const kpa = read.pressure_kpa[taxel] ?? null;
      const part = kpa === null ? 0 : this.scale.part(kpa);
      bar.style.width = `${100 * Math.min(1, Math.max(0, part))}%`;
      bar.style.background = cssOf(part);
      number.textContent = kpa === null ? "no reading" : `${kpa.toFixed(2)} kPa`;
    });
    this.draw(sensor, read);
  }

  private draw(sensor: Sensor, { map_kpa }: Read): void {
    const [low, high] = sensor.gel_mm;
    const picture = new Picture(this.canvas, [low[0], high[0]], [low[1], high[1]]);
    if (map_kpa.length) {
      const cells = new ImageData(GRID, GRID);
      map_kpa.forEach((kpa, cell) => cells.data.set([...colourOf(this.scale.part(kpa)), 255], 4 * cell));
      picture.image(cells, [low[0], low[1], high[0], high[1]]);
    }
    for (const { name, position_mm, port_radius_mm } of sensor.taxels) {
      picture.circle(position_mm[0], position_mm[1], Math.max(0.3, port_radius_mm), name);
    }
    picture.axes("x (mm)", "y (mm)");
  }
}
