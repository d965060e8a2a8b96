// The hits seen so far, for redrawing and for export. The oldest go when there are too many.
import { FRAME_ROW } from "./protocol";

const CHUNK = 1 << 13; // rows
const MOST = 40; // chunks
const MOST_STARTS = 10000;
const MOST_PLACES = 60000; // of paths under forces

export class Trace {
  private chunks: Float64Array[] = [];
  /** Rows in the last chunk. */
  private filled = CHUNK;
  /** The state each orbit started in: x, y, vx, vy. */
  readonly starts = new Map<number, ArrayLike<number>>();
  /** Under forces: slot, x, y along the paths, for all orbits one after the other in time. */
  trail: Float64Array[] = [];
  /** Where doubles stop to be trusted, by orbit: x, y of the hit. */
  readonly marks = new Map<number, [number, number]>();
  rows = 0;
  dropped = false;
  private placed = 0;

  clear(): void {
    this.chunks = [];
    this.filled = CHUNK;
    this.starts.clear();
    this.marks.clear();
    this.trail = [];
    this.placed = 0;
    this.rows = 0;
    this.dropped = false;
  }

  add(hits: Float64Array): void {
    for (let at = 0; at < hits.length; ) {
      if (this.filled === CHUNK) {
        this.chunks.push(new Float64Array(CHUNK * FRAME_ROW));
        this.filled = 0;
        if (this.chunks.length > MOST) {
          this.chunks.shift();
          this.rows -= CHUNK;
          this.dropped = true;
        }
      }
      const rows = Math.min(CHUNK - this.filled, (hits.length - at) / FRAME_ROW);
      this.chunks.at(-1)!.set(hits.subarray(at, at + rows * FRAME_ROW), this.filled * FRAME_ROW);
      this.filled += rows;
      this.rows += rows;
      at += rows * FRAME_ROW;
    }
  }

  /** Marks a hit of an orbit, counted from 1, if it is kept. */
  mark(slot: number, hit: number): void {
    if (this.marks.has(slot) || this.dropped) return;
    let seen = 0;
    for (const block of this.blocks()) {
      for (let at = 0; at < block.length; at += FRAME_ROW) {
        if (block[at] === slot && ++seen === hit) this.marks.set(slot, [block[at + 2], block[at + 3]]);
      }
    }
  }

  /** An orbit begins; of long runs the first starts are forgotten. */
  begin(slot: number, state: ArrayLike<number>): void {
    this.starts.set(slot, state);
    if (this.starts.size > MOST_STARTS) this.starts.delete(this.starts.keys().next().value!);
  }

  addTrail(places: Float64Array): void {
    if (!places.length) return;
    this.trail.push(places);
    this.placed += places.length / 3;
    while (this.placed > MOST_PLACES) this.placed -= this.trail.shift()!.length / 3;
  }

  /** The last rows, at most `most`, in their order. */
  *blocks(most = Infinity): Generator<Float64Array> {
    let skip = Math.max(0, this.rows - most);
    for (let i = 0; i < this.chunks.length; ++i) {
      const rows = i + 1 === this.chunks.length ? this.filled : CHUNK;
      if (skip >= rows) {
        skip -= rows;
        continue;
      }
      yield this.chunks[i].subarray(skip * FRAME_ROW, rows * FRAME_ROW);
      skip = 0;
    }
  }
}
