// The orbits that fly: their next hits are read ahead in chunks, and each frame takes those whose time has come.
import { Engine, EngineError, ROW } from "./engine";
import { along } from "./flight";
import { FRAME_ROW, TRUSTED, type Begun, type Frame, type Request, type Trust } from "./protocol";

const CHUNK = 16; // hits read at a time
const MOST_HITS = 20000; // in a frame
const MOST_TRAIL = 3000; // places of paths in a frame
const RATED = 250; // milliseconds from rates to rates

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
  end?: { why: string; t: number; hole?: string };
}

export class Flock {
  grain = Infinity;
  private orbits: Orbit[] = [];
  private t = 0;
  private forces = false;
  private walls = true;
  private rates = false;
  private ratedAt = 0;
  private step = Infinity; // of time, that is known to fit into the budget
  private curvature = 0; // of a flight that has not met a wall yet: that of the flights before

  constructor(private readonly engine: Engine) {}

  begin(ask: Extract<Request, { do: "begin" }>): Begun {
    if (!ask.keep) {
      this.forget(this.orbits);
      this.orbits = [];
      this.t = 0;
      this.step = this.grain = Infinity;
      this.curvature = 0;
    }
    this.forces = ask.forces;
    this.walls = ask.walls;
    this.rates = ask.rates;
    this.ratedAt = 0;
    const refused: string[] = [];
    const begun: Orbit[] = [];
    for (const start of ask.starts) {
      try {
        const trust = ask.starts.length <= TRUSTED;
        const { orbit, particles = 1 } = this.engine.call({ do: "orbit", system: ask.system, start: { ...start, trust, rates: this.rates } });
        for (let p = 0; p < particles; ++p) {
          const slot = ask.slots[begun.length];
          begun.push({ slot, id: orbit + p, rows: new Float64Array(0), at: 0, born: this.t, t: 0, x: 0, y: 0, vx: 0, vy: 0 });
        }
      } catch (error) {
        if (!(error instanceof EngineError)) throw error;
        refused.push(error.message);
      }
    }
    const states = this.places(begun, 0);
    begun.forEach((orbit, i) => {
      [orbit.x, orbit.y, orbit.vx, orbit.vy] = states.subarray(4 * i, 4 * i + 4);
      if (this.walls && (!this.forces || i === 0)) this.read(orbit);
    });
    this.orbits.push(...begun);
    const rows = begun[0]?.rows ?? [];
    const pace = rows.length ? rows[rows.length - ROW] / (rows.length / ROW) : 0;
    return { refused, states, slots: begun.map((orbit) => orbit.slot), pace };
  }

