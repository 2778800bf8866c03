/** The engine of `twintac view`, behind a WebSocket. */

import { type ArrayName, ARRAYS, RequestEngine } from "./request_engine.ts";

interface Waiting {
  resolve(answer: unknown): void;
  reject(error: Error): void;
}

const ENDED = "`twintac view` has ended, or was ended by an error: start it again, and open the address that it prints.";

export class SocketEngine extends RequestEngine {
  readonly first_nodes = 4000;
  /** Who waits for an answer: they come in the order of the requests. */
  private readonly waiting: Waiting[] = [];
  private readonly arrays = new Map<number, ArrayBuffer>();

  private constructor(private readonly socket: WebSocket) {
    super();
    socket.onmessage = ({ data }: MessageEvent<ArrayBuffer>) => this.take(data);
    socket.onclose = () => {
      for (const { reject } of this.waiting.splice(0)) reject(new Error(ENDED));
    };
  }

  /** Whether a page with this address comes from `twintac view`. */
  static isAt(address: Location): boolean {
    return address.protocol === "http:" && new URLSearchParams(address.search).has("token");
  }

  /** Talks to the program that the page comes from. */
  static of(address: Location): Promise<SocketEngine> {
    const socket = new WebSocket(`ws://${address.host}/engine${address.search}`);
    socket.binaryType = "arraybuffer";
    return new Promise((resolve, reject) => {
      socket.onopen = () => resolve(new SocketEngine(socket));
      socket.onclose = () => reject(new Error(ENDED));
    });
  }

  protected ask(request: object, bytes: Uint8Array = new Uint8Array()): Promise<unknown> {
    if (this.socket.readyState !== WebSocket.OPEN) return Promise.reject(new Error(ENDED));
    const text = new TextEncoder().encode(JSON.stringify(request));
    const message = new Uint8Array(4 + text.length + bytes.length);
    new DataView(message.buffer).setUint32(0, text.length, true);
    message.set(text, 4);
    message.set(bytes, 4 + text.length);
    return new Promise((resolve, reject) => {
      this.waiting.push({ resolve, reject });
      this.socket.send(message);
    });
  }

  /** Takes an answer: the length of a text, the text, and arrays, each its number, its length and its entries. */
  private take(message: ArrayBuffer): void {
    const view = new DataView(message);
    const length = view.getUint32(0, true);
    const answer = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length)));
    for (let at = 4 + length; at < message.byteLength; ) {
      const [number, entries] = [view.getUint32(at, true), view.getUint32(at + 4, true)];
      this.arrays.set(number, message.slice(at + 8, at + 8 + 4 * entries));
      at += 8 + 4 * entries;
    }
    const waiting = this.waiting.shift();
    if (answer.error !== undefined) waiting?.reject(new Error(answer.error));
    else waiting?.resolve(answer);
  }

  protected numbers(name: ArrayName): Float32Array {
    return new Float32Array(this.arrays.get(ARRAYS.indexOf(name)) ?? new ArrayBuffer());
  }

  protected indices(name: ArrayName): Uint32Array {
    return new Uint32Array(this.arrays.get(ARRAYS.indexOf(name)) ?? new ArrayBuffer());
  }
}
