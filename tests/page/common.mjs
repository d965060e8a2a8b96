// What the tests of the page's engine share: the engine in Node, and the program beside it.
import { execFile } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { promisify } from "node:util";

const [program, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const skipped = 77;

const wasm = path.join(folder, "carom.wasm");
if (!existsSync(wasm)) {
  console.log(`skipped: there is no ${wasm}; ./dev page makes it`);
  process.exit(skipped);
}
const { default: createCarom } = await import(pathToFileURL(path.join(folder, "carom.mjs")));
const module = await createCarom({ wasmBinary: readFileSync(wasm) });

/** An answer of the engine, or {error, line, column}. */
export function call(request) {
  const text = new TextEncoder().encode(`${JSON.stringify(request)}\0`);
  const asked = module._malloc(text.length);
  module.HEAPU8.set(text, asked);
  const answer = module._carom_call(asked);
  module._free(asked);
  const end = module.HEAPU8.indexOf(0, answer);
  const result = JSON.parse(new TextDecoder().decode(module.HEAPU8.subarray(answer, end)));
  module._carom_free(answer);
  return result;
}

/** Rows of nine numbers: at most n further hits. */
export function step(orbit, n) {
  const out = module._malloc(72 * n);
  const written = module._carom_step(orbit, n, out);
  const rows = [];
  for (let i = 0; i < written; ++i) rows.push([...module.HEAPF64.subarray(out / 8 + 9 * i, out / 8 + 9 * (i + 1))]);
  module._free(out);
  return rows;
}

/** x, y, vx, vy of orbits at time t. */
export function places(orbits, t) {
  const ids = module._malloc(4 * orbits.length), out = module._malloc(32 * orbits.length);
  module.HEAPU8.set(new Uint8Array(Int32Array.from(orbits).buffer), ids);
  module._carom_places(ids, orbits.length, t, out);
  const all = [...module.HEAPF64.subarray(out / 8, out / 8 + 4 * orbits.length)];
  module._free(ids);
  module._free(out);
  return all;
}

/** How fast deviations of orbits have grown until time t. */
export function rates(orbits, t) {
  const ids = module._malloc(4 * orbits.length), out = module._malloc(8 * orbits.length);
  module.HEAPU8.set(new Uint8Array(Int32Array.from(orbits).buffer), ids);
  module._carom_rates(ids, orbits.length, t, out);
  const all = [...module.HEAPF64.subarray(out / 8, out / 8 + orbits.length)];
  module._free(ids);
  module._free(out);
  return all;
}
export const bytes = () => module.HEAPU8.length;

/** What the program prints: {out, error}. */
export async function carom(args, options = {}) {
  const run = promisify(execFile)(program, args, { maxBuffer: 1 << 28, ...options });
  try {
    const { stdout } = await run;
    return { out: stdout };
  } catch (failure) {
    return { out: failure.stdout, error: failure.stderr };
  }
}

let failures = 0, checks = 0;
export function expect(right, what) {
  ++checks;
  if (right) return;
  ++failures;
  console.error(`wrong: ${what}`);
}
export function finish(what) {
  console.log(`${what}: ${checks} checks, ${failures} failed`);
  process.exit(failures ? 1 : 0);
}

/** Calls an asynchronous function for each element, two at a time. */
export async function each(list, how) {
  const rest = [...list];
  const worker = async () => {
    while (rest.length) await how(rest.shift());
  };
  await Promise.all([worker(), worker()]);
}
