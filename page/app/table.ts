// The table: walls, paths and particles; a drag starts an orbit.
import { arc } from "./flight";
import { type Handle } from "./handles";
import { ink, packed, type Ink } from "./palette";
import { FRAME_ROW, type Frame, type System } from "./protocol";
import type { Tint } from "./tint";
import type { Trace } from "./trace";
import { listen, sized, View } from "./view";

const MOST_FLIGHTS = 30000; // redrawn when the view changes
const MOST_CELLS = 5000; // of a lattice

export interface TableEvents {
  start(position: [number, number], velocity: [number, number]): void;
  /** A handle is pulled to a place. */
  pull(handle: Handle, x: number, y: number, done: boolean): void;
}

export class Table {
  readonly view = new View();
  /** More orbits than this are drawn without their paths. */
  private static readonly WITH_PATHS = 64;
  private readonly under: HTMLCanvasElement;
  private readonly over: HTMLCanvasElement;
  private readonly walls: CanvasRenderingContext2D;
  private readonly paths: CanvasRenderingContext2D;
  private readonly top: CanvasRenderingContext2D;
  private colours: Ink = ink();
  private system?: System;
  private last = new Map<number, ArrayLike<number>>();
  private frame?: Frame;
  private gone: { slot: number; x: number; y: number }[] = [];
  private orbits = 0;
  private aim?: { x: number; y: number; tx: number; ty: number };
  private cursor?: { x: number; y: number; angle: number };
  private held?: Handle;
  private bitmap?: ImageData;
  private handles: Handle[] = [];
  private seen: [number, number, number, number] = [Infinity, Infinity, -Infinity, -Infinity];
  private grown = false;
  private alpha = 1;
  private near = matchMedia("(pointer: coarse)").matches;

  constructor(place: HTMLElement, private readonly trace: Trace, private readonly tint: Tint, private readonly events: TableEvents) {
    this.under = document.createElement("canvas");
    const middle = document.createElement("canvas");
    this.over = document.createElement("canvas");
    place.append(this.under, middle, this.over);
    this.walls = this.under.getContext("2d")!;
    this.paths = middle.getContext("2d")!;
    this.top = this.over.getContext("2d")!;
    this.over.tabIndex = 0;
    this.over.setAttribute("role", "application");
    this.over.setAttribute("aria-label", "The table. Drag to start a particle. Keys: arrows move a cursor, " +
      "comma and full stop turn it, Enter starts there; plus and minus zoom, 0 shows all.");
    sized([this.under, middle, this.over], this.view, () => {
      if (!this.view.moved) this.fit();
      this.draw();
    });
    listen(this.over, this.view, {
      changed: () => this.draw(),
      fit: () => this.fitAll(),
      grab: (px, py, touch) => this.grab(px, py, touch),
      drag: (px, py) => this.drag(px, py, false),
      drop: (px, py) => this.drag(px, py, true),
      cancel: () => {
        this.aim = undefined;
        this.held = undefined;
        this.drawTop();
      },
      hover: (px, py) => (this.over.style.cursor = this.handleAt(px, py, 8) ? "grab" : "crosshair"),
    });
    this.over.addEventListener("keydown", (event) => this.key(event));
    for (const [kind, near] of [["pointerenter", true], ["pointerleave", false]] as const) {
      this.over.addEventListener(kind, (event) => {
        this.near = near || event.pointerType === "touch";
        this.drawTop();
      });
    }
    this.over.addEventListener("blur", () => {
      this.cursor = undefined;
      this.drawTop();
    });
  }

  show(system: System): void {
    const same = this.system && String(this.system.box) === String(system.box);
    this.system = system;
    if (!same) this.view.moved = false;
    if (!this.view.moved) this.fit();
    this.handles = [];
    this.seen = [Infinity, Infinity, -Infinity, -Infinity];
    this.clear(1);
  }

  /** Forgets the orbits; `orbits` is how many there will be. */
  clear(orbits: number): void {
    this.orbits = orbits;
    this.last.clear();
    this.gone = [];
    this.frame = undefined;
    this.draw();
  }

