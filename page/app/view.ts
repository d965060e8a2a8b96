// The part of a plane that a canvas shows, and how the reader moves it: wheel, two fingers, keys.

export class View {
  x = 0;
  y = 0;
  /** Pixels per unit, in each direction. */
  kx = 1;
  ky = 1;
  width = 1;
  height = 1;
  /** Margins around the drawn area. */
  left = 0;
  bottom = 0;
  /** The reader has moved it: it is not fitted any more. */
  moved = false;

  fit(box: readonly [number, number, number, number], equal: boolean, margin: number): void {
    const width = Math.max(1, this.width - this.left - 2 * margin);
    const height = Math.max(1, this.height - this.bottom - 2 * margin);
    this.kx = width / (box[2] - box[0] || 1);
    this.ky = height / (box[3] - box[1] || 1);
    if (equal) this.kx = this.ky = Math.min(this.kx, this.ky);
    this.x = (box[0] + box[2]) / 2;
    this.y = (box[1] + box[3]) / 2;
  }

  px(x: number): number {
    return this.left + (this.width - this.left) / 2 + (x - this.x) * this.kx;
  }

  py(y: number): number {
    return (this.height - this.bottom) / 2 - (y - this.y) * this.ky;
  }

  atX(px: number): number {
    return this.x + (px - this.left - (this.width - this.left) / 2) / this.kx;
  }

  atY(py: number): number {
    return this.y - (py - (this.height - this.bottom) / 2) / this.ky;
  }

  zoom(factor: number, px: number, py: number): void {
    const [x, y] = [this.atX(px), this.atY(py)];
    this.kx *= factor;
    this.ky *= factor;
    this.x += x - this.atX(px);
    this.y += y - this.atY(py);
    this.moved = true;
  }

  /** Zooms about the middle by a key; false if it is none of those. */
  zoomBy(key: string): boolean {
    if (!["+", "=", "-"].includes(key)) return false;
    this.zoom(key === "-" ? 0.8 : 1.25, this.width / 2, this.height / 2);
    return true;
  }

  pan(dx: number, dy: number): void {
    this.x -= dx / this.kx;
    this.y += dy / this.ky;
    this.moved = true;
  }
}

/** Listens on a canvas and calls back: a drag or click by one pointer, and changes of the view. */
export interface Gestures {
  changed(): void;
  fit(): void;
  /** A pointer goes down at a place; false: it shall move the view. */
  grab(px: number, py: number, touch: boolean): boolean;
  drag(px: number, py: number): void;
  drop(px: number, py: number): void;
  cancel(): void;
  hover?(px: number, py: number): void;
}

export function listen(canvas: HTMLCanvasElement, view: View, gestures: Gestures): void {
  const pointers = new Map<number, [number, number]>();
  let grabbed = false;
  const place = (event: MouseEvent): [number, number] => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.04 : 0.0015)), ...place(event));
    gestures.changed();
  }, { passive: false });
  canvas.addEventListener("dblclick", () => gestures.fit());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, place(event));
    if (pointers.size === 1) {
      grabbed = event.button === 0 && !event.shiftKey && gestures.grab(...place(event), event.pointerType === "touch");
    } else if (grabbed) {
      grabbed = false;
      gestures.cancel();
    }
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = place(event);
    const before = pointers.get(event.pointerId);
    if (!before) {
      gestures.hover?.(...now);
    } else if (grabbed) {
      gestures.drag(...now);
    } else if (pointers.size === 1) {
      view.pan(now[0] - before[0], now[1] - before[1]);
      gestures.changed();
    } else {
      const other = [...pointers].find(([id]) => id !== event.pointerId)![1];
      const reach = (p: [number, number]) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      view.zoom(reach(now) / (reach(before) || 1), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      view.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
      gestures.changed();
    }
    if (before) pointers.set(event.pointerId, now);
  });
  const up = (event: PointerEvent, done: boolean) => {
    if (!pointers.delete(event.pointerId) || !grabbed) return;
    grabbed = false;
    if (done) gestures.drop(...place(event));
    else gestures.cancel();
  };
  canvas.addEventListener("pointerup", (event) => up(event, true));
  canvas.addEventListener("pointercancel", (event) => up(event, false));
}

/** Keeps a canvas as large as its place on the page; calls back when that changes. */
export function sized(canvases: HTMLCanvasElement[], view: View, changed: () => void): void {
  new ResizeObserver(() => {
    const frame = canvases[0].parentElement!;
    const ratio = Math.min(window.devicePixelRatio, 3);
    view.width = frame.clientWidth;
    view.height = frame.clientHeight;
    for (const canvas of canvases) {
      canvas.width = Math.round(view.width * ratio);
      canvas.height = Math.round(view.height * ratio);
      canvas.style.width = `${view.width}px`;
      canvas.style.height = `${view.height}px`;
      canvas.getContext("2d")!.setTransform(ratio, 0, 0, ratio, 0, 0);
    }
    changed();
  }).observe(canvases[0].parentElement!);
}