  /** Flies all orbits to time t, or as near to it as the budget (milliseconds) and the room for hits allow. */
  frame(t: number, budget: number): Frame {
    const begin = performance.now();
    const hits: number[] = [];
    const trail: number[] = [];
    const ended: Frame["ended"] = [];
    const rates: number[] = [];
    while (this.t < t && hits.length < MOST_HITS * FRAME_ROW && trail.length < 3 * MOST_TRAIL) {
      if (performance.now() - begin > budget) break;
      const step = Math.min(t - this.t, this.step, this.forces ? this.grain : Infinity);
      const before = performance.now();
      this.fly(this.t + step, hits, ended, rates);
      if (this.forces && this.orbits.length <= 64) this.follow(trail);
      const cost = performance.now() - before;
      if (cost > budget / 3) this.step = step / 2;
      else if (this.step < Infinity && cost < budget / 12) this.step *= 2;
    }
    const flying = this.orbits.length;
    const dots = new Float64Array(2 * flying);
    const slots = Uint32Array.from(this.orbits, (orbit) => orbit.slot);
    if (this.forces) {
      const places = this.now();
      for (let i = 0; i < flying; ++i) dots.set(places.subarray(4 * i, 4 * i + 2), 2 * i);
    } else {
      this.orbits.forEach((orbit, i) => dots.set(this.place(orbit, this.t - orbit.born), 2 * i));
    }
    if (this.rates && begin - this.ratedAt > RATED) {
      this.ratedAt = begin;
      for (const [orbits, age] of this.ages()) {
        this.engine.rates(ids(orbits), age).forEach((rate, i) => rates.push(orbits[i].slot, rate));
      }
    }
    return {
      t: this.t, dots, slots, hits: Float64Array.from(hits), trail: Float64Array.from(trail), rates: Float64Array.from(rates), ended, flying,
      cost: performance.now() - begin,
    };
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

  /** Of few orbits: how far they can be trusted, where that is known. The hits read ahead count. */
  trust(): Trust[] {
    const found: Trust[] = [];
    for (const { id, slot } of this.orbits.slice(0, TRUSTED)) {
      const { known, open, hits, t } = this.engine.call({ do: "trust", orbit: id });
      if (known) found.push({ slot, hits, t, open });
    }
    return found;
  }

  private fly(t: number, hits: number[], ended: Frame["ended"], rates: number[]): void {
    this.t = t;
    if (!this.walls) return;
    const gone = new Set<Orbit>();
    for (const orbit of this.orbits) {
      const now = t - orbit.born;
      while (this.ahead(orbit, now)) {
        const { rows, at } = orbit;
        hits.push(orbit.slot);
        for (let k = 0; k < ROW; ++k) hits.push(rows[at + k]);
        orbit.t = rows[at];
        orbit.x = rows[at + 1];
        orbit.y = rows[at + 2];
        orbit.vx = rows[at + 3];
        orbit.vy = rows[at + 4];
        orbit.at += ROW;
      }
      if (orbit.end && orbit.at === orbit.rows.length && orbit.end.t <= now) {
        const [x, y] = this.forces ? this.places([orbit], orbit.end.t) : this.place(orbit, orbit.end.t);
        const { why, hole, t: end } = orbit.end;
        ended.push({ slot: orbit.slot, why: hole ? `${why} through ${hole}` : why, t: end, x, y });
        if (this.rates) rates.push(orbit.slot, this.engine.rates(ids([orbit]), end)[0]);
        gone.add(orbit);
      }
    }
    if (gone.size) {
      this.orbits = this.orbits.filter((orbit) => !gone.has(orbit));
      this.forget(gone);
    }
  }

  /** Whether the orbit's next hit is at time `now` or before. */
  private ahead(orbit: Orbit, now: number): boolean {
    if (orbit.at === orbit.rows.length) {
      if (orbit.end) return false;
      this.read(orbit);
    }
    return orbit.at < orbit.rows.length && orbit.rows[orbit.at] <= now;
  }

  private read(orbit: Orbit): void {
    const chunk = this.forces ? 1 : CHUNK;
    orbit.rows = this.engine.step(orbit.id, chunk).slice();
    orbit.at = 0;
    if (orbit.rows.length) this.curvature = orbit.rows[8];
    if (orbit.rows.length === chunk * ROW) return;
    const end = this.engine.call({ do: "ended", orbit: orbit.id });
    if (end.why) orbit.end = end;
  }

  private place(orbit: Orbit, t: number): [number, number] {
    const curvature = orbit.at < orbit.rows.length ? orbit.rows[orbit.at + 8] : this.curvature;
    return along(orbit.x, orbit.y, orbit.vx, orbit.vy, t - orbit.t, curvature);
  }

  private places(orbits: Orbit[], t: number): Float64Array {
    return this.engine.places(ids(orbits), t).slice();
  }

  /** States of all orbits now; those that were born later are at an earlier time of their own. */
  private now(): Float64Array {
    const states = new Float64Array(4 * this.orbits.length);
    let from = 0;
    for (const [orbits, age] of this.ages()) {
      states.set(this.places(orbits, age), from);
      from += 4 * orbits.length;
    }
    return states;
  }

  /** Orbits that follow each other and were born together, and their own time now. */
  private *ages(): Generator<[Orbit[], number]> {
    for (let from = 0, to = 0; from < this.orbits.length; from = to) {
      const { born } = this.orbits[from];
      while (to < this.orbits.length && this.orbits[to].born === born) ++to;
      yield [this.orbits.slice(from, to), this.t - born];
    }
  }

  private follow(trail: number[]): void {
    const states = this.now();
    this.orbits.forEach((orbit, i) => trail.push(orbit.slot, states[4 * i], states[4 * i + 1]));
  }

  private forget(orbits: Iterable<Orbit>): void {
    for (const orbit of orbits) this.engine.call({ do: "forget", orbit: orbit.id });
  }
}

function ids(orbits: Orbit[]): Uint32Array {
  return Uint32Array.from(orbits, (orbit) => orbit.id);
}
