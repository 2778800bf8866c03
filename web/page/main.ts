/** The page: connects the press to what is shown and what is touched. */

import { GRADIENT, type Scale } from "./colours.ts";
import { Desk } from "./desk.ts";
import type { DeskFrame, Engine, Frame, Indenter, Mesh, Outline, Sensor } from "./engine.ts";
import { Gestures } from "./gestures.ts";
import { type Shared, decode, encode } from "./link.ts";
import { FIELDS, type Placement, isSame, poseOf } from "./placement.ts";
import { NODES, Press, messageOf } from "./press.ts";
import { Readings } from "./readings.ts";
import { Recording } from "./recording.ts";
import { type Colouring, Scene } from "./scene.ts";
import { SideBySide } from "./side_by_side.ts";
import { Section } from "./section.ts";
import { indenterText, resized, sizeOf } from "./toml.ts";
import { SocketEngine } from "./socket_engine.ts";
import { WorkerEngine } from "./worker_engine.ts";

/** Descriptions that the page has, by file name, written here when it is made. */
declare const SENSORS: Record<string, string>;
declare const MATERIALS: Record<string, string>;
declare const LINES: Record<string, string>;
/** Surrogates of the gels of these sensors, compressed by gzip, as base64. */
declare const SURROGATES: Record<string, string>;
/** The program of the engine's thread, and the module: compressed by gzip, as base64. */
declare const WORKER_PROGRAM: string;
declare const MODULE_GZIP: string;

const FIRST_SENSOR = "phystac.toml";

/** What a slider is called, its unit and its step. */
const SLIDERS: Record<keyof Placement, [name: string, unit: string, step: number]> = {
  x_mm: ["x", "mm", 0.1],
  y_mm: ["y", "mm", 0.1],
  depth_mm: ["Depth", "mm", 0.02],
  tilt_x_deg: ["Tilt about x", "°", 0.5],
  tilt_y_deg: ["Tilt about y", "°", 0.5],
  twist_deg: ["Twist", "°", 1],
};

function element<Kind extends HTMLElement = HTMLElement>(id: string): Kind {
  return document.getElementById(id) as Kind;
}

class Page {
  private readonly scene = new Scene(element<HTMLCanvasElement>("scene"));
  private readonly readings = new Readings(element("bars"), element<HTMLCanvasElement>("map"));
  private readonly sideBySide = new SideBySide();
  private desk: Desk | undefined;
  private deskFrame: DeskFrame | undefined;
  /** Descriptions of lines, by file name. */
  private readonly lines = { ...LINES };
  private readonly section = new Section(element<HTMLCanvasElement>("section"));
  private readonly gestures: Gestures;
  readonly press: Press;
  private sliders = new Map<keyof Placement, { input: HTMLInputElement; output: HTMLOutputElement }>();
  private mesh: Mesh | undefined;
  private outline: Outline | undefined;
  private frame: { frame: Frame; at: Placement } | undefined;
  private isStale = false;
  private recording: Recording | undefined;
  private isRecording = false;
  /** The description that was asked for last, and whether the page has it by itself. */
  private opened = { file: FIRST_SENSOR, text: "" };
  /** Indenters as they are described. */
  private described: Indenter[] = [];
  /** The text of the indenter in use, where it is none of those. */
  private indenterText: string | undefined;
  private isFromFile = false;
  private seconds = 0;
  /** Of what people asked for, how much is not done yet. */
  private attempts = 0;
  /** Surrogates that the engine keeps. */
  private readonly kept = new Set<string>();

  constructor(private readonly engine: Engine) {
    this.press = new Press(engine, {
      sensor: (sensor) => this.showSensor(sensor),
      outline: (outline) => {
        this.outline = outline;
        this.scene.outline(outline);
      },
      mesh: (mesh, nodes) => {
        this.mesh = mesh;
        this.scene.mesh(mesh);
        this.showNodes(nodes);
      },
      left: (shapes) => {
        this.scene.left(shapes);
        element<HTMLButtonElement>("clear").disabled = shapes.length === 0;
      },
      frame: (frame, at) => {
        this.frame = { frame, at };
        this.isStale = true;
        if (this.isRecording) this.recording?.add(frame, at, 1 + this.press.left.length);
      },
      status: (text, kind) => this.say(text, kind),
    });
    this.gestures = new Gestures(element<HTMLCanvasElement>("scene"), this.scene, this.press);
    for (const gradient of document.querySelectorAll<HTMLElement>(".gradient")) gradient.style.background = GRADIENT;
    this.makeSliders();
    this.listen();
    requestAnimationFrame(() => this.draw());
  }

