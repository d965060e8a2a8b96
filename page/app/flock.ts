// The orbits that fly: their next hits are read ahead in chunks, and each frame takes those whose time has come.
import { Engine, EngineError, ROW } from "./engine";
import { along } from "./flight";
import { FRAME_ROW, type Begun, type Frame, type Start } from "./protocol";

const CHUNK = 16; // hits read at a time
const MOST_HITS = 20000; // in a frame

interface Orbit {
  slot: number;
  id: number;
  /** Rows read ahead, from `at` on. */
  rows: Float64Array;
  at: number;
  /** The flock's time at which this orbit began; its own time starts at 0. */
  born: number;
  /** After the last hit that was taken: t, x, y, vx, vy. */
  t: number;
  x: number;
  y: number;
  vx: number;
  vy: number;
  end?: { why: string; t: number };
}

export class Flock {
  private orbits: Orbit[] = [];
  private t = 0;
  private potential = false;
  private step = Infinity; // of time, that is known to fit into the budget
  private curvature = 0; // of flights, which the last hit of each orbit tells

  constructor(private readonly engine: Engine) {}

  begin(system: number, potential: boolean, starts: Start[], slots: number[], keep: boolean): Begun {
    if (!keep) {
      this.forget(this.orbits);
      this.orbits = [];
      this.t = 0;
      this.step = Infinity;
      this.curvature = 0;
    }
    this.potential = potential;
    const refused: Begun["refused"] = [];
    const begun: Orbit[] = [];
    starts.forEach((start, i) => {
      try {
        const { orbit } = this.engine.call({ do: "orbit", system, start });
        begun.push({ slot: slots[i], id: orbit, rows: new Float64Array(0), at: 0, born: this.t, t: 0, x: 0, y: 0, vx: 0, vy: 0 });
      } catch (error) {
        if (!(error instanceof EngineError)) throw error;
        refused.push({ slot: slots[i], text: error.message });
      }
    });
    const states = this.engine.places(Uint32Array.from(begun, (orbit) => orbit.id), 0).slice();
    begun.forEach((orbit, i) => {
      [orbit.x, orbit.y, orbit.vx, orbit.vy] = states.subarray(4 * i, 4 * i + 4);
      this.read(orbit);
    });
    this.orbits.push(...begun);
    return { refused, states, slots: begun.map((orbit) => orbit.slot), pace: this.pace() };
  }

  /** Flies all orbits to time t, or as near to it as the budget (milliseconds) and the room for hits allow. */
  frame(t: number, budget: number): Frame {
    const begin = performance.now();
    const hits: number[] = [];
    const ended: Frame["ended"] = [];
    while (this.t < t && hits.length < MOST_HITS * FRAME_ROW) {
      const spent = performance.now() - begin;
      if (spent > budget) break;
      const step = Math.min(t - this.t, this.step);
      const before = performance.now();
      this.fly(this.t + step, hits, ended);
      const cost = performance.now() - before;
      if (cost > budget / 3) this.step = step / 2;
      else if (this.step < Infinity && cost < budget / 12) this.step *= 2;
    }
    const flying = this.orbits.length;
    const dots = new Float64Array(2 * flying);
    const slots = new Uint32Array(flying);
    if (this.potential && flying) {
      const places = this.engine.places(Uint32Array.from(this.orbits, (orbit) => orbit.id), this.t);
      for (let i = 0; i < flying; ++i) dots.set(places.subarray(4 * i, 4 * i + 2), 2 * i);
    }
    this.orbits.forEach((orbit, i) => {
      slots[i] = orbit.slot;
      if (!this.potential) dots.set(this.place(orbit, this.t - orbit.born), 2 * i);
    });
    return { t: this.t, dots, slots, hits: Float64Array.from(hits), ended, flying, cost: performance.now() - begin };
  }

  /** Decisions of the orbits that fly, summed. */
  decisions(): Record<string, number> {
    const sum: Record<string, number> = {};
    for (const orbit of this.orbits.slice(0, 64)) {
      for (const [name, count] of Object.entries(this.engine.call({ do: "decisions", orbit: orbit.id }))) {
        if (typeof count === "number") sum[name] = (sum[name] ?? 0) + count;
      }
    }
    return sum;
  }

  private fly(t: number, hits: number[], ended: Frame["ended"]): void {
    const gone: Orbit[] = [];
    for (const orbit of this.orbits) {
      const now = t - orbit.born;
      for (;;) {
        const { rows, at } = orbit;
        if (at === rows.length) {
          if (!orbit.end) {
            this.read(orbit);
            continue;
          }
          if (orbit.end.t <= now) {
            const [x, y] = this.place(orbit, orbit.end.t);
            ended.push({ slot: orbit.slot, ...orbit.end, x, y });
            gone.push(orbit);
          }
          break;
        }
        if (rows[at] > now) break;
        hits.push(orbit.slot);
        for (let k = 0; k < ROW; ++k) hits.push(rows[at + k]);
        orbit.t = rows[at];
        orbit.x = rows[at + 1];
        orbit.y = rows[at + 2];
        orbit.vx = rows[at + 3];
        orbit.vy = rows[at + 4];
        orbit.at += ROW;
      }
    }
    if (gone.length) {
      this.orbits = this.orbits.filter((orbit) => !gone.includes(orbit));
      this.forget(gone);
    }
    this.t = t;
  }

  private read(orbit: Orbit): void {
    orbit.rows = this.engine.step(orbit.id, CHUNK).slice();
    orbit.at = 0;
    if (orbit.rows.length) this.curvature = orbit.rows[8];
    if (orbit.rows.length < CHUNK * ROW) orbit.end = this.engine.call({ do: "ended", orbit: orbit.id });
  }

  private place(orbit: Orbit, t: number): [number, number] {
    const curvature = orbit.at < orbit.rows.length ? orbit.rows[orbit.at + 8] : this.curvature;
    return along(orbit.x, orbit.y, orbit.vx, orbit.vy, t - orbit.t, curvature);
  }

  private pace(): number {
    const rows = this.orbits.at(-1)?.rows;
    return rows && rows.length ? rows[rows.length - ROW] / (rows.length / ROW) : 0;
  }

  private forget(orbits: Orbit[]): void {
    for (const orbit of orbits) {
      try {
        this.engine.call({ do: "forget", orbit: orbit.id });
      } catch {
        // It went with its system.
      }
    }
  }
}