  started(slots: number[], states: Float64Array, orbits: number): void {
    this.orbits = orbits;
    slots.forEach((slot, i) => this.last.set(slot, [0, ...states.subarray(4 * i, 4 * i + 4)]));
  }

  step(frame: Frame): void {
    this.frame = frame;
    const alpha = transparency(this.trace.rows);
    if (this.withPaths && alpha !== this.alpha) this.draw();
    else if (this.withPaths) this.addPaths(frame.hits, frame.trail);
    for (const { slot, x, y } of frame.ended) {
      this.gone.push({ slot, x, y });
      this.last.delete(slot);
    }
    if (this.gone.length > 2000) this.gone.splice(0, this.gone.length - 2000);
    this.follow(frame);
    this.drawTop();
  }

  showHandles(handles: Handle[]): void {
    this.handles = handles;
    this.drawTop();
  }

  showMarks(): void {
    this.drawTop();
  }

  recolour(): void {
    this.colours = ink();
    this.bitmap = undefined;
    this.draw();
  }

  fitAll(): void {
    this.view.moved = false;
    this.fit();
    this.draw();
  }

  /** All layers on one canvas, for a picture. */
  picture(canvas: CanvasRenderingContext2D): void {
    for (const layer of [this.under, this.paths.canvas, this.over]) canvas.drawImage(layer, 0, 0);
  }

  get size(): [number, number] {
    return [this.under.width, this.under.height];
  }

  get element(): HTMLCanvasElement {
    return this.over;
  }

  private get withPaths(): boolean {
    return this.orbits <= Table.WITH_PATHS;
  }

  private fit(): void {
    if (!this.system) return;
    const seen = this.system.walls.length === 0 && this.seen[2] > this.seen[0];
    this.view.fit(seen ? this.seen : this.system.box, true, 14);
    if (this.system.lattice && !seen) this.view.kx = this.view.ky *= this.system.walls.length < 10 ? 0.4 : 0.8; // neighbours, too
  }

  /** In a lattice, and where no walls are, the view goes with the orbit, until the reader moves it. */
  private follow(frame: Frame): void {
    const { system, view } = this;
    if (!system || view.moved || !frame.slots.length || this.orbits > 16) return;
    if (system.walls.length === 0) {
      for (let at = 0; at < frame.trail.length; at += 3) this.enclose(frame.trail[at + 1], frame.trail[at + 2]);
      if (!this.grown || !(this.seen[2] > this.seen[0])) return;
      this.grown = false;
      this.fit();
      this.draw();
    } else if (system.lattice) {
      const inside = (x: number, y: number) => x > 0 && y > 0 && x < view.width && y < view.height;
      const all = frame.slots.every((_, i) => inside(view.px(frame.dots[2 * i]), view.py(frame.dots[2 * i + 1])));
      if (all || view.kx * Math.hypot(system.lattice[0], system.lattice[1]) < 20) return;
      view.zoom(0.7, view.width / 2, view.height / 2);
      view.moved = false;
      this.draw();
    }
  }

  /** Grows the box of what was seen, by more than asked for, so that it grows seldom. */
  private enclose(x: number, y: number): void {
    const { seen } = this;
    if (x >= seen[0] && y >= seen[1] && x <= seen[2] && y <= seen[3]) return;
    this.grown = true;
    const more = 0.1 * Math.max(seen[2] - seen[0], seen[3] - seen[1], 0);
    if (x < seen[0]) seen[0] = x - more;
    if (y < seen[1]) seen[1] = y - more;
    if (x > seen[2]) seen[2] = x + more;
    if (y > seen[3]) seen[3] = y + more;
  }

  draw(): void {
    this.drawWalls();
    this.paths.clearRect(0, 0, this.view.width, this.view.height);
    this.alpha = transparency(this.trace.rows);
    this.last = new Map([...this.trace.starts].map(([slot, s]) => [slot, [0, s[0], s[1], s[2], s[3]]]));
    if (this.withPaths) {
      if (this.trace.rows > MOST_FLIGHTS) this.last.clear();
      if (this.system?.potential) for (const places of this.trace.trail) this.addTrail(places);
      else for (const block of this.trace.blocks(MOST_FLIGHTS)) this.addFlights(block);
    }
    this.drawTop();
  }