  async start(): Promise<void> {
    for (const [name, text] of Object.entries(MATERIALS)) await this.press.keep(name, new TextEncoder().encode(text));
    const { sensor, source } = await this.engine.offer();
    if (location.hash.length > 1) await this.attempt(() => this.restore(location.hash.slice(1)));
    if (!this.press.sensor) {
      this.press.isAutomatic = true;
      await this.open(...(sensor ?? ([FIRST_SENSOR, SENSORS[FIRST_SENSOR]!] as const)));
      this.press.aim({ depth_mm: 0.12 * this.press.sensor!.gel_mm[1][2] });
    }
    this.showLines("packets-8.toml");
    if (source !== null) this.desk = Desk.ofProgram(this.engine, this.deskListener);
  }

  private readonly deskListener = {
    frame: (frame: DeskFrame) => {
      this.deskFrame = frame;
      this.isStale = true;
    },
    end: (fault?: Error) => {
      this.desk = this.deskFrame = undefined;
      element("desk").hidden = true;
      element<HTMLButtonElement>("connect").disabled = false;
      if (fault) void this.attempt(() => Promise.reject(fault));
    },
  };

  private async connect(): Promise<void> {
    await this.desk?.stop();
    const file = element<HTMLSelectElement>("line").value;
    this.desk = await Desk.ofPort(this.engine, file, this.lines[file]!, this.deskListener);
    element<HTMLButtonElement>("connect").disabled = true;
  }

  private async describeLine(files: FileList | null): Promise<void> {
    const file = files?.[0];
    if (!file) return;
    this.lines[file.name] = await file.text();
    this.showLines(file.name);
  }

  private showLines(chosen: string): void {
    const select = element<HTMLSelectElement>("line");
    select.replaceChildren(...Object.keys(this.lines).map((name) => new Option(name.replace(/\.toml$/, ""), name)));
    select.value = chosen;
  }

  private async open(file: string, text: string, indenter = "", asksSurrogate = this.press.surrogate !== undefined): Promise<void> {
    const before = this.opened;
    this.opened = { file, text };
    try {
      const surrogate = asksSurrogate ? await this.surrogateOf(file, text) : undefined;
      await this.press.open(file, text, indenter, surrogate);
    } catch (error) {
      this.opened = before;
      throw error;
    }
    this.indenterText = undefined;
    this.described = this.press.sensor!.indenters;
    this.isFromFile = false;
    this.showIndenter();
    this.showSolver();
  }

  /** The surrogate that the page has of a sensor's gel, handed to the engine. */
  private async surrogateOf(file: string, text: string): Promise<string | undefined> {
    const name = file.replace(/\.toml$/, ".safetensors");
    const compressed = SURROGATES[name];
    if (SENSORS[file] !== text || compressed === undefined) return undefined;
    if (!this.kept.has(name)) await this.press.keep(name, new Uint8Array(await unzipped(compressed)));
    this.kept.add(name);
    return name;
  }

  private async useSolver(solver: string): Promise<void> {
    try {
      if (solver !== "surrogate") return await this.press.useSurrogate(undefined);
      const { file, text } = this.opened;
      const surrogate = await this.surrogateOf(file, text);
      if (surrogate === undefined) {
        throw new Error("The page has no surrogate of this gel. Make one by `twintac fast train`, and drop its file (.safetensors) on the page.");
      }
      await this.press.useSurrogate(surrogate);
    } finally {
      this.showSolver();
    }
  }

  private async takeSurrogate(file: string): Promise<void> {
    this.kept.delete(file);
    try {
      await this.press.useSurrogate(file);
    } finally {
      this.showSolver();
    }
  }

  private showSolver(): void {
    const isSurrogate = this.press.surrogate !== undefined;
    element<HTMLSelectElement>("solver").value = isSurrogate ? "surrogate" : "elements";
    for (const id of ["leave", "clear", "ood_score"]) element(id).hidden = !isSurrogate;
    element("contact").parentElement!.hidden = isSurrogate;
    // Nothing is known of the stress in the gel.
    element("cut").hidden = isSurrogate;
    this.redraw();
  }

  private say(text: string, kind: "ready" | "busy" | "error"): void {
    const status = element("status");
    status.classList.toggle("fault", kind === "error");
    if (status.textContent !== text) status.textContent = text;
  }

