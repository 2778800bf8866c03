/** What a page asks of an engine, and what it is answered. Lengths in mm, forces in N, pressures in kPa; the gel's frame has z up and z = 0 at the board. */

export type Vector = [number, number, number];
/** `[x, y, z, w]` */
export type Quaternion = [number, number, number, number];

export interface Pose {
  position_mm: Vector;
  rotation: Quaternion;
}

/** A shape as descriptions have it: its kind, and its lengths by name. */
export type Shape = { kind: string } & Record<string, unknown>;

export interface Indenter {
  name: string;
  shape: Shape;
  friction?: number;
}

/** A shape at a pose. */
export interface Placed {
  shape: Shape;
  gel_from_indenter: Pose;
}

export interface Taxel {
  name: string;
  position_mm: Vector;
  port_radius_mm: number;
}

export interface Sensor {
  name: string;
  summary: string;
  source: string;
  /** The description in words. */
  description: string;
  /** Corners of the box that holds the gel. */
  gel_mm: [Vector, Vector];
  material: string;
  /** Whether the gel relaxes in time. */
  relaxes: boolean;
  taxels: Taxel[];
  indenters: Indenter[];
  shell: { gap_mm: number; height_mm: number } | null;
  limits: { force_n: number; depth_mm: number } | null;
}

/** A mesh to draw. */
export interface Mesh {
  n_nodes: number;
  n_tets: number;
  /** Height of the indenter's origin where it first touches the middle of the gel, upright: depths count from there. */
  touch_mm: number;
  surface_triangles: Uint32Array;
  tets: Uint32Array;
  rest_mm: Float32Array;
}

/** A surface to draw. */
export interface Outline {
  corners_mm: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
}

/** One moment of a press. Forces act on the gel. What finite elements compute and a surrogate does not is absent from its frames, and the other way round. */
export interface Frame {
  depth_mm: number;
  force_n: Vector;
  torque_n_mm: Vector;
  /** At the port of each taxel. */
  pressure_kpa: number[];
  contact_mm2?: number;
  converged?: boolean;
  iterations?: number;
  residual?: number;
  /** Out-of-distribution score of a surrogate: above 1, the numbers may be wrong. */
  ood_score?: number;
  provenance: string;
  /** Time that the engine took, ms. */
  took_ms: number;
  displacements_mm: Float32Array;
  node_pressure_kpa: Float32Array;
  node_von_mises_kpa: Float32Array;
  /** The pressure map, 64 × 64, rows from the lowest y on; empty where the taxels allow no map. */
  map_kpa: Float32Array;
}

/** What the program offers that the engine is part of: a file name and text of a sensor to begin with, and where frames of a sensor on the desk come from. */
export interface Offer {
  sensor: [file: string, text: string] | null;
  source: string | null;
}

/** The port that a line comes through. */
export interface Line {
  baud: number;
  /** Whether to set DTR: many boards start anew then. */
  dtr: boolean;
  /** How long to wait before `send`, s. */
  wait_s: number;
  /** What to send first. */
  send: string;
}

/** What a sensor on the desk reads. */
export interface DeskFrame {
  source: string;
  provenance: string;
  /** Frames so far. */
  n_frames: number;
  /** Whether what it reads untouched is still being found. */
  is_zeroing: boolean;
  /** Above that, of each taxel; null of one without a reading; empty while it is being found. */
  pressure_kpa: (number | null)[];
  /** What was odd so far. */
  remarks: string[];
  /** As of a frame of the gel; empty where a taxel has no reading. */
  map_kpa: Float32Array;
}

/** What presses a gel. Each method fails with one error whose message is for people. */
export interface Engine {
  /** Most nodes of the mesh that a page begins with: one that the engine keeps up with on a common computer. */
  readonly first_nodes: number;
  /** Keeps a file that descriptions name. */
  keep(name: string, bytes: Uint8Array): Promise<void>;
  /** Reads the description of a sensor. */
  open(file: string, text: string): Promise<Sensor>;
  /** Adds an indenter, described as in a sensor's `[[indenters]]`. */
  add(file: string, text: string): Promise<Sensor>;
  outline(shape: Shape): Promise<Outline>;
  /** Meshes the gel for an indenter that presses anywhere on it, this deep. */
  prepare(indenter: string, depth_mm: number, max_nodes: number): Promise<Mesh>;
  /** Takes the indenter to a pose. */
  step(pose: Pose, since_s: number): Promise<Frame>;
  /** Presses shapes by a surrogate of the gel, a file that was kept (`twintac fast train` makes such files). The gel of the last mesh is drawn as they indent it, without stress. Depth and torque are those of the first shape. */
  touch(surrogate: string, bodies: Placed[]): Promise<Frame>;
  /** Lets go of the gel. */
  rest(): Promise<void>;
  offer(): Promise<Offer>;
  /** Takes a line, described as for `twintac stream --line`, for that of the sensor on the desk. */
  listen(file: string, text: string): Promise<Line>;
  /** What the sensor on the desk reads; `bytes` are what came over its line since. */
  hear(bytes: Uint8Array): Promise<DeskFrame>;
  /** Takes the next frames of the sensor on the desk for untouched. */
  zero(): Promise<void>;
}
