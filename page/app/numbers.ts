// The numbers of the system, live: ensembles whose sizes double, each with its digest and the command that prints the same.
import uPlot from "uplot";
import { Client } from "./client";
import { ink } from "./palette";
import type { System } from "./protocol";
import { copy, count, make, plain, withError } from "./words";

type Result = any; // what `carom ANALYSIS --json` prints, with the command

interface Kind {
  /** A name for what the panel shows. */
  shows: string;
  analysis: string;
  heading: string;
  first: number;
  options: object;
  /** A larger ensemble takes over the parts of the smaller one; the windows of exponents depend on the size. */
  adds: boolean;
  facts(result: Result): [string, string][];
  plot(result: Result): { options: Partial<uPlot.Options>; data: uPlot.AlignedData };
}

/** A worker, and its number of the system. */
interface Worked {
  client: Client;
  system: number;
}

const workers = Math.max(1, Math.min(4, navigator.hardwareConcurrency - 1));
const MOST_WALLS = 24; // to choose from
const PATIENCE = 8; // seconds that one ensemble may take before the doubling waits

/** Both axes logarithmic, no farther than the data. */
const logarithmic: uPlot.Scales = {
  x: { time: false, distr: 3, range: (_u, min, max) => [min, max] },
  y: { distr: 3, range: (_u, min, max) => [min / 1.3, max * 1.3] },
};

const escape: Kind = {
  shows: "escape",
  analysis: "escape",
  heading: "Survival",
  first: 1000,
  options: {},
  adds: true,
  facts({ fit, trajectories, survived }) {
    const facts: [string, string][] = [];
    if (fit?.model) facts.push([`${fit.decided ? "fit" : "undecided"}, t > ${plain(fit.window[0], 3)}`, fit.model]);
    if (fit?.rate !== undefined) facts.push([fit.local_slope ? "local rate" : "escape rate", withError(fit.rate, fit.stderr)]);
    if (fit?.exponent !== undefined) facts.push([fit.local_slope ? "local exponent" : "exponent", withError(fit.exponent, fit.stderr)]);
    if (fit?.plateau !== undefined) facts.push(["plateau", withError(fit.plateau, fit.plateau_stderr)]);
    facts.push(["still inside", `${count(survived)} of ${count(trajectories)}`]);
    return facts;
  },
  plot({ survival, fit }) {
    const rows = survival.filter((row: Result) => row.p > 0 && row.t > 0);
    const t = rows.map((row: Result) => row.t);
    const floor = 1 / (3 * survival.length * 1e6);
    const curve = t.map((x: number) => {
      if (!fit?.amplitude || x < fit.window[0]) return null;
      const decay = fit.rate === undefined ? x ** -fit.exponent : Math.exp(-fit.rate * x);
      const p = fit.amplitude * decay + (fit.plateau ?? 0);
      return p > rows.at(-1).p / 3 ? p : null;
    });
    const colours = ink();
    return {
      options: {
        scales: logarithmic,
        series: [{ label: "t" }, { stroke: "transparent", points: { show: false } }, { stroke: "transparent", points: { show: false } },
          { label: "p(t)", stroke: colours.ink, width: 1, points: { show: true, size: 4, fill: colours.paper } },
          { label: "fit", stroke: colours.accent, width: 1.5, points: { show: false } }],
        bands: [{ series: [2, 1], fill: colours.rule }],
      },
      data: [t, rows.map((r: Result) => Math.max(r.low, floor)), rows.map((r: Result) => r.high), rows.map((r: Result) => r.p), curve],
    };
  },
};

/** A histogram: edges, and counts with a zero at the end. */
function bars(x: number[], y: number[]): ReturnType<Kind["plot"]> {
  const colours = ink();
  return {
    options: {
      scales: { x: { time: false }, y: { range: (_u, _min, max) => [0, 1.1 * max] } },
      series: [{ label: "λ of an orbit" }, { label: "orbits", stroke: colours.accent, width: 1.2, fill: colours.rule,
        paths: uPlot.paths.stepped!({ align: 1 }), points: { show: false } }],
    },
    data: [x, y],
  };
}