  /** Does what people ask for, and tells them where that can't be. */
  async attempt(work: () => Promise<void>): Promise<void> {
    const place = element("error");
    place.hidden = true;
    place.textContent = "";
    this.attempts += 1;
    try {
      await work();
    } catch (error) {
      place.hidden = false;
      place.textContent = messageOf(error);
    } finally {
      this.attempts -= 1;
    }
  }

  private showSensor(sensor: Sensor): void {
    element("summary").textContent = `${sensor.name}: ${sensor.summary}`;
    element("description").textContent = sensor.description;
    this.scene.sensor(sensor);
    this.readings.sensor(sensor);
    this.sideBySide.sensor(sensor);
    const [low, high] = sensor.gel_mm;
    const ranges: Partial<Record<keyof Placement, [number, number]>> = {
      x_mm: [low[0], high[0]],
      y_mm: [low[1], high[1]],
      depth_mm: [-this.press.highest_mm, this.press.deepest_mm],
      tilt_x_deg: [-30, 30],
      tilt_y_deg: [-30, 30],
      twist_deg: [-180, 180],
    };
    for (const [field, { input }] of this.sliders) [input.min, input.max] = ranges[field]!.map(String) as [string, string];
    const sensors = element<HTMLSelectElement>("sensor");
    const names = [...Object.keys(SENSORS), ...(SENSORS[this.opened.file] === this.opened.text ? [] : [this.opened.file])];
    sensors.replaceChildren(...names.map((name) => new Option(name.replace(/\.toml$/, ""), name)));
    sensors.selectedIndex = SENSORS[this.opened.file] === this.opened.text ? names.indexOf(this.opened.file) : names.length - 1;
  }

  private showIndenter(): void {
    const { sensor, indenter } = this.press;
    // One that was added or changed is the last of the sensor's; people look for it where it was.
    const known = this.described.map(({ name }) => name);
    const place = (name: string) => (known.indexOf(name) + 1 || known.length + 1);
    const names = (sensor?.indenters.map(({ name }) => name) ?? []).sort((a, b) => place(a) - place(b));
    const select = element<HTMLSelectElement>("indenter");
    select.replaceChildren(...names.map((name) => new Option(name)));
    select.value = indenter;
    const size = sizeOf(sensor!.indenters.find(({ name }) => name === indenter)!);
    const input = element<HTMLInputElement>("size");
    input.disabled = !size;
    input.value = size ? String(size.size_mm) : "";
    element("size-name").textContent = `${size?.name ?? "Size"} (mm)`;
  }

  private showNodes(nodes: number): void {
    const select = element<HTMLSelectElement>("nodes");
    const counts = NODES.map((count) => new Option(count.toLocaleString("en"), String(count)));
    select.replaceChildren(new Option(`automatic (${nodes.toLocaleString("en")})`, "automatic"), ...counts);
    select.value = this.press.isAutomatic ? "automatic" : String(nodes);
  }

  private makeSliders(): void {
    for (const field of FIELDS) {
      const [name, , step] = SLIDERS[field];
      const [label, input, output] = [document.createElement("label"), document.createElement("input"), document.createElement("output")];
      input.type = "range";
      input.id = field;
      input.step = "any";
      input.addEventListener("input", () => this.press.aim({ [field]: Math.round(Number(input.value) / step) * step }));
      // Without steps of its own a slider that is moved by keys would jump.
      input.addEventListener("keydown", (event) => {
        const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
        if (way === undefined) return;
        event.preventDefault();
        this.press.aim({ [field]: this.press.target[field] + way * step });
      });
      label.append(name, input, output);
      element("placement").append(label);
      this.sliders.set(field, { input, output });
    }
  }

