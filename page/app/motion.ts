// The motion: which particles fly, how fast the page's time goes, and the frames.
import type { Client } from "./client";
import { TRUSTED, type Frame, type Start, type System, type Trust } from "./protocol";
import type { Section } from "./section";
import type { Table } from "./table";
import type { Tint } from "./tint";
import type { Trace } from "./trace";
import { count, plain } from "./words";

const BUDGET = 9; // milliseconds of a frame that the engine may take
const FAN = 0.01; // radians between the first and the last particle of a drag
const COLOURS = 8;
const MOST = 10000;
const REST = 700; // milliseconds after all have ended

interface Hooks {
  /** For a screen reader, now and then. */
  say(text: string): void;
  /** How fast the page's time goes has changed. */
  paced(): void;
  /** The scale of colours has changed. */
  tinted(): void;
  /** The line below the drawings. */
  state(text: string): void;
}

export class Motion {
  playing = true;
  hitsPerSecond = 10;
  particles = 1;
  from: Start = { seed: 1, trajectory: 0 };
  /** For tests: frames drawn, when the first one was, and what each took. */
  readonly timing = { frames: 0, first: 0, costs: [] as number[], intervals: [] as number[], engine: [] as number[] };
  private system?: System;
  private t = 0;
  private pace = 1;
  private slot = 0;
  private groups = 0;
  private hits = 0;
  private flying = 0;
  private busy = false;
  private ready: Frame[] = [];
  private lastAsk = 0;
  private lastFrame = 0;
  private generation = 0;
  private decisions = "";
  private trust = "";
  private goOnAt = 0; // when the file's next trajectories follow; 0: not
  private begun = 0; // particles, since all were forgotten
  private speed = 1;
  private note = "";
  private tintAt = 0; // when colours may change again

  constructor(
    private readonly client: Client,
    private readonly trace: Trace,
    private readonly table: Table,
    private readonly section: Section,
    private readonly tint: Tint,
    private readonly hooks: Hooks,
  ) {
    requestAnimationFrame((now) => this.tick(now));
    setInterval(() => void this.countDecisions(), 1000);
    (window as unknown as { carom: object }).carom = { timing: this.timing, motion: this };
  }

  /** Another system: the same start again, as far as it had come. */
  async change(system: System, from: Start | undefined, fresh: boolean): Promise<void> {
    const reached = fresh ? 0 : Math.min(this.t, 60 * this.pace);
    this.from = from ?? this.from;
    let good = await this.start(system, this.from, true, reached);
    if (!good && !("seed" in this.from)) {
      const refused = this.note;
      good = await this.start(system, { seed: 1, trajectory: 0 }, true, reached);
      this.note = refused;
    }
  }

  /** Starts particles; `fresh` forgets those that fly. False: the engine refuses the start. */
  async start(system: System, from: Start, fresh: boolean, reached = 0): Promise<boolean> {
    const n = this.particles;
    const keep = !fresh && this.system === system && n <= 64 && this.flying + n <= MOST;
    this.goOnAt = 0;
    if (!keep) this.forget();
    const generation = keep ? this.generation : ++this.generation;
    const begun = await this.client.begin({
      do: "begin", system: system.system, forces: system.potential, walls: system.walls.length > 0,
      starts: starts(from, n), slots: this.slots(n * Math.max(1, system.particles)), keep,
      rates: this.tint.by === "exponent",
    });
    if (generation !== this.generation) return true;
    this.system = system;
    this.note = begun.refused[0] ?? "";
    if (begun.slots.length === 0) {
      this.report();
      return false;
    }
    this.from = from;
    this.begun += begun.slots.length;
    this.flying = (keep ? this.flying : 0) + begun.slots.length;
    begun.slots.forEach((slot, i) => this.trace.begin(slot, begun.states.slice(4 * i, 4 * i + 4)));
    this.table.started(begun.slots, begun.states, this.flying);
    const box = system.box;
    const speed = Math.hypot(begun.states[2], begun.states[3]) || 1;
    if ("seed" in from) this.speed = speed;
    this.pace = begun.pace || (0.1 * Math.hypot(box[2] - box[0], box[3] - box[1])) / speed;
    this.hooks.paced();
    if (system.potential) await this.client.ask({ do: "grain", grain: this.pace / 16 });
    this.hooks.say(n === 1 ? "One particle started." : `${n} particles started.`);
    if (reached > 0) {
      const frame = await this.client.frame(reached, 40);
      if (generation === this.generation) this.ready.push(frame);
    }
    return true;
  }

  clear(): void {
    if (this.system) void this.start(this.system, this.from, true);
  }

  /** The command that flies the same orbit as far; none for several, and for starts in the section. */
  command(name: string): string | undefined {
    const { from } = this;
    if (this.particles > 1 || this.begun !== 1 || this.hits === 0 || "s" in from) return undefined;
    const start = "seed" in from
      ? `${from.seed === 1 ? "" : ` --seed ${from.seed}`}${from.trajectory ? ` --trajectory ${from.trajectory}` : ""}`
      : ` --position=${from.position} --velocity=${from.velocity}`;
    return `carom run ${name}${start} --collisions ${this.hits}`;
  }

  /** The speed of the page's time, in words. */
  get speedText(): string {
    const { hitsPerSecond: hits, system } = this;
    if (system && !system.walls.length) return `t grows by ${plain(hits * this.pace, 2)} a second`;
    return `${plain(hits, hits < 1 ? 1 : 2)} hits a second`;
  }

  /** A velocity of this direction, as fast as the particles of the file. */
  velocity(x: number, y: number): [number, number] {
    const factor = this.speed / Math.hypot(x, y);
    return [factor * x, factor * y];
  }

