/** An engine that is asked in texts: `crates/app/engine`, wherever it works. */

import type { DeskFrame, Engine, Frame, Line, Mesh, Offer, Outline, Placed, Pose, Sensor, Shape } from "./engine.ts";

/** The arrays, in the order of their numbers. */
export const ARRAYS = [
  "surface_triangles",
  "tets",
  "rest_mm",
  "displacements_mm",
  "pressure_kpa",
  "von_mises_kpa",
  "map_kpa",
  "outline_mm",
  "outline_normals",
  "outline_triangles",
  "desk_map_kpa",
] as const;
export type ArrayName = (typeof ARRAYS)[number];

export abstract class RequestEngine implements Engine {
  abstract readonly first_nodes: number;

  /** Its answer to a request, with the bytes of a file that it keeps, or of a line. */
  protected abstract ask(request: object, bytes?: Uint8Array): Promise<unknown>;
  /** An array after the last answer, for the caller alone. */
  protected abstract numbers(name: ArrayName): Float32Array;
  protected abstract indices(name: ArrayName): Uint32Array;

  async keep(name: string, bytes: Uint8Array): Promise<void> {
    await this.ask({ do: "keep", name }, bytes);
  }

  async open(file: string, text: string): Promise<Sensor> {
    return (await this.ask({ do: "open", file, text })) as Sensor;
  }

  async add(file: string, text: string): Promise<Sensor> {
    return (await this.ask({ do: "add", file, text })) as Sensor;
  }

  async outline(shape: Shape): Promise<Outline> {
    await this.ask({ do: "outline", shape });
    return {
      corners_mm: this.numbers("outline_mm"),
      normals: this.numbers("outline_normals"),
      triangles: this.indices("outline_triangles"),
    };
  }

  async prepare(indenter: string, depth_mm: number, max_nodes: number): Promise<Mesh> {
    const prepared = (await this.ask({ do: "prepare", indenter, depth_mm, max_nodes })) as Mesh;
    return {
      ...prepared,
      surface_triangles: this.indices("surface_triangles"),
      tets: this.indices("tets"),
      rest_mm: this.numbers("rest_mm"),
    };
  }

  step(pose: Pose, since_s: number): Promise<Frame> {
    return this.frame({ do: "step", since_s, gel_from_indenter: pose });
  }

  touch(surrogate: string, bodies: Placed[]): Promise<Frame> {
    return this.frame({ do: "touch", surrogate, bodies });
  }

  private async frame(request: object): Promise<Frame> {
    const started = performance.now();
    const frame = (await this.ask(request)) as Frame;
    return {
      ...frame,
      took_ms: performance.now() - started,
      displacements_mm: this.numbers("displacements_mm"),
      node_pressure_kpa: this.numbers("pressure_kpa"),
      node_von_mises_kpa: this.numbers("von_mises_kpa"),
      map_kpa: this.numbers("map_kpa"),
    };
  }

  async rest(): Promise<void> {
    await this.ask({ do: "rest" });
  }

  async offer(): Promise<Offer> {
    return (await this.ask({ do: "offer" })) as Offer;
  }

  async listen(file: string, text: string): Promise<Line> {
    return (await this.ask({ do: "listen", file, text })) as Line;
  }

  async hear(bytes: Uint8Array): Promise<DeskFrame> {
    const heard = (await this.ask({ do: "hear" }, bytes)) as DeskFrame;
    return { ...heard, map_kpa: this.numbers("desk_map_kpa") };
  }

  async zero(): Promise<void> {
    await this.ask({ do: "zero" });
  }
}
