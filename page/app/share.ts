// The link that holds a system: its name, or its whole text compressed, in the fragment; and the start.
import type { Start } from "./protocol";

export interface Shared {
  name?: string;
  toml?: string;
  start?: Start;
  particles?: number;
  byExponent?: boolean;
}

const base64 = (bytes: Uint8Array) =>
  btoa(Array.from(bytes, (b) => String.fromCharCode(b)).join("")).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");

const bytes = (text: string) => Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (c) => c.charCodeAt(0));

async function through(data: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await new Response(new Blob([data]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function fragment(shared: Shared): Promise<string> {
  const parts = [];
  if (shared.toml !== undefined) {
    parts.push(`toml=${base64(await through(new TextEncoder().encode(shared.toml), new CompressionStream("deflate-raw")))}`);
  } else if (shared.name) {
    parts.push(`system=${shared.name}`);
  }
  const { start } = shared;
  if (start && "position" in start) parts.push(`from=${[...start.position, ...start.velocity].join(",")}`);
  if (start && "s" in start) parts.push(`section=${start.s},${start.v}`);
  if (start && "seed" in start && (start.seed !== 1 || start.trajectory !== 0)) parts.push(`trajectory=${start.seed},${start.trajectory}`);
  if (shared.particles && shared.particles !== 1) parts.push(`particles=${shared.particles}`);
  if (shared.byExponent) parts.push("colour=exponent");
  return `#${parts.join("&")}`;
}

export async function read(hash: string): Promise<Shared> {
  const parts = new Map(hash.replace(/^#/, "").split("&").map((part) => {
    const at = part.indexOf("=");
    return [part.slice(0, at), part.slice(at + 1)] as const;
  }));
  const shared: Shared = {};
  const numbers = (name: string, count: number) => {
    const found = parts.get(name)?.split(",").map(Number);
    return found && found.length === count && found.every(isFinite) ? found : undefined;
  };
  const from = numbers("from", 4);
  const section = numbers("section", 2);
  const trajectory = numbers("trajectory", 2);
  if (from) shared.start = { position: [from[0], from[1]], velocity: [from[2], from[3]] };
  else if (section) shared.start = { s: section[0], v: section[1] };
  else if (trajectory) shared.start = { seed: trajectory[0], trajectory: trajectory[1] };
  shared.particles = numbers("particles", 1)?.[0];
  shared.byExponent = parts.get("colour") === "exponent";
  shared.name = parts.get("system");
  const packed = parts.get("toml");
  if (packed) shared.toml = new TextDecoder().decode(await through(bytes(packed), new DecompressionStream("deflate-raw")));
  return shared;
}
