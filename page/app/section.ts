// The boundary section: arc length s and the velocity along the wall over the speed, a point for each hit.
import { ink, type Ink } from "./palette";
import { FRAME_ROW, type System } from "./protocol";
import type { Tint } from "./tint";
import type { Trace } from "./trace";
import { listen, sized, View } from "./view";
import { ticks } from "./words";

export class Section {
  readonly view = new View();
  private readonly under: HTMLCanvasElement;
  private readonly over: HTMLCanvasElement;
  private readonly axes: CanvasRenderingContext2D;
  private readonly points: CanvasRenderingContext2D;
  private colours: Ink = ink();
  private system?: System;
  private bitmap?: ImageData;
  private size = 4;
  private cursor?: { s: number; v: number };

  constructor(place: HTMLElement, private readonly trace: Trace, private readonly tint: Tint, private readonly start: (s: number, v: number) => void) {
    this.under = document.createElement("canvas");
    this.over = document.createElement("canvas");
    place.append(this.under, this.over);
    this.axes = this.under.getContext("2d")!;
    this.points = this.over.getContext("2d")!;
    this.over.tabIndex = 0;
    this.over.style.cursor = "crosshair";
    this.over.setAttribute("role", "application");
    this.over.setAttribute("aria-label", "The boundary section. Click to start a particle at a place on the wall. " +
      "Keys: arrows move a cursor, Enter starts there; plus and minus zoom, 0 shows all.");
    this.view.left = 34;
    this.view.bottom = 34;
    sized([this.under, this.over], this.view, () => {
      if (!this.view.moved) this.fit();
      this.draw();
    });
    let down: [number, number] | undefined;
    listen(this.over, this.view, {
      changed: () => this.draw(),
      fit: () => this.fitAll(),
      grab: (px, py) => {
        down = [px, py];
        return true;
      },
      drag: (px, py) => {
        if (!down) return;
        if (!this.panning && Math.hypot(px - down[0], py - down[1]) < 5) return;
        this.panning = true;
        this.view.pan(px - down[0], py - down[1]);
        down = [px, py];
        this.draw();
      },
      drop: (px, py) => {
        if (!this.panning) this.click(this.view.atX(px), this.view.atY(py));
        this.panning = false;
      },
      cancel: () => (this.panning = false),
    });
    this.over.addEventListener("keydown", (event) => this.key(event));
    this.over.addEventListener("blur", () => {
      this.cursor = undefined;
      this.drawAxes();
    });
  }

  private panning = false;

  show(system: System): void {
    const same = this.system && this.system.length === system.length;
    this.system = system;
    if (!same) this.view.moved = false;
    if (!this.view.moved) this.fit();
    this.clear();
  }

  clear(): void {
    this.draw();
  }

  step(hits: Float64Array): void {
    const size = this.sizeFor(this.trace.rows);
    if (size !== this.size) {
      this.draw();
      return;
    }
    this.add(hits);
    this.paint();
  }

  recolour(): void {
    this.colours = ink();
    this.draw();
  }

  picture(canvas: CanvasRenderingContext2D, x: number): void {
    canvas.drawImage(this.under, x, 0);
    canvas.drawImage(this.over, x, 0);
  }

  get pixels(): [number, number] {
    return [this.under.width, this.under.height];
  }

  get element(): HTMLCanvasElement {
    return this.over;
  }

  private fitAll(): void {
    this.view.moved = false;
    this.fit();
    this.draw();
  }

  private fit(): void {
    if (this.system) this.view.fit([0, -1, this.system.length, 1], false, 8);
  }

  private click(s: number, v: number): void {
    if (this.system && s >= 0 && s < this.system.length && Math.abs(v) < 1) this.start(s, v);
  }

  private sizeFor(rows: number): number {
    return rows < 300 ? 4 : rows < 3000 ? 3 : rows < 20000 ? 2 : 1;
  }

  draw(): void {
    this.drawAxes();
    this.size = this.sizeFor(this.trace.rows);
    const { width, height } = this.over;
    if (!width || !height) return;
    if (!this.bitmap || this.bitmap.width !== width || this.bitmap.height !== height) this.bitmap = new ImageData(width, height);
    new Uint32Array(this.bitmap.data.buffer).fill(0);
    for (const block of this.trace.blocks()) this.add(block);
    this.paint();
  }

  private paint(): void {
    if (this.bitmap) this.points.putImageData(this.bitmap, 0, 0);
  }

