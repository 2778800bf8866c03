/** Takes the indenter to where the hand wants it, frame by frame, and keeps frames short. */

import type { Engine, Frame, Mesh, Outline, Placed, Sensor, Shape } from "./engine.ts";
import { type Placement, isSame, poseOf, toward } from "./placement.ts";

/** Meshes, from the finest: where frames take too long, the next one is taken. */
export const NODES = [7000, 4000, 2000, 1400, 1000, 700, 400];

/** A frame may take this long, ms. */
const FRAME_MS = 33;

/** Frames of which the median is judged. */
const JUDGED = 24;

/** Farthest that the indenter goes in a frame, mm: the solver takes as much in one go. Where it touches nothing it goes farther. */
const TRAVEL_MM = 0.5;
const TRAVEL_IN_AIR_MM = 3;

/** Time between the frames of a press anew, s. */
const ANEW_S = 0.02;

/** How deep the mesh is made for, over the gel's height. */
const DEPTH_OF_MESH = 0.25;

/** A shape that stays in the gel. */
export interface Left extends Placed {
  outline: Outline;
}

export interface Listener {
  sensor(sensor: Sensor): void;
  outline(outline: Outline): void;
  mesh(mesh: Mesh, nodes: number): void;
  left(shapes: Left[]): void;
  frame(frame: Frame, at: Placement): void;
  status(text: string, kind: "ready" | "busy" | "error"): void;
}

export class Press {
  sensor: Sensor | undefined;
  indenter = "";
  /** Most nodes of the mesh; where `isAutomatic`, it falls until frames are short enough. */
  nodes: number;
  isAutomatic = true;
  target: Placement = lifted();
  at: Placement = lifted();
  frame: Frame | undefined;
  /** The file of the surrogate that is asked in place of finite elements. */
  surrogate: string | undefined;
  /** What was left in the gel; a surrogate takes several shapes. */
  left: Left[] = [];
  private outline: Outline | undefined;
  private mesh: Mesh | undefined;
  private queue: Promise<unknown> = Promise.resolve();
  private isStepping = false;
  private steppedAt = 0;
  private took: number[] = [];
  private ends: number[] = [];

  constructor(
    private readonly engine: Engine,
    private readonly listener: Listener,
  ) {
    this.nodes = engine.first_nodes;
  }

  /** Frames in the last second. */
  get frames_per_s(): number {
    const now = performance.now();
    this.ends = this.ends.filter((end) => now - end < 1000);
    return this.ends.length;
  }

  /** Median time of the last frames in which the indenter touched, ms. */
  get median_ms(): number {
    const sorted = [...this.took].sort((a, b) => a - b);
    return sorted[Math.floor(sorted.length / 2)] ?? NaN;
  }

  keep(name: string, bytes: Uint8Array): Promise<void> {
    return this.inTurn(() => this.engine.keep(name, bytes));
  }

  /** Opens a sensor, and takes an indenter of it: the first, if it has none of the name. */
  open(file: string, text: string, indenter = "", surrogate?: string): Promise<void> {
    return this.inTurn(async () => {
      const sensor = await this.engine.open(file, text);
      this.mesh = undefined;
      this.surrogate = surrogate;
      this.hasLeft([]);
      this.hasSensor(sensor);
      const names = this.sensor!.indenters.map(({ name }) => name);
      this.indenter = names.includes(indenter) ? indenter : (names[0] ?? "");
      this.target = this.at = lifted(this.sensor);
      await this.takeUp();
    });
  }

  /** Adds an indenter by its text, and takes it. */
  add(file: string, text: string): Promise<void> {
    return this.inTurn(async () => {
      this.hasSensor(await this.engine.add(file, text));
      this.indenter = this.sensor!.indenters.at(-1)?.name ?? "";
      await this.takeUp();
    });
  }

  /** Takes one of the sensor's indenters. */
  take(indenter: string): Promise<void> {
    return this.inTurn(async () => {
      this.indenter = indenter;
      await this.takeUp();
    });
  }

  /** Meshes the gel with at most so many nodes, or with as many as leave frames short. */
  useNodes(nodes: number | "automatic"): Promise<void> {
    return this.inTurn(async () => {
      this.isAutomatic = nodes === "automatic";
      this.nodes = nodes === "automatic" ? this.engine.first_nodes : nodes;
      await this.takeUp();
    });
  }