  private drawWalls(): void {
    const { walls: g, view, system, colours } = this;
    g.clearRect(0, 0, view.width, view.height);
    if (!system) return;
    g.lineJoin = g.lineCap = "round";
    // The file's cell last, over its copies.
    for (const centre of [false, true]) {
      const walls = new Path2D();
      const edges = new Path2D();
      const holes = new Path2D();
      for (const [dx, dy, own] of this.cells()) {
        if (own !== centre) continue;
        for (const wall of system.walls) {
          if (wall.points.length === 0) continue;
          const path = wall.hole ? holes : wall.passed ? edges : walls;
          path.moveTo(view.px(wall.points[0] + dx), view.py(wall.points[1] + dy));
          for (let i = 2; i < wall.points.length; i += 2) {
            path.lineTo(view.px(wall.points[i] + dx), view.py(wall.points[i + 1] + dy));
          }
          if (wall.closed) path.closePath();
        }
      }
      g.strokeStyle = centre ? colours.ink : colours.soft;
      g.lineWidth = centre ? 1.5 : 0.8;
      g.stroke(walls);
      g.lineWidth /= 2;
      g.setLineDash([6, 3]);
      g.stroke(edges);
      g.setLineDash([]);
      g.strokeStyle = colours.paper;
      g.lineWidth = 4;
      g.stroke(holes);
      g.strokeStyle = colours.accent;
      g.lineWidth = 1;
      g.setLineDash([2, 3]);
      g.stroke(holes);
      g.setLineDash([]);
    }
  }

  /** Shifts of the cell in view, and whether it is the one of the file. */
  private cells(): [number, number, boolean][] {
    const { view, system } = this;
    if (!system?.lattice) return [[0, 0, true]];
    const [ax, ay, bx, by] = system.lattice;
    const det = ax * by - ay * bx;
    const reach = Math.max(system.box[2] - system.box[0], system.box[3] - system.box[1]);
    const x0 = view.atX(0) - reach, x1 = view.atX(view.width) + reach;
    const y0 = view.atY(view.height) - reach, y1 = view.atY(0) + reach;
    const corners = [[x0, y0], [x1, y0], [x0, y1], [x1, y1]];
    const is = corners.map(([x, y]) => (x * by - y * bx) / det);
    const js = corners.map(([x, y]) => (y * ax - x * ay) / det);
    const cells: [number, number, boolean][] = [];
    for (let i = Math.floor(Math.min(...is)); i <= Math.max(...is); ++i) {
      for (let j = Math.floor(Math.min(...js)); j <= Math.max(...js); ++j) {
        const [dx, dy] = [i * ax + j * bx, i * ay + j * by];
        if (dx + system.box[2] < x0 || dx + system.box[0] > x1 || dy + system.box[3] < y0 || dy + system.box[1] > y1) continue;
        cells.push([dx, dy, i === 0 && j === 0]);
        if (cells.length > MOST_CELLS) return cells;
      }
    }
    return cells;
  }

  private addPaths(hits: Float64Array, trail: Float64Array): void {
    if (this.system?.potential) this.addTrail(trail);
    else this.addFlights(hits);
  }

  private addTrail(places: Float64Array): void {
    const paths = new Map<number, Path2D>();
    for (let at = 0; at < places.length; at += 3) {
      const [slot, x, y] = places.subarray(at, at + 3);
      const from = this.last.get(slot);
      this.last.set(slot, [0, x, y, 0, 0]);
      let path = paths.get(slot);
      if (!path) {
        paths.set(slot, (path = new Path2D()));
        if (from) path.moveTo(this.view.px(from[1]), this.view.py(from[2]));
      }
      path.lineTo(this.view.px(x), this.view.py(y));
    }
    this.paths.lineWidth = 0.8;
    this.paths.globalAlpha = 0.6;
    for (const [slot, path] of paths) {
      this.paths.strokeStyle = this.tint.colour(slot);
      this.paths.stroke(path);
    }
    this.paths.globalAlpha = 1;
  }

