// The colour of an orbit: one of a few, or its place on a scale by how fast its deviations grow.
import { ink, packed, scale } from "./palette";

const STEPS = 48;
const SHARE = 0.97; // of the orbits have rates below the scale's end

export class Tint {
  by: "orbit" | "exponent" = "orbit";
  /** The end of the scale, in 1/time; it begins at 0. */
  top = 1;
  inks: string[] = [];
  private rates = new Map<number, number>();
  private changed = false;

  constructor() {
    this.recolour();
  }

  clear(): void {
    this.rates.clear();
    this.changed = true;
  }

  recolour(): void {
    const colours = ink();
    this.inks = this.by === "exponent" ? scale(colours.dark, STEPS) : colours.orbits;
  }

  /** Rows of two: the orbit's slot and its rate. */
  take(rows: Float64Array): void {
    if (!rows.length) return;
    for (let at = 0; at < rows.length; at += 2) if (isFinite(rows[at + 1])) this.rates.set(rows[at], rows[at + 1]);
    const sorted = Float64Array.from(this.rates.values()).sort();
    this.top = roundedUp(sorted[Math.floor(SHARE * (sorted.length - 1))]);
    this.changed = true;
  }

  /** Whether colours have changed since this was asked last. */
  renewed(): boolean {
    const { changed } = this;
    this.changed = false;
    return changed && this.by === "exponent";
  }

  index(slot: number): number {
    if (this.by === "orbit") return slot % this.inks.length;
    const share = (this.rates.get(slot) ?? 0) / this.top;
    return Math.max(0, Math.min(STEPS - 1, Math.floor(share * STEPS)));
  }

  colour(slot: number): string {
    return this.inks[this.index(slot)];
  }

  packed(alpha: number): number[] {
    return this.inks.map((colour) => packed(colour, alpha));
  }
}

/** The next number of one digit and a half. */
function roundedUp(x: number): number {
  if (!(x > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(x));
  return power * [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((step) => x <= step * power * (1 + 1e-9))!;
}