  private listen(): void {
    const chosen = (id: string, then: (value: string) => Promise<void>) =>
      element<HTMLSelectElement>(id).addEventListener("change", (event) => {
        void this.attempt(() => then((event.target as HTMLSelectElement).value));
      });
    const clicked = (id: string, then: () => void) => element(id).addEventListener("click", then);
    chosen("sensor", async (file) => {
      if (SENSORS[file]) await this.open(file, SENSORS[file]);
    });
    chosen("indenter", (name) => this.take(name));
    chosen("solver", (solver) => this.useSolver(solver));
    chosen("nodes", (nodes) => this.press.useNodes(nodes === "automatic" ? nodes : Number(nodes)));
    chosen("size", (size) => this.resize(Number(size)));
    for (const id of ["colouring", "across", "magnified"]) chosen(id, async () => this.redraw());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      if (this.press.sensor) this.scene.sensor(this.press.sensor);
      this.redraw();
    });
    new ResizeObserver(() => this.redraw()).observe(element("section"));
    clicked("drag-indenter", () => this.dragTurns(false));
    clicked("drag-view", () => this.dragTurns(true));
    clicked("nearer", () => this.scene.look(0, 0, 1.15));
    clicked("farther", () => this.scene.look(0, 0, 1 / 1.15));
    clicked("lift", () => this.press.aim({ depth_mm: -1 }));
    clicked("leave", () => void this.attempt(() => this.press.leave()));
    clicked("clear", () => void this.attempt(() => this.press.replaceLeft([])));
    clicked("record", () => this.record());
    clicked("download", () => this.download());
    clicked("share", () => void this.attempt(() => this.share()));
    clicked("connect", () => void this.attempt(() => this.connect()));
    clicked("desk-zero", () => void this.attempt(() => this.engine.zero()));
    clicked("desk-stop", () => void this.desk?.stop());
    const line = element<HTMLInputElement>("line-file");
    line.addEventListener("change", () => void this.attempt(() => this.describeLine(line.files)));
    const input = element<HTMLInputElement>("file");
    input.addEventListener("change", () => void this.attempt(() => this.takeFiles(input.files ?? undefined)));
    document.addEventListener("dragover", (event) => {
      event.preventDefault();
      document.body.classList.add("drop");
    });
    document.addEventListener("dragleave", () => document.body.classList.remove("drop"));
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("drop");
      void this.attempt(() => this.takeFiles(event.dataTransfer?.files));
    });
    window.addEventListener("hashchange", () => void this.attempt(() => this.restore(location.hash.slice(1))));
  }

  private dragTurns(turns: boolean): void {
    this.gestures.turnsView = turns;
    element("drag-view").setAttribute("aria-pressed", String(turns));
    element("drag-indenter").setAttribute("aria-pressed", String(!turns));
  }

  private async take(name: string): Promise<void> {
    const described = this.described.find((indenter) => indenter.name === name);
    this.indenterText = undefined;
    // The sensor may have it in another size.
    if (described && described.shape.kind !== "stl") await this.press.add(`${name}.toml`, indenterText(described));
    else await this.press.take(name);
    this.isFromFile = !described;
    this.showIndenter();
  }

  private async resize(size_mm: number): Promise<void> {
    const indenter = this.press.sensor!.indenters.find(({ name }) => name === this.press.indenter)!;
    const text = indenterText(resized(indenter, size_mm));
    await this.press.add(`${indenter.name}.toml`, text);
    this.indenterText = text;
    this.showIndenter();
  }

  /** Takes files: surfaces and materials are kept for descriptions that name them, and the last description or surface is used. */
  private async takeFiles(files: FileList | undefined): Promise<void> {
    let use: (() => Promise<void>) | undefined;
    for (const file of files ?? []) {
      const bytes = new Uint8Array(await file.arrayBuffer());
      await this.press.keep(file.name, bytes);
      const text = () => new TextDecoder().decode(bytes);
      if (/\.stl$/i.test(file.name)) use ??= () => this.takeSurface(file.name);
      else if (/\.toml$/i.test(file.name) && /^\s*(shape\s*[.=]|\[shape)/m.test(text()) && !/^\s*\[\[/m.test(text())) {
        use = () => this.takeIndenter(file.name, text(), true);
      } else if (/\.toml$/i.test(file.name) && /\btaxels\b|\[gel/.test(text())) use = () => this.open(file.name, text());
      else if (/\.toml$/i.test(file.name)) use ??= () => this.open(file.name, text());
      else if (/\.safetensors$/i.test(file.name)) use = () => this.takeSurrogate(file.name);
      else throw new Error(`\`${file.name}\` is neither a description (.toml) nor a surface (.stl) nor a surrogate (.safetensors).`);
    }
    element<HTMLInputElement>("file").value = "";
    await use?.();
  }

  private async takeSurface(file: string): Promise<void> {
    const name = file.replace(/\.stl$/i, "").replaceAll(/[^A-Za-z0-9_-]/g, "-");
    const unit = element<HTMLSelectElement>("unit").value;
    const text = indenterText({ name, shape: { kind: "stl", path: file, unit } });
    await this.takeIndenter(`${name}.toml`, text, true);
  }

  private async takeIndenter(file: string, text: string, isFromFile: boolean): Promise<void> {
    await this.press.add(file, text);
    this.isFromFile = isFromFile && text.includes("stl");
    this.indenterText = text;
    this.showIndenter();
  }

  private record(): void {
    this.isRecording = !this.isRecording;
    if (this.isRecording) this.recording = new Recording(this.press.sensor!, this.press.indenter);
    const button = element<HTMLButtonElement>("record");
    button.textContent = this.isRecording ? "Stop" : "Record";
    button.setAttribute("aria-pressed", String(this.isRecording));
    element<HTMLButtonElement>("download").disabled = this.isRecording || !this.recording?.n_frames;
    element("kept").textContent = this.isRecording ? "Recording each frame." : `${this.recording?.n_frames ?? 0} frames recorded.`;
  }

  private download(): void {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([this.recording!.csv], { type: "text/csv" }));
    link.download = `${this.press.sensor!.name}-simulated.csv`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  private async share(): Promise<void> {
    if (this.isFromFile) throw new Error("A link can't hold an STL file: send the file, and a link to a shape of the sensor.");
    const { surrogate, left } = this.press;
    if (surrogate !== undefined && !this.kept.has(surrogate)) throw new Error("A link can't hold the file of a surrogate: send the file.");
    if (left.some(({ shape }) => shape.kind === "stl")) throw new Error("A link can't hold an STL file: take the shapes away that were left.");
    await this.press.pressAnew(this.press.target); // who opens the link sees what this page shows
    const { file, text } = this.opened;
    const shared: Shared = {
      version: 1,
      sensor: SENSORS[file] === text ? { file } : { file, text },
      indenter: this.press.indenter,
      ...(this.indenterText === undefined ? {} : { indenter_text: this.indenterText }),
      placement: this.press.target,
      ...(surrogate === undefined ? {} : { surrogate, left: left.map(({ shape, gel_from_indenter }) => ({ shape, gel_from_indenter })) }),
      max_nodes: this.press.nodes,
      colouring: element<HTMLSelectElement>("colouring").value as Colouring,
      magnified: this.magnified,
      across: this.across,
    };
    history.replaceState(null, "", `#${await encode(shared)}`);
    const isCopied = await navigator.clipboard?.writeText(location.href.replace(location.search, "")).then(
      () => true,
      () => false,
    );
    element("kept").textContent = isCopied ? "The link is copied." : "The link stands in the address bar.";
  }

  /** Restores what a link says, pressed anew as on the page that made it. */
  private async restore(fragment: string): Promise<void> {
    const shared = await decode(fragment);
    const text = shared.sensor.text ?? SENSORS[shared.sensor.file];
    if (text === undefined) throw new Error(`The link names a sensor that this page does not have: \`${shared.sensor.file}\`.`);
    const choose = (id: string, value: string) => (element<HTMLSelectElement>(id).value = value);
    choose("colouring", shared.colouring);
    choose("across", String(shared.across));
    choose("magnified", String(shared.magnified));
    this.press.isAutomatic = false;
    this.press.nodes = shared.max_nodes;
    await this.open(shared.sensor.file, text, shared.indenter, shared.surrogate !== undefined);
    if (shared.indenter_text !== undefined) await this.takeIndenter(`${shared.indenter}.toml`, shared.indenter_text, false);
    await this.press.replaceLeft(shared.left ?? []);
    await this.press.pressAnew(shared.placement);
  }

  private get colouring(): Colouring {
    if (this.press.surrogate !== undefined) return "plain";
    return element<HTMLSelectElement>("colouring").value as Colouring;
  }

  private get magnified(): number {
    return Number(element<HTMLSelectElement>("magnified").value);
  }

  private get across(): 0 | 1 {
    return Number(element<HTMLSelectElement>("across").value) as 0 | 1;
  }

  private redraw(): void {
    this.isStale = true;
  }

  private draw(): void {
    requestAnimationFrame(() => this.draw());
    for (const [field, { input, output }] of this.sliders) {
      const wanted = this.press.target[field];
      if (document.activeElement !== input || Math.abs(Number(input.value) - wanted) > 1e-6) input.value = String(wanted);
      const shown = `${wanted.toFixed(field.endsWith("mm") ? 2 : 0)} ${SLIDERS[field][1]}`;
      if (output.value !== shown) {
        output.value = shown;
        input.setAttribute("aria-valuetext", shown);
      }
    }
    if (this.isStale && this.frame && this.mesh && this.press.sensor) {
      this.isStale = false;
      this.drawFrame(this.press.sensor, this.mesh, this.frame.frame, this.frame.at);
    }
    this.scene.render();
    const now = Math.floor(performance.now() / 500);
    if (now !== this.seconds) {
      this.seconds = now;
      this.showRate();
    }
  }

  private drawFrame(sensor: Sensor, mesh: Mesh, frame: Frame, at: Placement): void {
    if (frame.displacements_mm.length !== mesh.rest_mm.length) return;
    const pose = poseOf(at, mesh.touch_mm);
    const quantity = this.colouring === "von-mises" ? "von-mises" : "pressure";
    this.scene.frame(frame, pose, this.colouring, this.magnified);
    this.section.draw(sensor, mesh, frame, this.outline, pose, { across: this.across, quantity }, this.magnified);
    this.readings.show(sensor, frame);
    if (this.deskFrame) this.sideBySide.show(sensor, this.deskFrame, frame);
    const [x, y, z] = frame.force_n;
    const clean = (value: number, digits: number) => (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits);
    element("force").textContent = `${clean(-z, 3)} N`;
    element("aside").textContent = `${clean(Math.hypot(x, y), 3)} N`;
    element("depth").textContent = `${clean(frame.depth_mm, 2)} mm`;
    element("contact").textContent = `${clean(frame.contact_mm2 ?? 0, 0)} mm²`;
    if (frame.ood_score !== undefined) {
      const isOutOfDistribution = frame.ood_score > 1;
      element("ood_score").textContent = `Out-of-distribution score ${frame.ood_score.toFixed(2)}${isOutOfDistribution ? ": above 1, the numbers may be wrong" : ""}`;
      element("ood_score").classList.toggle("fault", isOutOfDistribution);
    }
    element("torque").textContent = `${clean(Math.hypot(...frame.torque_n_mm), 2)} N mm`;
    element("provenance").textContent = frame.provenance;
    const name = quantity === "pressure" ? "pressure (kPa)" : "von Mises stress (kPa)";
    this.showScale("scene", this.scene.scale, this.colouring === "plain" ? "ports: pressure (kPa)" : name);
    this.showScale("section", this.section.scale, name);
    this.showScale("map", this.readings.scale);
  }

  private showScale(id: string, scale: Scale, quantity?: string): void {
    element(`${id}-least`).textContent = String(Number(scale.least.toPrecision(3)));
    element(`${id}-most`).textContent = `${Number(scale.most.toPrecision(3))}${quantity ? "" : " kPa"}`;
    if (quantity) element(`${id}-quantity`).textContent = quantity;
  }

  private showRate(): void {
    const { frames_per_s, median_ms } = this.press;
    const nodes = this.mesh ? `${this.mesh.n_nodes.toLocaleString("en")} nodes` : "";
    const median = Number.isNaN(median_ms) ? "" : `, ${median_ms.toFixed(0)} ms a frame`;
    element("rate").textContent = frames_per_s ? `${frames_per_s} frames/s${median}, ${nodes}` : `at rest${median}, ${nodes}`;
  }

  /** For scripts: the last frame, and where the indenter is. */
  get state() {
    const { at, target, nodes, median_ms, indenter, surrogate, left } = this.press;
    return { at, target, nodes, median_ms, indenter, surrogate, n_left: left.length, frame: this.frame?.frame, deskFrame: this.deskFrame, n_nodes: this.mesh?.n_nodes, isThere: isSame(at, target) && this.attempts === 0 };
  }

  /** For scripts: where a place of the gel is on the screen, px. */
  onScreen(x_mm: number, y_mm: number): [number, number] {
    return this.scene.onScreen(x_mm, y_mm, this.press.sensor!.gel_mm[1][2]);
  }
}

/** The program that the page comes from, or WebAssembly where it is a file. */
async function engineOfPage(): Promise<Engine> {
  if (SocketEngine.isAt(location)) return SocketEngine.of(location);
  return WorkerEngine.of(WORKER_PROGRAM, await unzipped(MODULE_GZIP));
}

/** The bytes that were compressed by gzip and written as base64. */
async function unzipped(base64: string): Promise<ArrayBuffer> {
  const compressed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

async function begin(): Promise<void> {
  const engine = await engineOfPage();
  const page = new Page(engine);
  (window as unknown as { twintac: Page }).twintac = page;
  await page.start();
}

begin().catch((error) => {
  const place = element("error");
  place.hidden = false;
  place.textContent = `The page can't start: ${messageOf(error)}`;
});