  private addFlights(hits: Float64Array): void {
    const { paths: g, view } = this;
    const byColour = new Map<string, Path2D>();
    for (let at = 0; at < hits.length; at += FRAME_ROW) {
      const slot = hits[at];
      const row = hits.subarray(at + 1, at + FRAME_ROW);
      const from = this.last.get(slot);
      this.last.set(slot, [row[0], row[1], row[2], row[3], row[4], row[8]]);
      if (!from) continue;
      const colour = this.tint.colour(slot);
      let path = byColour.get(colour);
      if (!path) byColour.set(colour, (path = new Path2D()));
      flight(path, view, from, row);
    }
    g.lineWidth = 0.7;
    g.globalAlpha = this.alpha;
    for (const [colour, path] of byColour) {
      g.strokeStyle = colour;
      g.stroke(path);
    }
    g.globalAlpha = 1;
  }

  private drawTop(): void {
    const { top: g, view, frame, colours } = this;
    g.clearRect(0, 0, view.width, view.height);
    if (frame && frame.slots.length > 300) this.drawCloud(frame);
    else if (frame) {
      frame.slots.forEach((slot, i) => {
        const [x, y] = [frame.dots[2 * i], frame.dots[2 * i + 1]];
        g.fillStyle = g.strokeStyle = this.tint.colour(slot);
        const from = this.withPaths && this.last.get(slot);
        if (from) {
          const path = new Path2D();
          flight(path, view, from, [NaN, x, y, 0, 0, 0, 0, 0, from[5] ?? 0]);
          g.lineWidth = 1;
          g.stroke(path);
        }
        g.beginPath();
        g.arc(view.px(x), view.py(y), this.orbits > 40 ? 2 : 3.5, 0, 2 * Math.PI);
        g.fill();
        g.strokeStyle = colours.paper; // apart from its path
        g.lineWidth = 1;
        g.stroke();
      });
    }
    for (const [x, y] of this.trace.marks.values()) {
      const [px, py] = [view.px(x), view.py(y)];
      g.strokeStyle = colours.ink;
      g.lineWidth = 1.5;
      g.beginPath();
      for (const [dx, dy] of [[5, 5], [5, -5]]) {
        g.moveTo(px - dx, py - dy);
        g.lineTo(px + dx, py + dy);
      }
      g.stroke();
    }
    g.lineWidth = 1;
    if (this.orbits <= 300) {
      for (const { slot, x, y } of this.gone) {
        g.strokeStyle = this.tint.colour(slot);
        g.beginPath();
        g.arc(view.px(x), view.py(y), 2.5, 0, 2 * Math.PI);
        g.stroke();
      }
    }
    for (const handle of this.held ? [this.held] : this.near ? this.handles : []) {
      g.beginPath();
      g.arc(view.px(handle.x), view.py(handle.y), handle === this.held ? 6 : 4, 0, 2 * Math.PI);
      g.fillStyle = colours.paper;
      g.fill();
      g.strokeStyle = colours.accent;
      g.lineWidth = 1.2;
      g.stroke();
    }
    if (this.aim) arrow(g, view.px(this.aim.x), view.py(this.aim.y), this.aim.tx, this.aim.ty, colours.accent);
    if (this.cursor) {
      const { x, y, angle } = this.cursor;
      const [px, py] = [view.px(x), view.py(y)];
      arrow(g, px, py, px + 40 * Math.cos(angle), py - 40 * Math.sin(angle), colours.accent);
    }
  }

  /** Many particles: pixels of their own. */
  private drawCloud(frame: Frame): void {
    const { width, height } = this.over;
    const ratio = width / this.view.width;
    if (!this.bitmap || this.bitmap.width !== width || this.bitmap.height !== height) this.bitmap = new ImageData(width, height);
    const pixels = new Uint32Array(this.bitmap.data.buffer);
    pixels.fill(0);
    const inks = this.tint.packed(1);
    const single = this.tint.by === "orbit" && this.orbits > Table.WITH_PATHS ? packed(this.colours.accent, 1) : 0;
    const size = Math.max(1, Math.round((frame.slots.length > 3000 ? 1 : 2) * ratio));
    for (let i = 0; i < frame.slots.length; ++i) {
      const px = Math.round(this.view.px(frame.dots[2 * i]) * ratio - size / 2);
      const py = Math.round(this.view.py(frame.dots[2 * i + 1]) * ratio - size / 2);
      if (px < 0 || py < 0 || px + size > width || py + size > height) continue;
      const ink = single || inks[this.tint.index(frame.slots[i])];
      for (let y = py; y < py + size; ++y) for (let x = px; x < px + size; ++x) pixels[y * width + x] = ink;
    }
    this.top.putImageData(this.bitmap, 0, 0);
  }