  private add(hits: Float64Array): void {
    if (!this.bitmap || !this.system || this.system.walls.length === 0) return;
    const { view } = this;
    const { width } = this.bitmap;
    const ratio = width / view.width;
    const pixels = new Uint32Array(this.bitmap.data.buffer);
    const inks = this.tint.packed(0.9);
    const size = Math.max(1, Math.round(this.size * ratio * 0.8));
    const left = Math.round(view.left * ratio);
    const bottom = Math.round((view.height - view.bottom) * ratio);
    for (let at = 0; at < hits.length; at += FRAME_ROW) {
      const speed = Math.hypot(hits[at + 4], hits[at + 5]);
      const px = Math.round(view.px(hits[at + 7]) * ratio - size / 2);
      const py = Math.round(view.py(hits[at + 8] / speed) * ratio - size / 2);
      if (px < left || py < 0 || px + size > width || py + size > bottom) continue;
      const ink = inks[this.tint.index(hits[at])];
      for (let y = py; y < py + size; ++y) for (let x = px; x < px + size; ++x) pixels[y * width + x] = ink;
    }
  }

  private drawAxes(): void {
    const { axes: g, view, colours, system } = this;
    g.clearRect(0, 0, view.width, view.height);
    if (!system) return;
    const bottom = view.height - view.bottom;
    g.font = `12px ${colours.font}`;
    if (system.walls.length === 0) {
      g.fillStyle = colours.soft;
      g.textAlign = "center";
      g.fillText("This system has no walls, so it has no boundary section.", view.width / 2, view.height / 2, view.width - 20);
      return;
    }
    g.lineWidth = 1;
    g.strokeStyle = colours.rule;
    g.save();
    g.beginPath();
    g.rect(view.left, 0, view.width, bottom);
    g.clip();
    g.beginPath();
    for (const wall of system.walls) {
      if (wall.hole) continue;
      const px = Math.round(view.px(wall.offset)) + 0.5;
      g.moveTo(px, view.py(-1));
      g.lineTo(px, view.py(1));
    }
    const last = Math.round(view.px(system.length)) - 0.5;
    g.moveTo(last, view.py(-1));
    g.lineTo(last, view.py(1));
    for (const v of [-1, 0, 1]) {
      g.moveTo(view.px(0), Math.round(view.py(v)) + 0.5);
      g.lineTo(view.px(system.length), Math.round(view.py(v)) + 0.5);
    }
    g.stroke();
    g.strokeStyle = colours.accent;
    g.lineWidth = 3;
    for (const wall of system.walls) {
      if (!wall.hole) continue;
      g.beginPath();
      g.moveTo(view.px(wall.offset), bottom - 1.5);
      g.lineTo(view.px(wall.offset + wall.length), bottom - 1.5);
      g.stroke();
    }
    if (this.cursor) {
      g.lineWidth = 1;
      g.beginPath();
      g.moveTo(view.px(this.cursor.s), 0);
      g.lineTo(view.px(this.cursor.s), bottom);
      g.moveTo(view.left, view.py(this.cursor.v));
      g.lineTo(view.width, view.py(this.cursor.v));
      g.stroke();
    }
    g.restore();
    g.fillStyle = colours.soft;
    g.textBaseline = "top";
    g.textAlign = "center";
    const [s0, s1] = [Math.max(0, view.atX(view.left)), Math.min(system.length, view.atX(view.width))];
    for (const { value, text } of ticks(s0, s1, view.width / 90)) {
      const px = view.px(value);
      g.fillText(text, Math.min(px, view.width - g.measureText(text).width / 2), bottom + 4);
    }
    g.textBaseline = "middle";
    g.textAlign = "right";
    const [v0, v1] = [Math.max(-1, view.atY(bottom)), Math.min(1, view.atY(0))];
    for (const { value, text } of ticks(v0, v1, view.height / 70)) {
      g.fillText(text, view.left - 5, Math.min(Math.max(view.py(value), 6), bottom - 6));
    }
    g.fillStyle = colours.ink;
    g.textBaseline = "bottom";
    g.textAlign = "center";
    g.fillText("s, arc length along the walls", view.left + (view.width - view.left) / 2, view.height);
  }

  private key(event: KeyboardEvent): void {
    const { view, system } = this;
    if (!system) return;
    const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const step = event.shiftKey ? 2 : 12;
    if (move) {
      this.cursor ??= { s: Math.min(Math.max(view.x, 0), system.length), v: view.y };
      this.cursor.s = Math.min(Math.max(this.cursor.s + (move[0] * step) / view.kx, 0), system.length);
      this.cursor.v = Math.min(Math.max(this.cursor.v + (move[1] * step) / view.ky, -0.999), 0.999);
      this.drawAxes();
    } else if (event.key === "Enter" && this.cursor) {
      this.click(this.cursor.s, this.cursor.v);
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
