// Files to take home: hits as CSV, the two drawings as SVG or PNG.
import { arc } from "./flight";
import { ink } from "./palette";
import { FRAME_ROW, type System } from "./protocol";
import type { Section } from "./section";
import type { Table } from "./table";
import type { Tint } from "./tint";
import type { Trace } from "./trace";

const MOST = 20000; // flights and points of a drawing

/** Every hit that is kept, with the digits that give its doubles back. */
export function csv(trace: Trace, system: System): Blob {
  const walls = system.walls.filter((wall) => !wall.hole);
  const lines = ["orbit,t,x,y,vx,vy,wall,s,v_parallel"];
  for (const block of trace.blocks()) {
    for (let at = 0; at < block.length; at += FRAME_ROW) {
      const r = block.subarray(at, at + FRAME_ROW);
      lines.push([r[0], r[1], r[2], r[3], r[4], r[5], walls[r[6]]?.name ?? r[6], r[7], r[8]].join(","));
    }
  }
  return new Blob([lines.join("\n"), "\n"], { type: "text/csv" });
}

export function svg(trace: Trace, system: System, tint: Tint): Blob {
  const colours = ink();
  const size = 480;
  const [x0, y0, x1, y1] = system.box;
  const k = (size - 20) / Math.max(x1 - x0, y1 - y0);
  const px = (x: number) => (size / 2 + (x - (x0 + x1) / 2) * k).toFixed(2);
  const py = (y: number) => (size / 2 - (y - (y0 + y1) / 2) * k).toFixed(2);
  const flights = new Map<number, string[]>();
  const dots = new Map<number, string[]>();
  const last = new Map<number, ArrayLike<number>>();
  if (trace.rows <= MOST) for (const [slot, s] of trace.starts) last.set(slot, [0, s[0], s[1], s[2], s[3]]);
  for (const block of trace.blocks(MOST)) {
    for (let at = 0; at < block.length; at += FRAME_ROW) {
      const slot = block[at];
      const row = block.slice(at + 1, at + FRAME_ROW);
      const from = last.get(slot);
      last.set(slot, row);
      if (from) {
        let d = `M${px(from[1])} ${py(from[2])}`;
        if (row[8] === 0) d += `L${px(row[1])} ${py(row[2])}`;
        else {
          const a = arc(from, row[1], row[2], row[8]);
          const r = (a.r * k).toFixed(2);
          d += `A${r} ${r} 0 ${Math.abs(a.turn) > Math.PI ? 1 : 0} ${a.turn > 0 ? 0 : 1} ${px(row[1])} ${py(row[2])}`;
        }
        push(flights, tint.index(slot), d);
      }
      const sx = (size + 40 + (row[6] / system.length) * (size - 60)).toFixed(2);
      const sy = (10 + (1 - row[7] / Math.hypot(row[3], row[4])) * (size - 20) / 2).toFixed(2);
      push(dots, tint.index(slot), `M${sx} ${sy}h.01`);
    }
  }
  const walls = system.walls.filter((wall) => !wall.hole && wall.points.length > 0).map((wall) => {
    const points = Array.from({ length: wall.points.length / 2 }, (_, i) => `${px(wall.points[2 * i])} ${py(wall.points[2 * i + 1])}`);
    const dashes = wall.passed ? ' stroke-width=".8" stroke-dasharray="6 3"' : "";
    return `<path${dashes} d="M${points.join("L")}${wall.closed ? "Z" : ""}"/>`;
  });
  const paths = (map: Map<number, string[]>, extra: string) =>
    [...map].map(([c, d]) => `<path stroke="${tint.inks[c]}" ${extra} d="${d.join("")}"/>`).join("\n");
  const text = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${2 * size} ${size}" fill="none" stroke-linecap="round">
<title>${escaped(system.title)}</title>
<rect width="100%" height="100%" fill="${colours.paper}"/>
<g stroke-width=".7" stroke-opacity=".5">${paths(flights, "")}</g>
<g stroke="${colours.ink}" stroke-width="1.5">${walls.join("")}</g>
<g stroke-width="1.6">${paths(dots, "")}</g>
<path stroke="${colours.rule}" d="M${size + 40} 10V${size - 10}H${2 * size - 20}V10Z"/>
</svg>
`;
  return new Blob([text], { type: "image/svg+xml" });
}

export function png(table: Table, section: Section): Promise<Blob> {
  const [width, height] = table.size;
  const [other, tall] = section.pixels;
  const canvas = document.createElement("canvas");
  canvas.width = width + other;
  canvas.height = Math.max(height, tall);
  const g = canvas.getContext("2d")!;
  g.fillStyle = ink().paper;
  g.fillRect(0, 0, canvas.width, canvas.height);
  table.picture(g);
  section.picture(g, width);
  return new Promise((resolve) => canvas.toBlob((blob) => resolve(blob!), "image/png"));
}

function push(map: Map<number, string[]>, key: number, value: string): void {
  const list = map.get(key);
  if (list) list.push(value);
  else map.set(key, [value]);
}

function escaped(text: string): string {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;");
}
