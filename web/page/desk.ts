/** A sensor on the desk: frames come over a serial port that the page reads, or from the program that the page comes from. */

import type { DeskFrame, Engine } from "./engine.ts";

/** How often is asked what the sensor reads, ms. */
const PERIOD_MS = 40;

/** After how long without a frame that is said, ms. */
const SILENCE_MS = 3000;

/** Most bytes that wait for the engine: what is older is let go. */
const MOST_WAITING = 1 << 20;

/** What of WebSerial is used: https://wicg.github.io/serial/ */
interface SerialPort {
  readonly readable: ReadableStream<Uint8Array> | null;
  readonly writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number }): Promise<void>;
  close(): Promise<void>;
  setSignals(signals: { dataTerminalReady: boolean }): Promise<void>;
}

export interface DeskListener {
  frame(frame: DeskFrame): void;
  /** Nothing comes any more: why, if that was not asked for. */
  end(fault?: Error): void;
}

const sleep = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

export class Desk {
  private isOn = true;
  private waiting: Uint8Array[] = [];
  private fault: Error | undefined;
  private reader: ReadableStreamDefaultReader<Uint8Array> | undefined;
  private ended: Promise<void> = Promise.resolve();

  private constructor(
    private readonly engine: Engine,
    private readonly listener: DeskListener,
    private readonly port?: SerialPort,
  ) {}

  /** The sensor that the program has beside its engine. */
  static ofProgram(engine: Engine, listener: DeskListener): Desk {
    const desk = new Desk(engine, listener);
    desk.ended = desk.listen();
    return desk;
  }

  /** A sensor on a serial port that a person chooses. The line is described as for `twintac stream`. */
  static async ofPort(engine: Engine, file: string, text: string, listener: DeskListener): Promise<Desk> {
    const { serial } = navigator as { serial?: { requestPort(): Promise<SerialPort> } };
    if (!serial) throw new Error("This browser reads no serial ports: use Chrome or Edge on a computer, or `twintac view --serial PORT --line FILE`.");
    const line = await engine.listen(file, text);
    const port = await serial.requestPort();
    await port.open({ baudRate: line.baud });
    const desk = new Desk(engine, listener, port);
    try {
      await port.setSignals({ dataTerminalReady: line.dtr });
      await sleep(1000 * line.wait_s);
      if (line.send) await desk.send(line.send);
    } catch (error) {
      await port.close();
      throw error;
    }
    void desk.read();
    desk.ended = desk.listen();
    return desk;
  }

  /** Lets go of the sensor; the listener has heard of the end then. */
  async stop(): Promise<void> {
    await this.letGo();
    await this.ended;
  }

  private async letGo(): Promise<void> {
    this.isOn = false;
    await this.reader?.cancel().catch(() => undefined);
  }

  private async send(text: string): Promise<void> {
    const writer = this.port!.writable!.getWriter();
    await writer.write(new TextEncoder().encode(text));
    writer.releaseLock();
  }

  /** Reads the port until it is gone. A reading that fails ends one stream of the port, which then has another. */
  private async read(): Promise<void> {
    while (this.isOn && this.port!.readable) {
      this.reader = this.port!.readable.getReader();
      try {
        for (let got = await this.reader.read(); !got.done; got = await this.reader.read()) this.take(got.value);
      } catch (error) {
        if (!this.port!.readable) this.fault = new Error(`The serial port is gone: ${error instanceof Error ? error.message : String(error)}`);
      } finally {
        this.reader.releaseLock();
      }
    }
    if (this.isOn && !this.port!.readable) this.fault ??= new Error("The serial port is gone.");
    await this.port!.close().catch(() => undefined);
  }

  private take(bytes: Uint8Array): void {
    this.waiting.push(bytes);
    for (let length = this.waiting.reduce((sum, piece) => sum + piece.length, 0); length > MOST_WAITING; ) length -= this.waiting.shift()!.length;
  }

  private taken(): Uint8Array {
    const pieces = this.waiting.splice(0);
    const bytes = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0));
    let at = 0;
    for (const piece of pieces) {
      bytes.set(piece, at);
      at += piece.length;
    }
    return bytes;
  }

  /** Asks what the sensor reads, until it is let go. */
  private async listen(): Promise<void> {
    let [n_frames, heardAt] = [0, performance.now()];
    try {
      while (this.isOn) {
        const heard = await this.engine.hear(this.taken());
        if (this.fault) throw this.fault;
        if (heard.n_frames !== n_frames) [n_frames, heardAt] = [heard.n_frames, performance.now()];
        const silent_s = Math.floor((performance.now() - heardAt) / 1000);
        if (1000 * silent_s >= SILENCE_MS) heard.remarks.push(`no frame came for ${silent_s} s`);
        this.listener.frame(heard);
        await sleep(PERIOD_MS);
      }
      this.listener.end();
    } catch (error) {
      await this.letGo();
      this.listener.end(error as Error);
    }
  }
}