const lyapunov: Kind = {
  shows: "lyapunov",
  analysis: "lyapunov",
  heading: "Lyapunov exponent",
  first: 16,
  options: {},
  adds: false,
  facts({ lambda, per_collision, chaotic_share, chaotic_lambda }) {
    const facts: [string, string][] = [];
    if (lambda?.[0]) facts.push(["λ, all orbits", withError(lambda[0].value, lambda[0].stderr)]);
    if (chaotic_share && chaotic_share.value < 1 && chaotic_lambda) facts.push(["λ, chaotic ones", withError(chaotic_lambda.value, chaotic_lambda.stderr)]);
    if (per_collision?.[0]) facts.push(["a hit", withError(per_collision[0].value, per_collision[0].stderr)]);
    if (chaotic_share) facts.push(["chaotic share", withError(chaotic_share.value, chaotic_share.stderr)]);
    return facts;
  },
  plot({ distribution = [] }) {
    const filled = distribution.filter((bin: Result) => bin.count > 0);
    if (!filled.length) return { options: { series: [{}, {}] }, data: [[], []] };
    const [low, high] = [filled[0].from, filled.at(-1).to];
    const bins = distribution.filter((bin: Result) => bin.from >= low && bin.to <= high);
    // Not more bars than orbits can fill.
    const orbits = filled.reduce((sum: number, bin: Result) => sum + bin.count, 0);
    const join = Math.max(1, Math.ceil(bins.length / Math.max(8, Math.min(80, 2 * Math.cbrt(orbits) * 2))));
    const x: number[] = [];
    const y: number[] = [];
    for (let i = 0; i < bins.length; i += join) {
      x.push(bins[i].from);
      y.push(bins.slice(i, i + join).reduce((sum: number, bin: Result) => sum + bin.count, 0));
    }
    x.push(bins.at(-1).to);
    y.push(0);
    if (x.length === 2) {
      const half = Math.max(x[1] - x[0], 0.02 * Math.abs(x[0])) / 2;
      const middle = (x[0] + x[1]) / 2;
      return bars([middle - 3 * half, middle - half, middle + half, middle + 3 * half], [0, y[0], 0, 0]);
    }
    return bars(x, y);
  },
};

const diffusion: Kind = {
  shows: "diffusion",
  analysis: "diffusion",
  heading: "Mean square displacement",
  first: 250,
  options: {},
  adds: true,
  facts({ D, exponent }) {
    const facts: [string, string][] = [];
    if (D?.value != null) facts.push(["D", withError(D.value, D.stderr)]);
    if (exponent?.value != null) facts.push(["exponent", withError(exponent.value, exponent.stderr)]);
    return facts;
  },
  plot({ msd }) {
    const colours = ink();
    const rows = msd.filter((row: Result) => row.value > 0 && row.t > 0);
    return {
      options: {
        scales: logarithmic,
        series: [{ label: "t" }, { label: "MSD", stroke: colours.accent, width: 1.2, points: { show: true, size: 4, fill: colours.paper } }],
      },
      data: [rows.map((row: Result) => row.t), rows.map((row: Result) => row.value)],
    };
  },
};

/** Of a distribution: the fraction of what is longer, and the power law of its tail. */
function longer(bins: Result[], label: string, tail: Result): ReturnType<Kind["plot"]> {
  const colours = ink();
  const rows = bins.filter((bin) => bin.longer > 0 && bin.from > 0);
  const last = rows.findLast((bin) => bin.from <= tail?.to);
  const curve = rows.map(({ from }) => (last && from >= tail.from ? last.longer * (from / last.from) ** -tail.exponent.value : null));
  return {
    options: {
      scales: logarithmic,
      series: [{ label }, { label: "fraction", stroke: colours.ink, width: 1.2, points: { show: rows.length < 40, size: 4, fill: colours.paper } },
        { label: "tail", stroke: colours.accent, width: 1.5, points: { show: false } }],
    },
    data: [rows.map((bin) => bin.from), rows.map((bin) => bin.longer), curve],
  };
}