  /** Asks a surrogate from now on, a file that was kept, or finite elements. */
  useSurrogate(surrogate: string | undefined): Promise<void> {
    return this.inTurn(async () => {
      const before = this.surrogate;
      this.surrogate = surrogate;
      if (surrogate === undefined) this.hasLeft([]);
      try {
        await this.takeUp();
      } catch (error) {
        this.surrogate = before;
        await this.takeUp();
        throw error;
      }
    });
  }

  /** Leaves the shape where it is, and takes another one like it out of the gel. */
  leave(): Promise<void> {
    return this.inTurn(async () => {
      if (!this.mesh || !this.outline) return;
      const placed = { shape: this.shape, gel_from_indenter: poseOf(this.at, this.mesh.touch_mm), outline: this.outline };
      this.hasLeft([...this.left, placed]);
      this.target = { ...this.at, depth_mm: -1 };
      await this.stepTo(this.target);
    });
  }

  /** Puts other shapes into the gel in place of those that were left there. */
  replaceLeft(placed: Placed[]): Promise<void> {
    return this.inTurn(async () => {
      const left: Left[] = [];
      for (const one of placed) left.push({ ...one, outline: await this.engine.outline(one.shape) });
      this.hasLeft(left);
      if (this.mesh && this.surrogate !== undefined) await this.stepTo(this.at);
    });
  }

  /** Where the hand wants the indenter. */
  aim(change: Partial<Placement>): void {
    this.target = this.within({ ...this.target, ...change });
    void this.run();
  }

  /** Presses a gel at rest straight down to a placement. The way is always the same, so that whoever does so reads the same. */
  pressAnew(placement: Placement): Promise<void> {
    return this.inTurn(async () => {
      this.target = this.within(placement);
      if (!this.mesh) return;
      await this.engine.rest();
      const { target } = this;
      this.at = { ...target, depth_mm: -this.highest_mm };
      await this.stepTo(this.at, ANEW_S);
      while (!isSame(this.at, target)) await this.stepTo(toward(this.at, target, this.travel_mm), ANEW_S);
    });
  }

  /** Largest depth that a hand can ask for, mm. */
  get deepest_mm(): number {
    const height_mm = this.sensor?.gel_mm[1][2] ?? 1;
    return Math.min(this.sensor?.limits?.depth_mm ?? Infinity, 0.6 * height_mm);
  }

  /** Highest above the gel, mm. */
  get highest_mm(): number {
    return 3;
  }

  /** Whether the indenter is where the hand wants it. */
  get isThere(): boolean {
    return isSame(this.at, this.target) && !this.isStepping;
  }

  private get shape(): Shape {
    const found = this.sensor?.indenters.find(({ name }) => name === this.indenter);
    if (!found) throw new Error(`The sensor has no indenter \`${this.indenter}\`.`);
    return found.shape;
  }

  /** Farthest that the indenter goes in a frame, mm; a surrogate knows nothing of the frame before. */
  private get travel_mm(): number {
    return this.surrogate === undefined ? TRAVEL_MM : Infinity;
  }

  private hasLeft(left: Left[]): void {
    this.left = left;
    this.listener.left(left);
  }

  private hasSensor(sensor: Sensor): void {
    this.sensor = sensor;
    this.listener.sensor(sensor);
  }

  /** Meshes the gel for the indenter, and presses it straight down to where it was. */
  private async takeUp(): Promise<void> {
    const sensor = this.sensor;
    if (!sensor) return;
    if (!this.indenter) throw new Error("The sensor has no indenter: drop an STL file, or a description with [[indenters]].");
    this.mesh = undefined;
    this.listener.status("Meshing the gel…", "busy");
    const depth_mm = Math.min(this.deepest_mm, DEPTH_OF_MESH * sensor.gel_mm[1][2]);
    let mesh: Mesh;
    try {
      this.outline = await this.engine.outline(this.shape);
      this.listener.outline(this.outline);
      mesh = await this.engine.prepare(this.indenter, depth_mm, this.nodes);
    } catch (error) {
      this.listener.status("No gel is meshed.", "ready");
      throw error;
    }
    this.mesh = mesh;
    this.took = [];
    this.at = { ...this.target, depth_mm: Math.min(this.target.depth_mm, -this.highest_mm) };
    this.listener.mesh(mesh, this.nodes);
    await this.stepTo(this.at);
    this.listener.status("Ready", "ready");
    void this.run();
  }