  private handleAt(px: number, py: number, reach: number): Handle | undefined {
    return this.handles.find((h) => Math.hypot(this.view.px(h.x) - px, this.view.py(h.y) - py) < reach);
  }

  private grab(px: number, py: number, touch: boolean): boolean {
    this.held = this.handleAt(px, py, touch ? 20 : 8);
    if (!this.held) this.aim = { x: this.view.atX(px), y: this.view.atY(py), tx: px, ty: py };
    return true;
  }

  private drag(px: number, py: number, done: boolean): void {
    const { view, aim, held } = this;
    if (held) {
      this.events.pull(held, view.atX(px), view.atY(py), done);
      if (done) this.held = undefined;
    } else if (aim) {
      [aim.tx, aim.ty] = [px, py];
      if (done) {
        const velocity: [number, number] = [view.atX(px) - aim.x, view.atY(py) - aim.y];
        const long = Math.hypot(px - view.px(aim.x), py - view.py(aim.y)) > 4;
        if (long) this.events.start([aim.x, aim.y], velocity);
        this.aim = undefined;
      }
    }
    this.drawTop();
  }

  private key(event: KeyboardEvent): void {
    const { view } = this;
    const step = 0.04 * Math.min(view.width / view.kx, view.height / view.ky) * (event.shiftKey ? 0.1 : 1);
    const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (move || event.key === "," || event.key === "." || event.key === "Enter") {
      this.cursor ??= { x: view.x, y: view.y, angle: 0.7 };
      const { cursor } = this;
      if (move) {
        cursor.x += move[0] * step;
        cursor.y += move[1] * step;
      } else if (event.key === "Enter") {
        this.events.start([cursor.x, cursor.y], [Math.cos(cursor.angle), Math.sin(cursor.angle)]);
      } else {
        cursor.angle += event.key === "," ? 0.1 : -0.1;
      }
      this.drawTop();
    } else if (view.zoomBy(event.key)) {
      this.draw();
    } else if (event.key === "0") {
      this.fitAll();
    } else {
      return;
    }
    event.preventDefault();
  }
}

/** Of flights, the fainter the more there are, so that caustics show. */
function transparency(flights: number): number {
  const [, alpha] = [[300, 0.8], [1000, 0.5], [3000, 0.3], [10000, 0.15], [Infinity, 0.08]].find(([most]) => flights < most)!;
  return alpha;
}

/** Adds the flight from one state to the next hit. */
function flight(path: Path2D, view: View, from: ArrayLike<number>, row: ArrayLike<number>): void {
  path.moveTo(view.px(from[1]), view.py(from[2]));
  if (row[8] === 0) {
    path.lineTo(view.px(row[1]), view.py(row[2]));
  } else {
    const a = arc(from, row[1], row[2], row[8]);
    path.arc(view.px(a.x), view.py(a.y), a.r * view.kx, -a.from, -a.from - a.turn, a.turn > 0);
  }
}

function arrow(g: CanvasRenderingContext2D, x: number, y: number, tx: number, ty: number, colour: string): void {
  const angle = Math.atan2(ty - y, tx - x);
  g.strokeStyle = g.fillStyle = colour;
  g.lineWidth = 1.2;
  g.beginPath();
  g.moveTo(x, y);
  g.lineTo(tx, ty);
  g.stroke();
  g.beginPath();
  g.moveTo(tx, ty);
  g.lineTo(tx - 9 * Math.cos(angle - 0.4), ty - 9 * Math.sin(angle - 0.4));
  g.lineTo(tx - 9 * Math.cos(angle + 0.4), ty - 9 * Math.sin(angle + 0.4));
  g.fill();
  g.beginPath();
  g.arc(x, y, 2.5, 0, 2 * Math.PI);
  g.fill();
}
