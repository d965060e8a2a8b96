// Handles on the walls: for each number of the table, the point of the walls that moves the most when it changes.
// The engine says where the walls go: the system is loaded once more with the number a little larger.
import type { Client } from "./client";
import type { Key, System } from "./protocol";
import { withValue } from "./toml";

export interface Handle {
  key: Key;
  value: number;
  x: number;
  y: number;
  /** How the point moves for a unit of the value. */
  dx: number;
  dy: number;
}

export async function findHandles(client: Client, text: string, system: System): Promise<Handle[]> {
  const handles: Handle[] = [];
  for (const key of system.keys) {
    const value = Number(key.value);
    if (!key.section.startsWith("table") || !isFinite(value) || value === 0) continue;
    const larger = 1.02 * value;
    const changed = withValue(text, key.line, key.key, String(larger));
    if (!changed) continue;
    try {
      const other: System = await client.call({ do: "load", toml: changed });
      await client.call({ do: "unload", system: other.system });
      const size = Math.hypot(system.box[2] - system.box[0], system.box[3] - system.box[1]);
      const found = farthest(system, other, (x, y) => handles.every((h) => Math.hypot(h.x - x, h.y - y) > 0.03 * size));
      if (!found) continue;
      const by = larger - value;
      handles.push({ key, value, x: found.x, y: found.y, dx: found.dx / by, dy: found.dy / by });
    } catch {
      // A larger value is refused: no handle.
    }
  }
  return handles;
}

/** Of the points that move at least half as far as any, the farthest that is free. */
function farthest(a: System, b: System, free: (x: number, y: number) => boolean): { x: number; y: number; dx: number; dy: number } | undefined {
  let best;
  let reach = 0;
  let all = 0;
  for (let w = 0; w < a.walls.length; ++w) {
    const [from, to] = [a.walls[w].points, b.walls[w]?.points];
    if (from.length !== to?.length) return undefined;
    for (let i = 0; i < from.length; i += 2) {
      const [dx, dy] = [to[i] - from[i], to[i + 1] - from[i + 1]];
      const moved = Math.hypot(dx, dy);
      all = Math.max(all, moved);
      if (moved > reach * (1 + 1e-9) && free(from[i], from[i + 1])) {
        reach = moved;
        best = { x: from[i], y: from[i + 1], dx, dy };
      }
    }
  }
  return reach > 0.5 * all ? best : undefined;
}

/** The value that brings a handle's point nearest to a place. */
export function pulled(handle: Handle, x: number, y: number): number {
  const along = (x - handle.x) * handle.dx + (y - handle.y) * handle.dy;
  return handle.value + along / (handle.dx * handle.dx + handle.dy * handle.dy);
}
