/** Colours of numbers: viridis, which is read alike by all eyes, on a scale that holds still. */

/** Every sixteenth colour of viridis (van der Walt and Smith, CC0), sRGB. */
const VIRIDIS = [
  [68, 1, 84], [72, 26, 108], [71, 47, 125], [65, 68, 135], [57, 86, 140], [49, 104, 142], [42, 120, 142], [35, 136, 142],
  [31, 152, 139], [34, 168, 132], [53, 183, 121], [84, 197, 104], [122, 209, 81], [165, 219, 54], [210, 226, 27], [253, 231, 37],
] as const;

/** The colour of a part between 0 and 1, as sRGB from 0 to 255. */
export function colourOf(part: number): [number, number, number] {
  const place = Math.min(1, Math.max(0, Number.isFinite(part) ? part : 0)) * (VIRIDIS.length - 1);
  const below = Math.min(VIRIDIS.length - 2, Math.floor(place));
  const [a, b] = [VIRIDIS[below]!, VIRIDIS[below + 1]!];
  const mix = (channel: 0 | 1 | 2) => a[channel] + (place - below) * (b[channel] - a[channel]);
  return [mix(0), mix(1), mix(2)];
}

export function cssOf(part: number): string {
  return `rgb(${colourOf(part).map(Math.round).join(" ")})`;
}

/** All colours from left to right, for the style of a legend. */
export const GRADIENT = `linear-gradient(to right, ${VIRIDIS.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;

/** From the least to the most that is drawn. It grows at once, and shrinks only where most of it is unused. */
export class Scale {
  least = 0;
  most = 1;

  take(values: ArrayLike<number>): void {
    let [low, high] = [0, 0];
    for (let i = 0; i < values.length; i++) {
      low = Math.min(low, values[i]!);
      high = Math.max(high, values[i]!);
    }
    if (high > this.most || high < 0.3 * this.most) this.most = Math.max(1, round(high));
    const wanted = low < -0.1 * this.most ? -round(-low) : 0;
    if (low < this.least || wanted > 0.3 * this.least) this.least = wanted;
  }

  part(value: number): number {
    return (value - this.least) / (this.most - this.least);
  }
}

/** The next round number up. */
function round(value: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(1e-9, value)));
  return ([1, 1.5, 2, 3, 4, 5, 6, 8].find((step) => step * power >= value) ?? 10) * power;
}