const flights: Kind = {
  shows: "flights",
  analysis: "diffusion",
  heading: "Flights",
  first: 250,
  options: { free_paths: true },
  adds: true,
  facts({ free_paths: { mean, expected_mean, between_hits } }) {
    const facts: [string, string][] = [];
    if (mean?.value != null) facts.push(["mean length", withError(mean.value, mean.stderr)]);
    if (expected_mean != null) facts.push(["π area / perimeter", plain(expected_mean, 6)]);
    if (between_hits.tail) facts.push(["exponent of the tail", withError(between_hits.tail.exponent.value, between_hits.tail.exponent.stderr)]);
    facts.push(["flights", count(between_hits.flights)]);
    return facts;
  },
  plot: ({ free_paths: { between_hits } }) => longer(between_hits.bins, "length; P(longer)", between_hits.tail),
};

/** How long orbits stay away from a wall. */
function returns(wall: string): Kind {
  return {
    shows: `returns ${wall}`,
    analysis: "returns",
    heading: `Returns to ${wall}`,
    first: 250,
    options: { on: `wall:${wall}` },
    adds: true,
    facts({ mean_time, expected_time, tail, excursions }) {
      const facts: [string, string][] = [];
      if (mean_time?.value != null) facts.push(["mean time", withError(mean_time.value, mean_time.stderr)]);
      if (expected_time != null) facts.push(["Kac’s lemma", plain(expected_time, 6)]);
      if (tail) facts.push(["local slope of the tail", withError(tail.exponent.value, tail.exponent.stderr)]);
      facts.push(["excursions", count(excursions)]);
      return facts;
    },
    plot: ({ return_times, tail }) => longer(return_times, "time; P(longer)", tail),
  };
}

/** What the last panel can show, as the reader chooses. */
function choices(system: System): Kind[] {
  const walls = system.walls.filter((wall) => !wall.hole && !wall.passed).map((wall) => wall.name);
  const free = walls.length && !system.potential ? [flights] : [];
  return [...free, ...[...new Set(walls)].slice(0, MOST_WALLS).map(returns)];
}

class Panel {
  readonly element: HTMLElement;
  readonly kind: Kind;
  private readonly size = make("span", { class: "size" });
  private readonly chart = make("div", { class: "chart" });
  private readonly facts = make("dl");
  private readonly digest = make("span", { class: "digest" });
  private readonly command = make("code");
  private readonly copy = make("button", { type: "button", textContent: "copy command", class: "link" });
  readonly more = make("button", { type: "button", textContent: "more", class: "link", hidden: true });
  private readonly result = make("div", { class: "proof", hidden: true });
  private plot?: uPlot;
  private last?: Result;
  /** What the engine needs to add up what was flown. */
  parts: string[] = [];
  private flown = 0;
  next: number;
  spent = 0; // milliseconds
  done = false;

  /** With other kinds among which the reader may choose, the heading is the choice. */
  constructor(kind: Kind, among: Kind[], chosen: (kind: Kind) => void) {
    this.kind = kind;
    this.next = kind.first;
    this.copy.addEventListener("click", () => void copy(this.command.textContent!, this.copy));
    this.result.append(make("span", {}, "digest ", this.digest), this.copy, this.command);
    this.element = make("section", { class: "panel" }, make("h2", {}, this.heading(among, chosen), " ", this.size, " ", this.more), this.chart, this.facts, this.result);
    this.element.dataset.shows = kind.shows;
    this.chart.append(make("p", { class: "note", textContent: `The first ensemble is being computed: ${kind.first} trajectories.` }));
    new ResizeObserver(() => this.plot?.setSize(this.room())).observe(this.chart);
  }

  private heading(among: Kind[], chosen: (kind: Kind) => void): Node | string {
    if (among.length < 2) return this.kind.heading;
    const choice = make("select", {}, ...among.map((one) => make("option", { value: one.shows, textContent: one.heading })));
    choice.setAttribute("aria-label", "What this panel shows");
    choice.value = this.kind.shows;
    choice.addEventListener("change", () => chosen(among.find((one) => one.shows === choice.value)!));
    return choice;
  }

