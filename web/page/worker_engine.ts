/** An engine in a thread of its own. */

import type { DeskFrame, Engine, Frame, Line, Mesh, Offer, Outline, Placed, Pose, Sensor, Shape } from "./engine.ts";
import { FIRST_NODES } from "./module.ts";
import type { Answer, Call } from "./worker.ts";

interface Waiting {
  resolve(answer: unknown): void;
  reject(error: Error): void;
}

export class WorkerEngine implements Engine {
  readonly first_nodes = FIRST_NODES;
  private readonly waiting = new Map<number, Waiting>();
  private calls = 0;

  private constructor(private readonly worker: Worker) {
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      const waiting = this.waiting.get(data.number);
      this.waiting.delete(data.number);
      if ("error" in data) waiting?.reject(new Error(data.error));
      else waiting?.resolve(data.answer);
    };
    worker.onerror = (event) => {
      for (const waiting of this.waiting.values()) waiting.reject(new Error(event.message));
      this.waiting.clear();
    };
  }

  /** Starts a thread of this program, with this WebAssembly module. */
  static async of(program: string, wasm: ArrayBuffer): Promise<WorkerEngine> {
    const blob = new Blob([program], { type: "text/javascript" });
    const engine = new WorkerEngine(new Worker(URL.createObjectURL(blob)));
    await engine.call("start", wasm);
    return engine;
  }

  keep(name: string, bytes: Uint8Array): Promise<void> {
    return this.call("keep", name, bytes);
  }
  open(file: string, text: string): Promise<Sensor> {
    return this.call("open", file, text);
  }
  add(file: string, text: string): Promise<Sensor> {
    return this.call("add", file, text);
  }
  outline(shape: Shape): Promise<Outline> {
    return this.call("outline", shape);
  }
  prepare(indenter: string, depth_mm: number, max_nodes: number): Promise<Mesh> {
    return this.call("prepare", indenter, depth_mm, max_nodes);
  }
  step(pose: Pose, since_s: number): Promise<Frame> {
    return this.call("step", pose, since_s);
  }
  touch(surrogate: string, bodies: Placed[]): Promise<Frame> {
    return this.call("touch", surrogate, bodies);
  }
  rest(): Promise<void> {
    return this.call("rest");
  }
  offer(): Promise<Offer> {
    return this.call("offer");
  }
  listen(file: string, text: string): Promise<Line> {
    return this.call("listen", file, text);
  }
  hear(bytes: Uint8Array): Promise<DeskFrame> {
    return this.call("hear", bytes);
  }
  zero(): Promise<void> {
    return this.call("zero");
  }

  private call<Answered>(method: Call["method"], ...given: unknown[]): Promise<Answered> {
    return new Promise((resolve, reject) => {
      const number = this.calls++;
      this.waiting.set(number, { resolve: resolve as Waiting["resolve"], reject });
      this.worker.postMessage({ number, method, given } satisfies Call);
    });
  }
}
