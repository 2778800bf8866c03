/** A cut through the gel: the nodes' values on a plane of the gel at rest, drawn as it is deformed. */

import { Scale, cssOf } from "./colours.ts";
import type { Frame, Mesh, Outline, Pose, Sensor } from "./engine.ts";

export interface SectionView {
  /** The axis across the cut: 1 shows x and z, 0 shows y and z. */
  across: 0 | 1;
  quantity: "pressure" | "von-mises";
}

/** Room for axes around the picture, px. */
const MARGIN = { left: 44, right: 12, top: 12, bottom: 36 };

export class Section {
  readonly scale = new Scale();

  constructor(private readonly canvas: HTMLCanvasElement) {}

  draw(sensor: Sensor, mesh: Mesh, frame: Frame, outline: Outline | undefined, pose: Pose, view: SectionView, magnified: number): void {
    const { across } = view;
    const along = across === 1 ? 0 : 1;
    const values = view.quantity === "pressure" ? frame.node_pressure_kpa : frame.node_von_mises_kpa;
    this.scale.take(values);
    const [low, high] = sensor.gel_mm;
    const room_mm = 3;
    const picture = new Picture(this.canvas, [low[along] - 2, high[along] + 2], [0, high[2] + room_mm]);
    // Not through nodes, so that each tetrahedron is cut or is not.
    const at_mm = Math.min(high[across] - 0.011, Math.max(low[across] + 0.011, pose.position_mm[across])) + 0.00137;
    for (const polygon of cut(mesh, frame.displacements_mm, values, across, along, at_mm, magnified)) {
      picture.fill(polygon.points, cssOf(this.scale.part(polygon.value)));
    }
    if (outline) picture.lines(silhouette(outline, pose, across, along));
    const ports = sensor.taxels.filter((taxel) => Math.abs(taxel.position_mm[across] - at_mm) <= 4);
    picture.ports(ports.map((taxel) => [taxel.position_mm[along], taxel.port_radius_mm, taxel.position_mm[2]]));
    picture.axes(`${along === 0 ? "x" : "y"} (mm)`, "z (mm)");
    const shown = at_mm.toFixed(1).replace("-0.0", "0.0");
    picture.note(`at ${across === 1 ? "y" : "x"} = ${shown} mm`);
  }
}

interface Polygon {
  points: [number, number][];
  value: number;
}

/** What a plane cuts of the tetrahedra. */
function* cut(
  mesh: Mesh,
  displacements_mm: Float32Array,
  values: Float32Array,
  across: number,
  along: number,
  at_mm: number,
  magnified: number,
): Generator<Polygon> {
  const { tets, rest_mm } = mesh;
  const above: number[] = [];
  const below: number[] = [];
  const crossing = (a: number, b: number): [number, number, number] => {
    const [from, to] = [rest_mm[3 * a + across]!, rest_mm[3 * b + across]!];
    const part = (at_mm - from) / (to - from);
    const mixed = (of: (node: number) => number) => of(a) + part * (of(b) - of(a));
    const moved = (axis: number) => (node: number) => rest_mm[3 * node + axis]! + magnified * displacements_mm[3 * node + axis]!;
    return [mixed(moved(along)), mixed(moved(2)), mixed((node) => values[node]!)];
  };
  for (let tet = 0; tet < tets.length; tet += 4) {
    above.length = below.length = 0;
    for (let corner = 0; corner < 4; corner++) {
      const node = tets[tet + corner]!;
      (rest_mm[3 * node + across]! > at_mm ? above : below).push(node);
    }
    if (!above.length || !below.length) continue;
    // Around the polygon: a pair on one side takes the pair on the other in turn.
    const [a, b] = [above, below];
    const corners =
      a.length === 2
        ? [crossing(a[0]!, b[0]!), crossing(a[0]!, b[1]!), crossing(a[1]!, b[1]!), crossing(a[1]!, b[0]!)]
        : a.flatMap((node) => b.map((other) => crossing(node, other)));
    const value = corners.reduce((sum, corner) => sum + corner[2], 0) / corners.length;
    yield { points: corners.map(([u, z]) => [u, z]), value };
  }
}

/** Where a plane of the gel cuts the indenter's surface, as pairs of ends. */
function silhouette(outline: Outline, pose: Pose, across: number, along: number): [number, number, number, number][] {
  const [x, y, z, w] = pose.rotation;
  const { corners_mm, triangles } = outline;
  const placed = new Float32Array(corners_mm.length);
  for (let i = 0; i < corners_mm.length; i += 3) {
    const [px, py, pz] = [corners_mm[i]!, corners_mm[i + 1]!, corners_mm[i + 2]!];
    const [tx, ty, tz] = [2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)];
    placed[i] = px + w * tx + y * tz - z * ty + pose.position_mm[0];
    placed[i + 1] = py + w * ty + z * tx - x * tz + pose.position_mm[1];
    placed[i + 2] = pz + w * tz + x * ty - y * tx + pose.position_mm[2];
  }
  const at_mm = pose.position_mm[across]! + 0.00137;
  const lines: [number, number, number, number][] = [];
  for (let triangle = 0; triangle < triangles.length; triangle += 3) {
    const ends: number[] = [];
    for (let side = 0; side < 3; side++) {
      const [a, b] = [3 * triangles[triangle + side]!, 3 * triangles[triangle + ((side + 1) % 3)]!];
      const [from, to] = [placed[a + across]! - at_mm, placed[b + across]! - at_mm];
      if (from > 0 === to > 0) continue;
      const part = from / (from - to);
      ends.push(placed[a + along]! + part * (placed[b + along]! - placed[a + along]!));
      ends.push(placed[a + 2]! + part * (placed[b + 2]! - placed[a + 2]!));
    }
    if (ends.length === 4) lines.push(ends as [number, number, number, number]);
  }
  return lines;
}

