/** The WebAssembly module of the engine: one function that answers requests, and arrays beside it. */

import { type ArrayName, ARRAYS, RequestEngine } from "./request_engine.ts";

/** The mesh that WebAssembly keeps up with on a common computer. */
export const FIRST_NODES = 2000;

interface Exports {
  memory: WebAssembly.Memory;
  buffer(length: number): number;
  answer(request_length: number): number;
  answer_start(): number;
  array_start(number: number): number;
  array_length(number: number): number;
  fault_start(): number;
  fault_length(): number;
}

/** An engine in the thread that makes it. */
export class ModuleEngine extends RequestEngine {
  readonly first_nodes = FIRST_NODES;

  private constructor(private readonly exports: Exports) {
    super();
  }

  static async of(wasm: BufferSource): Promise<ModuleEngine> {
    const { instance } = await WebAssembly.instantiate(wasm, {});
    return new ModuleEngine(instance.exports as unknown as Exports);
  }

  protected async ask(request: object, bytes: Uint8Array = new Uint8Array()): Promise<unknown> {
    const text = new TextEncoder().encode(JSON.stringify(request));
    const start = this.exports.buffer(text.length + bytes.length);
    const buffer = this.view(start, text.length + bytes.length);
    buffer.set(text);
    buffer.set(bytes, text.length);
    const answer = JSON.parse(this.text(this.answered(text.length), this.exports.answer_start()));
    if (answer.error !== undefined) throw new Error(answer.error);
    return answer;
  }

  private answered(request_length: number): number {
    try {
      return this.exports.answer(request_length);
    } catch (trap) {
      const fault = this.text(this.exports.fault_length(), this.exports.fault_start());
      throw new Error(`The engine failed: ${fault || trap}. Load the page again.`);
    }
  }

  private view(start: number, length: number): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.exports.memory.buffer as ArrayBuffer, start, length);
  }

  private text(length: number, start: number): string {
    return new TextDecoder().decode(this.view(start, length));
  }

  /** A copy: the memory is the engine's own. */
  protected numbers(name: ArrayName): Float32Array {
    const number = ARRAYS.indexOf(name);
    const [start, length] = [this.exports.array_start(number), this.exports.array_length(number)];
    return length ? new Float32Array(this.exports.memory.buffer, start, length).slice() : new Float32Array();
  }

  protected indices(name: ArrayName): Uint32Array {
    const number = ARRAYS.indexOf(name);
    const [start, length] = [this.exports.array_start(number), this.exports.array_length(number)];
    return length ? new Uint32Array(this.exports.memory.buffer, start, length).slice() : new Uint32Array();
  }
}