  private async run(): Promise<void> {
    if (this.isStepping) return;
    this.isStepping = true;
    try {
      while (this.mesh && (!isSame(this.at, this.target) || (this.relaxes && this.isTouching))) {
        await this.inTurn(() => this.stepOnce());
      }
    } catch (error) {
      this.listener.status(messageOf(error), "error");
    } finally {
      this.isStepping = false;
    }
  }

  private get relaxes(): boolean {
    return this.surrogate === undefined && !!this.sensor?.relaxes;
  }

  private get isTouching(): boolean {
    return !!this.frame?.force_n.some((force_n) => force_n !== 0);
  }

  private async stepOnce(): Promise<void> {
    if (!this.mesh) return;
    const isFree = !this.isTouching && this.at.depth_mm <= 0 && this.target.depth_mm <= 0;
    const next = toward(this.at, this.target, isFree ? Math.max(TRAVEL_IN_AIR_MM, this.travel_mm) : this.travel_mm);
    try {
      await this.stepTo(next);
      this.listener.status("Ready", "ready");
    } catch (error) {
      this.target = this.at;
      this.listener.status(messageOf(error), "error");
      return;
    }
    if (this.isTouching) this.took = [...this.took, this.frame?.took_ms ?? 0].slice(-JUDGED);
    if (this.isAutomatic && this.took.length === JUDGED && this.median_ms > FRAME_MS) {
      const coarser = NODES.find((nodes) => nodes < this.nodes);
      if (coarser) {
        this.nodes = coarser;
        await this.takeUp();
      }
    }
  }

  private async stepTo(next: Placement, given_s?: number): Promise<void> {
    const now = performance.now();
    // Time passes for materials that relax; a page that was asleep did not press meanwhile.
    const since_s = Math.min(0.1, (now - this.steppedAt) / 1000);
    this.steppedAt = now;
    const pose = poseOf(next, this.mesh!.touch_mm);
    const placed = () => [{ shape: this.shape, gel_from_indenter: pose }, ...this.left.map(({ shape, gel_from_indenter }) => ({ shape, gel_from_indenter }))];
    const frame = await (this.surrogate === undefined ? this.engine.step(pose, given_s ?? since_s) : this.engine.touch(this.surrogate, placed()));
    this.at = next;
    this.frame = frame;
    this.ends.push(performance.now());
    this.listener.frame(frame, next);
  }

  private within(placement: Placement): Placement {
    const [low, high] = this.sensor?.gel_mm ?? [[0, 0, 0], [0, 0, 0]];
    const between = (least: number, value: number, most: number) => Math.min(most, Math.max(least, value));
    return {
      x_mm: between(low[0], placement.x_mm, high[0]),
      y_mm: between(low[1], placement.y_mm, high[1]),
      depth_mm: between(-this.highest_mm, placement.depth_mm, this.deepest_mm),
      tilt_x_deg: between(-30, placement.tilt_x_deg, 30),
      tilt_y_deg: between(-30, placement.tilt_y_deg, 30),
      twist_deg: between(-180, placement.twist_deg, 180),
    };
  }

  /** One piece of work after the other, whether or not the one before went well. */
  private inTurn<T>(work: () => Promise<T>): Promise<T> {
    const done = this.queue.then(work);
    this.queue = done.catch(() => undefined);
    return done;
  }
}

/** Above the middle of a gel. */
function lifted(sensor?: Sensor): Placement {
  const [low, high] = sensor?.gel_mm ?? [[0, 0, 0], [0, 0, 0]];
  const middle = (axis: 0 | 1) => (low[axis] + high[axis]) / 2;
  return { x_mm: middle(0), y_mm: middle(1), depth_mm: -1, tilt_x_deg: 0, tilt_y_deg: 0, twist_deg: 0 };
}

export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