  /** Flies the trajectories up to `to` that have not been flown, a part on each worker. */
  async add(workers: Worked[], request: object, to: number): Promise<void> {
    if (!this.kind.adds) {
      this.parts = [];
      this.flown = 0;
    }
    const count = Math.min(workers.length, Math.ceil((to - this.flown) / 64));
    const edge = (i: number) => this.flown + Math.round(((to - this.flown) * i) / count);
    const parts = Array.from({ length: count }, (_, i) => {
      const { client, system } = workers[i];
      return client.call({ ...request, system, part: [edge(i), edge(i + 1)] });
    });
    for (const { part } of await Promise.all(parts)) this.parts.push(part);
    this.flown = to;
  }

  show(result: Result, asked: number): void {
    this.last = result;
    const trajectories = Math.min(result.trajectories ?? asked, asked);
    this.size.textContent = trajectories === 1 ? "1 trajectory" : `${count(trajectories)} trajectories`;
    this.facts.replaceChildren(...this.kind.facts(result).flatMap(([name, value]) => [make("dt", { textContent: name }), make("dd", { textContent: value })]));
    this.digest.textContent = result.digest;
    this.command.textContent = result.command;
    this.result.hidden = false;
    this.draw();
  }

  /** No further ensemble, unless the reader asks for it. */
  rest(done: boolean, canGoOn: boolean): void {
    this.done = done;
    this.more.hidden = !(done && canGoOn);
  }

  refuse(text: string): void {
    this.done = true;
    if (this.last) this.size.textContent += `; ${text}`;
    else this.chart.replaceChildren(make("p", { class: "note", textContent: text }));
  }

  draw(): void {
    if (!this.last) return;
    const { options, data } = this.kind.plot(this.last);
    const colours = ink();
    const axis: uPlot.Axis = {
      stroke: colours.soft, font: `12px ${colours.font}`, labelFont: `12px ${colours.font}`, labelSize: 18,
      grid: { stroke: colours.rule, width: 1 }, ticks: { show: false }, size: 28, gap: 4,
    };
    const isLogarithmic = options.scales?.x?.distr === 3;
    // Of a logarithmic axis: powers of ten only, so that few lines are drawn.
    const powers: Partial<uPlot.Axis> = {
      splits: (plot, which, min, max) => {
        const [low, high] = [Math.ceil(Math.log10(min) - 1e-9), Math.floor(Math.log10(max) + 1e-9)];
        if (Math.log10(max / min) < 1.6) {
          return [1, 2, 5].flatMap((m) => Array.from({ length: high - low + 2 }, (_, i) => m * 10 ** (low - 1 + i)))
            .filter((v) => v >= min && v <= max).sort((a, b) => a - b);
        }
        const most = which === 0 ? Math.max(1, (plot.width - 70) / 36) : 5; // labels that find room
        const step = Math.max(1, Math.ceil((high - low) / most));
        return Array.from({ length: Math.max(0, Math.floor((high - low) / step) + 1) }, (_, i) => 10 ** (high - i * step)).reverse();
      },
      values: (_u, splits) => splits.map(label),
      filter: (_u, splits) => splits,
    };
    const plainly: Partial<uPlot.Axis> = { values: (_u, splits) => splits.map((v) => plain(v)), space: 36 };
    this.plot?.destroy();
    this.plot = new uPlot({
      ...this.room(),
      legend: { show: false },
      cursor: { show: false },
      padding: [8, 16, 0, 0],
      ...options,
      axes: [
        { ...axis, label: options.series?.[0]?.label as string, ...(isLogarithmic ? powers : plainly) },
        { ...axis, size: 46, ...plainly, ...(options.scales?.y?.distr === 3 ? powers : {}) },
      ],
    } as uPlot.Options, data, this.chart);
    this.chart.querySelectorAll(".note").forEach((note) => note.remove());
    const facts = this.kind.facts(this.last).map(([name, value]) => `${name} ${value}`).join("; ");
    this.chart.setAttribute("role", "img");
    this.chart.setAttribute("aria-label", `${this.kind.heading}, ${this.size.textContent}: ${facts}`);
  }

