/** The thread in which the engine works: the page stays free meanwhile. */

import type { Engine } from "./engine.ts";
import { ModuleEngine } from "./module.ts";

export interface Call {
  number: number;
  method: Exclude<keyof Engine, "first_nodes"> | "start";
  given: unknown[];
}

export type Answer = { number: number } & ({ answer: unknown } | { error: string });

const thread = self as unknown as { postMessage(answer: Answer, transfer: Transferable[]): void };
let engine: ModuleEngine | undefined;

async function answered({ method, given }: Call): Promise<unknown> {
  if (method === "start") {
    engine = await ModuleEngine.of(given[0] as ArrayBuffer);
    return undefined;
  }
  if (!engine) throw new Error("The engine has not started.");
  return (engine[method] as (...given: unknown[]) => Promise<unknown>)(...given);
}

/** The memory of arrays, which is handed over and not copied. */
function transferred(answer: unknown): Transferable[] {
  const values = Object.values((answer ?? {}) as object);
  return values.filter((value) => ArrayBuffer.isView(value)).map((value) => value.buffer as ArrayBuffer);
}

self.onmessage = async ({ data }: MessageEvent<Call>) => {
  try {
    const answer = await answered(data);
    thread.postMessage({ number: data.number, answer }, transferred(answer));
  } catch (error) {
    const message = error instanceof Error ? error.message : String(error);
    thread.postMessage({ number: data.number, error: message }, []);
  }
};