  /** The next start of the file's own ensemble. */
  nextOfFile(): Start {
    return "seed" in this.from ? { seed: this.from.seed, trajectory: this.from.trajectory + this.particles } : { seed: 1, trajectory: 0 };
  }

  private forget(): void {
    this.trace.clear();
    this.tint.clear();
    this.t = 0;
    this.hits = 0;
    this.begun = 0;
    this.flying = 0;
    this.ready = [];
    this.decisions = "";
    this.trust = "";
    this.table.clear(this.particles);
    this.section.clear();
  }

  /** Few particles have a colour each; many share one. */
  private slots(n: number): number[] {
    if (n <= 64) return Array.from({ length: n }, () => this.slot++);
    const colour = this.groups++ % COLOURS;
    this.slot = COLOURS * Math.ceil(this.slot / COLOURS);
    const first = this.slot;
    this.slot += COLOURS * n;
    return Array.from({ length: n }, (_, i) => first + COLOURS * i + colour);
  }

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    const begin = performance.now();
    const frames = this.ready;
    this.ready = [];
    for (const frame of frames) this.draw(frame);
    if (begin > this.tintAt && this.tint.renewed()) this.retint();
    if (!this.busy && this.playing && this.system && this.flying) {
      const elapsed = Math.min(now - this.lastAsk, 50) / 1000;
      this.lastAsk = now;
      this.ask(this.t + elapsed * this.hitsPerSecond * this.pace);
    }
    if (this.goOnAt && begin > this.goOnAt && this.playing && this.system) {
      this.goOnAt = 0;
      void this.start(this.system, this.nextOfFile(), this.particles > 64);
    }
    if (frames.length && this.lastFrame) {
      const { costs, intervals, engine } = this.timing;
      costs.push(performance.now() - begin);
      intervals.push(now - this.lastFrame);
      engine.push(frames[0].cost);
      for (const list of [costs, intervals, engine]) if (list.length > 600) list.shift();
    }
    this.lastFrame = now;
  }

  /** All in the colours that orbits have now: not often, where much is drawn. */
  private retint(): void {
    const begin = performance.now();
    this.table.draw();
    this.section.draw();
    this.hooks.tinted();
    const end = performance.now();
    this.tintAt = end + Math.max(400, 20 * (end - begin));
  }

  private ask(t: number): void {
    this.busy = true;
    const { generation } = this;
    this.client.frame(t, BUDGET).then(
      (frame) => {
        if (generation === this.generation) this.ready.push(frame);
      },
      (error: Error) => this.hooks.state(error.message),
    ).finally(() => (this.busy = false));
  }

  private draw(frame: Frame): void {
    if (this.timing.frames++ === 0) this.timing.first = performance.now();
    this.t = frame.t;
    this.flying = frame.flying;
    this.hits += frame.hits.length / 10;
    this.trace.add(frame.hits);
    this.trace.addTrail(frame.trail);
    this.tint.take(frame.rates);
    this.table.step(frame);
    this.section.step(frame.hits);
    if (frame.ended.length && this.particles === 1) {
      const { why, t } = frame.ended.at(-1)!;
      this.note = `${why} at t = ${plain(t)}`;
      this.hooks.say(`The particle ended: ${this.note}, after ${this.hits} hits.`);
    }
    if (this.flying === 0 && "seed" in this.from) this.goOnAt = performance.now() + REST;
    this.report();
  }

  private report(): void {
    const parts = [
      this.flying === 1 ? "1 particle" : `${count(this.flying)} particles`,
      `t = ${plain(this.t)}`,
      this.system?.walls.length ? `${count(this.hits)} ${this.hits === 1 ? "hit" : "hits"}` : "",
      this.decisions,
      this.trust,
      this.note,
    ];
    this.hooks.state(parts.filter(Boolean).join("  ·  "));
  }

  /** Of few orbits: the hit after which doubles cannot be trusted is marked. */
  private async askForTrust(): Promise<void> {
    const { generation } = this;
    const all: Trust[] = await this.client.ask({ do: "trust" });
    if (generation !== this.generation) return;
    this.trust = "";
    for (const one of all) {
      if (one.open) continue;
      if (this.flying === 1) this.trust = `its first ${one.hits} hits can be trusted in doubles`;
      this.trace.mark(one.slot, one.hits);
    }
    this.table.showMarks();
  }

  private async countDecisions(): Promise<void> {
    if (!this.flying || this.busy) return;
    if (this.flying <= TRUSTED) await this.askForTrust();
    const { generation } = this;
    const { filter, exact } = await this.client.ask({ do: "decisions" });
    if (generation !== this.generation || exact === undefined || filter + exact === 0) return;
    this.decisions = `${count(filter + exact)} decisions, ${exact ? count(exact) : "none"} of them in exact arithmetic`;
  }
}

/** A start, or many about it: a fan of directions from one point, or the file's own starts one after the other. */
function starts(from: Start, n: number): Start[] {
  if (n === 1) return [from];
  return Array.from({ length: n }, (_, i): Start => {
    const off = FAN * (i / (n - 1) - 0.5);
    if ("seed" in from) return { seed: from.seed, trajectory: from.trajectory + i };
    if ("s" in from) return { s: from.s, v: Math.max(-0.9999, Math.min(0.9999, from.v + off)) };
    const [vx, vy] = from.velocity;
    const [c, s] = [Math.cos(off), Math.sin(off)];
    return { position: from.position, velocity: [c * vx - s * vy, s * vx + c * vy] };
  });
}
