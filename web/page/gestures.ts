/** Mouse, fingers and keys move the indenter and the view. */

import type { Press } from "./press.ts";
import type { Scene } from "./scene.ts";

/** Depth of a pixel of a wheel or of a second finger, mm. */
const MM_PER_WHEEL = 0.0015;
const MM_PER_FINGER = 0.015;

/** Degrees of a pixel of a wheel. */
const DEGREES_PER_WHEEL = 0.04;

export class Gestures {
  /** Whether every drag turns the view. */
  turnsView = false;
  private readonly pointers = new Map<number, { x: number; y: number }>();
  /** From the place under the first pointer to the indenter, mm. */
  private grip: [number, number] | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly scene: Scene,
    private readonly press: Press,
  ) {
    scene.turns = false;
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(end, (event) => this.up(event));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  private get height_mm(): number {
    return this.press.sensor?.gel_mm[1][2] ?? 0;
  }

  private down(event: PointerEvent): void {
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (this.pointers.size > 1) {
      this.scene.turns = false;
      this.grip = undefined;
      return;
    }
    const at = this.scene.at(event.clientX, event.clientY, this.height_mm);
    const [low, high] = this.press.sensor?.gel_mm ?? [[0, 0], [0, 0]];
    const isOnGel = !!at && [0, 1].every((axis) => at[axis]! > low[axis]! - 3 && at[axis]! < high[axis]! + 3);
    const turns = this.turnsView || event.button !== 0 || !isOnGel;
    this.scene.turns = turns;
    if (turns || !at) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({ preventScroll: true });
    const { x_mm, y_mm } = this.press.target;
    // A grip beside the indenter brings it under the pointer.
    const isNear = Math.hypot(at[0] - x_mm, at[1] - y_mm) < 6;
    this.grip = isNear ? [x_mm - at[0], y_mm - at[1]] : [0, 0];
    if (!isNear) this.press.aim({ x_mm: at[0], y_mm: at[1] });
  }

  private move(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const other = [...this.pointers].find(([number]) => number !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const { target } = this.press;
    if (other) {
      const angle = (at: { x: number; y: number }) => Math.atan2(at.y - other.y, at.x - other.x);
      let turned = angle({ x: event.clientX, y: event.clientY }) - angle(before);
      turned = Math.atan2(Math.sin(turned), Math.cos(turned));
      this.press.aim({
        depth_mm: target.depth_mm + MM_PER_FINGER * (event.clientY - before.y),
        twist_deg: target.twist_deg - (turned * 180) / Math.PI,
      });
    } else if (this.grip) {
      const at = this.scene.at(event.clientX, event.clientY, this.height_mm);
      if (at) this.press.aim({ x_mm: at[0] + this.grip[0], y_mm: at[1] + this.grip[1] });
    }
  }

  private up(event: PointerEvent): void {
    this.pointers.delete(event.pointerId);
    if (!this.pointers.size) this.grip = undefined;
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1;
    // Some systems turn the wheel's direction while Shift is held.
    const turned = lines * (event.deltaY || event.deltaX);
    const { target } = this.press;
    if (event.shiftKey) this.press.aim({ twist_deg: target.twist_deg + DEGREES_PER_WHEEL * turned });
    else if (event.altKey) this.press.aim({ tilt_y_deg: target.tilt_y_deg + DEGREES_PER_WHEEL * turned });
    else this.press.aim({ depth_mm: target.depth_mm + MM_PER_WHEEL * turned });
  }

  private key(event: KeyboardEvent): void {
    const focused = event.target as HTMLElement;
    const isElsewhere = focused !== this.canvas && focused !== document.body;
    if (isElsewhere || event.ctrlKey || event.metaKey) return;
    const step_mm = event.shiftKey ? 1 : 0.25;
    const { target } = this.press;
    const actions: Record<string, () => void> = {
      arrowleft: () => this.press.aim({ x_mm: target.x_mm - step_mm }),
      arrowright: () => this.press.aim({ x_mm: target.x_mm + step_mm }),
      arrowdown: () => this.press.aim({ y_mm: target.y_mm - step_mm }),
      arrowup: () => this.press.aim({ y_mm: target.y_mm + step_mm }),
      pagedown: () => this.press.aim({ depth_mm: target.depth_mm + 0.4 * step_mm }),
      pageup: () => this.press.aim({ depth_mm: target.depth_mm - 0.4 * step_mm }),
      q: () => this.press.aim({ twist_deg: target.twist_deg + 5 }),
      e: () => this.press.aim({ twist_deg: target.twist_deg - 5 }),
      i: () => this.press.aim({ tilt_x_deg: target.tilt_x_deg - 1 }),
      k: () => this.press.aim({ tilt_x_deg: target.tilt_x_deg + 1 }),
      j: () => this.press.aim({ tilt_y_deg: target.tilt_y_deg - 1 }),
      l: () => this.press.aim({ tilt_y_deg: target.tilt_y_deg + 1 }),
      "[": () => this.scene.look(0.1, 0, 1),
      "]": () => this.scene.look(-0.1, 0, 1),
      "+": () => this.scene.look(0, 0, 1.1),
      "=": () => this.scene.look(0, 0, 1.1),
      "-": () => this.scene.look(0, 0, 1 / 1.1),
      " ": () => this.press.aim({ depth_mm: -1 }),
    };
    const action = actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  }
}