  private room(): { width: number; height: number } {
    return { width: Math.max(120, this.chart.clientWidth), height: Math.max(90, this.chart.clientHeight) };
  }
}

function label(value: number): string {
  if (value >= 0.01 && value < 1e5) return String(Number(value.toPrecision(1)));
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const power = Math.round(Math.log10(value));
  return `10${power < 0 ? "⁻" : ""}${String(Math.abs(power)).split("").map((d) => digits[Number(d)]).join("")}`;
}

export class Numbers {
  private panels: Panel[] = [];
  private clients: Client[] = [];
  private run = 0;
  private working = false;

  constructor(private readonly place: HTMLElement) {}

  /** Begins anew for a system. */
  async show(text: string, system: System): Promise<void> {
    this.stop();
    const run = this.run;
    const holes = system.walls.some((wall) => wall.hole);
    const of = (kind: Kind): Kind => ({
      ...kind,
      first: system.potential ? Math.max(1, kind.first >> 4) : kind.first,
      options: { ...kind.options, ...(holes && kind !== escape && kind !== diffusion ? { closed: true } : {}) },
    });
    const last = choices(system).map(of);
    let goOn = () => {};
    const panelOf = (kind: Kind, among: Kind[] = []): Panel => {
      const panel = new Panel(kind, among, (chosen) => {
        const other = panelOf(chosen, among);
        this.panels[this.panels.indexOf(panel)] = other;
        panel.element.replaceWith(other.element);
        goOn();
      });
      panel.more.addEventListener("click", () => {
        panel.rest(false, true);
        goOn();
      });
      return panel;
    };
    this.panels = [holes && escape, system.lattice && diffusion, lyapunov].filter((k): k is Kind => !!k).map((kind) => panelOf(of(kind)));
    if (last.length) this.panels.push(panelOf(last[0], last));
    this.place.classList.remove("stale");
    this.place.replaceChildren(...this.panels.map((panel) => panel.element));
    const clients = (this.clients = Array.from({ length: workers }, () => new Client()));
    try {
      const flown = await Promise.all(clients.map(async (client): Promise<Worked> => {
        const { system: id } = await client.call({ do: "load", toml: text });
        return { client, system: id };
      }));
      const limit = Number(system.keys.find((key) => key.section === "run" && key.key === "trajectories")?.value) || 1e5;
      const work = async () => {
        this.working = true;
        while (run === this.run) {
          // In turn, by the time that each has taken.
          const [panel] = this.panels.filter((one) => !one.done).sort((a, b) => a.spent - b.spent);
          if (!panel) break;
          while (document.hidden) await new Promise((seen) => document.addEventListener("visibilitychange", seen, { once: true }));
          await this.advance(flown, panel, limit, !system.potential);
        }
        if (run === this.run) this.working = false;
      };
      goOn = () => {
        if (!this.working && run === this.run) void work();
      };
      await work();
    } catch (error) {
      if (run === this.run) throw error;
    }
  }

  /** The system has changed: what stands here is of the one before. */
  stop(): void {
    ++this.run;
    for (const client of this.clients) client.stop();
    this.clients = [];
    this.place.classList.add("stale");
  }

  recolour(): void {
    for (const panel of this.panels) panel.draw();
  }

  private async advance(workers: Worked[], panel: Panel, limit: number, inParts: boolean): Promise<void> {
    const begin = performance.now();
    try {
      const trajectories = Math.min(panel.next, limit);
      const { analysis, options } = panel.kind;
      const request = { do: "ensemble", analysis, options: { trajectories, ...options } };
      const [{ client, system }] = workers;
      if (inParts) await panel.add(workers, request, trajectories);
      const result = await client.call({ ...request, system, ...(inParts ? { parts: panel.parts } : {}) });
      panel.show(result, trajectories);
      panel.next *= 2;
      // Fewer than asked for: all start alike.
      const whole = trajectories === limit || result.trajectories < trajectories;
      const spent = performance.now() - begin;
      panel.spent += spent;
      panel.rest(whole || spent > 1000 * PATIENCE, !whole);
    } catch (error) {
      panel.refuse((error as Error).message);
    }
  }
}
