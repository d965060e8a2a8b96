// The built-in systems, with a picture of each: its walls, as the engine gives them.
import type { Client } from "./client";
import type { System } from "./protocol";
import { make } from "./words";

export interface Builtin {
  name: string;
  title: string;
}

/** A system as a small drawing: its walls, and the path of a particle where forces act. */
function outline(system: System, trail: Float64Array, width: number, height: number): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("aria-hidden", "true");
  const [x0, y0, x1, y1] = trail.length ? around(trail) : system.box;
  const few = system.lattice && system.walls.length > 0 && system.walls.length < 10;
  const zoom = few ? 0.45 : 1; // neighbours, too
  const k = zoom * Math.min((width - 6) / (x1 - x0 || 1), (height - 6) / (y1 - y0 || 1));
  const px = (x: number) => (width / 2 + (x - (x0 + x1) / 2) * k).toFixed(1);
  const py = (y: number) => (height / 2 - (y - (y0 + y1) / 2) * k).toFixed(1);
  const draw = (d: string, hole: boolean) => {
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", d);
    if (hole) path.setAttribute("class", "hole");
    svg.append(path);
  };
  const [ax, ay, bx, by] = system.lattice ?? [0, 0, 0, 0];
  const shifts = few ? [-2, -1, 0, 1, 2] : [0];
  for (const i of shifts) {
    for (const j of shifts) {
      for (const wall of system.walls) {
        let d = "";
        for (let n = 0; n < wall.points.length; n += 2) {
          d += `${n ? "L" : "M"}${px(wall.points[n] + i * ax + j * bx)} ${py(wall.points[n + 1] + i * ay + j * by)}`;
        }
        draw(wall.closed ? `${d}Z` : d, wall.hole);
      }
    }
  }
  const path = Array.from({ length: trail.length / 3 }, (_, i) => `${px(trail[3 * i + 1])} ${py(trail[3 * i + 2])}`);
  if (path.length) draw(`M${path.join("L")}`, true);
  return svg;
}

function around(trail: Float64Array): [number, number, number, number] {
  const xs = trail.filter((_, i) => i % 3 === 1);
  const ys = trail.filter((_, i) => i % 3 === 2);
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** A piece of the first path of a system without walls. */
async function pathOf(client: Client, system: System): Promise<Float64Array> {
  if (system.walls.length > 0) return new Float64Array(0);
  const start = { seed: 1, trajectory: 0 };
  await client.begin({ do: "begin", system: system.system, forces: true, walls: false, starts: [start], slots: [0], keep: false, rates: false });
  await client.ask({ do: "grain", grain: 0.1 });
  const { trail } = await client.frame(40, 150);
  return trail.filter((_, i) => trail[i - (i % 3)] === 0); // the first particle's
}

export class Picker {
  private drawn = false;

  constructor(
    private readonly dialog: HTMLDialogElement,
    private readonly list: HTMLElement,
    private readonly systems: Builtin[],
    private readonly client: () => Client,
    private readonly picked: (name: string) => void,
  ) {
    this.dialog.addEventListener("click", (event) => {
      if (event.target === this.dialog) this.dialog.close();
    });
    for (const system of systems) {
      const button = make("button", { type: "button", class: "system" }, make("span", { class: "thumb" }),
        make("b", { textContent: system.name }), make("span", { textContent: system.title }));
      button.dataset.name = system.name;
      button.addEventListener("click", () => {
        this.dialog.close();
        this.picked(system.name);
      });
      this.list.append(button);
    }
  }

  open(): void {
    this.dialog.showModal();
    if (!this.drawn) void this.draw();
  }

  private async draw(): Promise<void> {
    this.drawn = true;
    const client = this.client();
    for (const { name } of this.systems) {
      const place = this.list.querySelector(`[data-name="${name}"] .thumb`)!;
      try {
        const { toml } = await client.call({ do: "toml", name });
        const system: System = await client.call({ do: "load", toml });
        place.replaceChildren(outline(system, await pathOf(client, system), 96, 60));
        await client.call({ do: "unload", system: system.system });
      } catch {
        place.textContent = "";
      }
    }
  }
}