/** A picture in mm, upwards z, with axes. */
export class Picture {
  private readonly context: CanvasRenderingContext2D;
  private readonly px_per_mm: number;
  private readonly ink: string;
  private readonly width: number;
  private readonly height: number;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly u_mm: [number, number],
    private readonly v_mm: [number, number],
  ) {
    const ratio = devicePixelRatio || 1;
    const style = getComputedStyle(canvas);
    this.width = canvas.clientWidth;
    this.px_per_mm = (this.width - MARGIN.left - MARGIN.right) / (u_mm[1] - u_mm[0]);
    this.height = Math.round(this.px_per_mm * (v_mm[1] - v_mm[0]) + MARGIN.top + MARGIN.bottom);
    const [width, height] = [Math.round(ratio * this.width), Math.round(ratio * this.height)];
    if (canvas.width !== width || canvas.height !== height) {
      [canvas.width, canvas.height] = [width, height];
      canvas.style.height = `${this.height}px`;
    }
    this.context = canvas.getContext("2d")!;
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.clearRect(0, 0, this.width, this.height);
    this.ink = style.color;
    this.context.font = `12px ${style.fontFamily}`;
  }

  private x(u: number): number {
    return MARGIN.left + (u - this.u_mm[0]) * this.px_per_mm;
  }

  private y(v: number): number {
    return MARGIN.top + (this.v_mm[1] - v) * this.px_per_mm;
  }

  fill(points: [number, number][], colour: string): void {
    const { context } = this;
    context.fillStyle = context.strokeStyle = colour;
    context.lineWidth = 0.7;
    context.beginPath();
    points.forEach(([u, v], index) => (index ? context.lineTo(this.x(u), this.y(v)) : context.moveTo(this.x(u), this.y(v))));
    context.closePath();
    context.fill();
    context.stroke();
  }

  lines(lines: [number, number, number, number][]): void {
    const { context } = this;
    context.save();
    context.beginPath();
    context.rect(MARGIN.left, MARGIN.top, this.width - MARGIN.left - MARGIN.right, this.height - MARGIN.top - MARGIN.bottom);
    context.clip();
    context.strokeStyle = this.ink;
    context.lineWidth = 1.5;
    context.beginPath();
    for (const [u, v, u2, v2] of lines) {
      context.moveTo(this.x(u), this.y(v));
      context.lineTo(this.x(u2), this.y(v2));
    }
    context.stroke();
    context.restore();
  }

  /** Ports: their middle, radius and height, mm. */
  ports(ports: [number, number, number][]): void {
    this.context.strokeStyle = this.ink;
    this.context.lineWidth = 4;
    this.context.beginPath();
    for (const [u, radius, v] of ports) {
      this.context.moveTo(this.x(u - radius), this.y(v) + 2);
      this.context.lineTo(this.x(u + radius), this.y(v) + 2);
    }
    this.context.stroke();
  }

  /** An image that fills a box; its first row is the lowest. */
  image(cells: ImageData, [u0, v0, u1, v1]: [number, number, number, number]): void {
    const buffer = new OffscreenCanvas(cells.width, cells.height);
    buffer.getContext("2d")!.putImageData(cells, 0, 0);
    this.context.imageSmoothingEnabled = true;
    this.context.save();
    this.context.translate(this.x(u0), this.y(v0));
    this.context.scale(1, -1);
    this.context.drawImage(buffer, 0, 0, this.x(u1) - this.x(u0), this.y(v0) - this.y(v1));
    this.context.restore();
  }

  circle(u: number, v: number, radius_mm: number, label: string): void {
    const { context } = this;
    context.strokeStyle = "white";
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(this.x(u), this.y(v), radius_mm * this.px_per_mm, 0, 2 * Math.PI);
    context.stroke();
    context.textAlign = "center";
    context.textBaseline = "bottom";
    context.lineWidth = 3;
    context.strokeStyle = "rgb(0 0 0 / 0.6)";
    context.strokeText(label, this.x(u), this.y(v + radius_mm) - 2);
    context.fillStyle = "white";
    context.fillText(label, this.x(u), this.y(v + radius_mm) - 2);
  }

  axes(u_name: string, v_name: string): void {
    const { context } = this;
    const [left, right, top, bottom] = [MARGIN.left, this.width - MARGIN.right, MARGIN.top, this.height - MARGIN.bottom];
    context.strokeStyle = context.fillStyle = this.ink;
    context.lineWidth = 1;
    context.strokeRect(left, top, right - left, bottom - top);
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const u of ticks(this.u_mm, (right - left) / 55)) {
      context.fillRect(this.x(u) - 0.5, bottom, 1, 4);
      context.fillText(String(u), this.x(u), bottom + 5);
    }
    context.fillText(u_name, (left + right) / 2, bottom + 20);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const v of ticks(this.v_mm, (bottom - top) / 30)) {
      context.fillRect(left - 4, this.y(v) - 0.5, 4, 1);
      context.fillText(String(v), left - 6, this.y(v));
    }
    context.save();
    context.translate(9, (top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(v_name, 0, 0);
    context.restore();
  }

  note(text: string): void {
    this.context.textAlign = "left";
    this.context.textBaseline = "top";
    this.context.fillStyle = this.ink;
    this.context.fillText(text, MARGIN.left + 6, MARGIN.top + 5);
  }
}

/** Round numbers within a range, about so many. */
function ticks([low, high]: [number, number], count: number): number[] {
  const step = [1, 2, 5, 10, 20, 50].find((step) => (high - low) / step <= Math.max(2, count)) ?? 100;
  const found: number[] = [];
  for (let tick = Math.ceil(low / step) * step; tick <= high + 1e-9; tick += step) found.push(tick);
  return found;
}
