// The page's engine computes what the program computes: digests of analyses, single hits, commands that are shown.
// node engine.mjs PROGRAM FOLDER
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { execFileSync } from "node:child_process";
import { tmpdir } from "node:os";
import path from "node:path";
import { call, carom, each, expect, finish, places, rates, step } from "./common.mjs";

const folder = mkdtempSync(path.join(tmpdir(), "carom-page-"));
const { systems } = call({ do: "systems" });
const loaded = new Map(systems.map(({ name }) => [name, call({ do: "load", toml: call({ do: "toml", name }).toml })]));
expect(systems.length > 10, "there are built-in systems");

// Few trajectories for short times where every step is integrated.
const size = ({ potential }) => (potential ? { trajectories: 6, t_max: 4 } : { trajectories: 300, t_max: 60 });
const analyses = ["escape", "lyapunov", "diffusion", "section"];

/** A text without the ways in which lines are folded. */
const flat = (text) => text.replace(/\s+/g, " ").trim();

// Times, and what depends on lanes.
const notSame = ["seconds", "cpu_seconds", "command", "isa", "lanes", "decisions"];
/** Where two answers differ; "": nowhere. Fits are made with each machine's own functions. */
function difference(a, b) {
  if (typeof a === "number" && typeof b === "number") return Math.abs(a - b) <= 1e-9 * Math.abs(b) ? "" : `: ${a} is not ${b}`;
  if (typeof a !== "object" || typeof b !== "object" || !a || !b) return a === b ? "" : `: ${a} is not ${b}`;
  for (const key of new Set([...Object.keys(a), ...Object.keys(b)])) {
    const inner = difference(a[key], b[key]);
    if (inner) return `${key} ${inner}`;
  }
  return "";
}

async function compare(analysis, system, options, files = {}) {
  const answer = call({ do: "ensemble", analysis, system: system.system, options });
  if (answer.error) {
    const size = Object.entries(options).flatMap(([key, value]) => [`--${key.replace("_", "-")}`, String(value)]);
    const { error } = await carom([analysis, system.name, ...size, "--json", "--quiet"], files);
    expect(flat(error ?? "") === flat(`carom: ${answer.error}`), `${analysis} ${system.name}: ${answer.error} / ${error}`);
    return;
  }
  // The command as the page shows it, typed in a shell.
  const [, ...typed] = execFileSync("sh", ["-c", `printf '%s\\0' ${answer.command}`], { encoding: "utf8" }).split("\0");
  const { out } = await carom([...typed.slice(0, -1), "--json", "--quiet", "--threads", "1"], files);
  const printed = JSON.parse(out);
  expect(printed.digest === answer.digest, `${answer.command}: ${answer.digest} is not ${printed.digest}`);
  for (const key of notSame) delete printed[key], delete answer[key];
  const where = difference(answer, printed);
  expect(where === "", `${analysis} ${system.name}: another number, ${where}`);
}

await each([...loaded.values()].flatMap((system) => analyses.map((analysis) => [analysis, system])), ([analysis, system]) =>
  compare(analysis, system, analysis === "section" ? { orbits: 3, points: 40, t_max: size(system).t_max } : size(system)),
);

// Parts that several workers fly add up to the whole.
for (const [analysis, name] of [["escape", "three-disc"], ["diffusion", "lorentz-triangular"], ["lyapunov", "mushroom"], ["returns", "stadium"]]) {
  const on = analysis === "returns" ? { on: "wall:bottom", closed: true } : {};
  const ask = { do: "ensemble", analysis, system: loaded.get(name).system, options: { trajectories: 90, t_max: 40, ...on } };
  const whole = call(ask);
  const parts = [[50, 90], [0, 20], [20, 50]].map((part) => call({ ...ask, part }).part);
  const sum = call({ ...ask, parts });
  for (const key of ["seconds", "cpu_seconds"]) delete whole[key], delete sum[key];
  expect(whole.digest && JSON.stringify(sum) === JSON.stringify(whole), `parts of ${analysis}: ${difference(sum, whole)}`);
  expect(call({ ...ask, parts: parts.slice(1) }).error && call({ ...ask, parts: [...parts, parts[0]] }).error, `${analysis}: a part is missing, or twice there`);
}

// A system that was edited is a file for the program.
const text = call({ do: "toml", name: "stadium" }).toml.replace("half_length = 2", "half_length = 2.25");
const edited = call({ do: "load", toml: text });
writeFileSync(path.join(folder, "SYSTEM.toml"), text);
await compare("escape", edited, { trajectories: 200, seed: 7, closed: false }, { cwd: folder });
await compare("diffusion", edited, { trajectories: 40, t_max: 50, free_paths: true, closed: true }, { cwd: folder });
await compare("lyapunov", edited, { trajectories: 20, t_max: 50, closed: true, set: { "field.B": "0.1" } }, { cwd: folder });
expect(edited.keys.find((key) => key.key === "half_length").line === text.split("\n").findIndex((l) => l.includes("2.25")) + 1,
  "a key tells its line");

// 1000 hits, bit by bit: those that an archive stores.
const python = `
import h5py, struct, sys
hits = h5py.File(sys.argv[1])["collisions"]
first = hits["particle"][:] == 0
columns = [hits[name][:][first][:1000] for name in ("t", "x", "y", "vx", "vy", "wall", "s", "v_parallel")]
for row in zip(*columns): print(" ".join(struct.pack(">d", float(x)).hex() for x in row))
`;
const bits = (x) => {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, x);
  return view.getBigUint64(0).toString(16).padStart(16, "0");
};
let without = "";
await each(loaded.values(), async (system) => {
  const { name } = system;
  const file = path.join(folder, `${name}.h5`);
  const limit = system.potential ? ["--t-max", "20"] : ["--collisions", "1000"];
  const { error } = await carom(["run", name, "--closed", "--trajectory", "3", ...limit, "--quiet", "-o", file]);
  if (error) return expect(/hole/.test(error), `run ${name}: ${error}`);
  let stored;
  try {
    stored = execFileSync("/usr/bin/python3", ["-c", python, file], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
  } catch {
    without = "; no single hits, which python3-h5py would read";
    return;
  }
  const rows = stored.split("\n").filter(Boolean);
  const toml = call({ do: "toml", name }).toml.replace(/\[\[table\.hole\]\][^[]*/g, "");
  const closed = call({ do: "load", toml });
  const { orbit } = call({ do: "orbit", system: closed.system, start: { seed: closed.keys.find((k) => k.key === "seed")?.value ?? 1, trajectory: 3 } });
  const flown = [];
  while (flown.length < rows.length) {
    const more = step(orbit, Math.min(7, rows.length - flown.length));
    if (!more.length) break;
    flown.push(...more);
  }
  expect(flown.length === rows.length, `${name}: ${flown.length} hits of ${rows.length}`);
  const walls = closed.walls.filter((wall) => !wall.hole);
  const other = flown.findIndex((row, i) => {
    const [t, x, y, vx, vy, wall, s, v] = row, stored = rows[i].split(" ");
    const one = [t, x, y, vx, vy, wall, v].map(bits).join(" "), two = [0, 1, 2, 3, 4, 5, 7].map((k) => stored[k]).join(" ");
    const along = Buffer.from(stored[6], "hex").readDoubleBE(0) + walls[wall].offset;
    return one !== two || bits(s) !== bits(along);
  });
  expect(other < 0, `${name}: hit ${other} is ${flown[other]}`);
  call({ do: "unload", system: closed.system });
});

// Places do not depend on what was asked before.
for (const name of ["stadium", "magnetic-square", "lorentz-triangular", "henon-heiles"]) {
  const { system } = loaded.get(name);
  const start = { seed: 1, trajectory: 5 };
  const one = call({ do: "orbit", system, start }).orbit, two = call({ do: "orbit", system, start }).orbit;
  step(one, 20);
  const times = [0, 0.3, 2.5, 1.1];
  for (const t of times) expect(places([one], t).every((x, i) => x === places([two], t)[i]), `${name} at ${t}`);
  call({ do: "forget", orbit: one });
  expect(call({ do: "decisions", orbit: one }).error, `${name}: an orbit that was forgotten`);
}

// The arc of each flight leads from hit to hit, also where it enters or leaves a field.
loaded.set("half in a field", call({ do: "load", toml: `
[table]
shape = "polygon"
points = [[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [0, 2]]
[[table.region]]
start = [2, 2]
pieces = [{ line_to = [2, 0] }]
B = 3
[initial]
kind = "uniform"
` }));
for (const name of ["magnetic-square", "ellipse-magnetic", "stadium", "half in a field"]) {
  const { orbit } = call({ do: "orbit", system: loaded.get(name).system, start: { seed: 1, trajectory: 2 } });
  const rows = step(orbit, 30);
  for (let i = 1; i < rows.length; ++i) {
    const [a, b] = [rows[i - 1], rows[i]], curvature = b[8], path = Math.hypot(a[3], a[4]) * (b[0] - a[0]);
    const chord = curvature ? Math.abs((2 / curvature) * Math.sin((curvature * path) / 2)) : path;
    const cross = (a[3] * (b[2] - a[2]) - a[4] * (b[1] - a[1])) * curvature;
    expect(Math.abs(chord - Math.hypot(b[1] - a[1], b[2] - a[2])) < 1e-9, `${name}: the chord of flight ${i}`);
    expect(Math.abs(curvature * path) > 6.28 || cross >= 0, `${name}: the side of flight ${i}`);
  }
}

// Aimed at corners and along tangents, where integers decide.
for (const [name, position, velocity] of [["sinai", [0, 0], [1, 1]], ["stadium", [0.25, 0.5], [1, 0]], ["mushroom", [0, 0], [1, 1]], ["mushroom", [0.25, 0], [1, 0]]]) {
  const { system } = call({ do: "load", toml: call({ do: "toml", name }).toml.replace(/\[\[table\.hole\]\][^[]*/g, "") });
  const { orbit } = call({ do: "orbit", system, start: { position, velocity } });
  const rows = step(orbit, 40), { exact } = call({ do: "decisions", orbit }), { why } = call({ do: "ended", orbit });
  const { out } = await carom(["run", name, "--closed", "--position", position.join(), "--velocity", velocity.join(), "--set", "particles.speed=1", "--collisions", "40", "--json", "--quiet"]);
  const run = JSON.parse(out), [t, x, y] = rows.at(-1) ?? [run.t, run.x, run.y];
  expect(exact > 0 && rows.length === run.collisions && t === run.t && x === run.x && y === run.y, `${name}, aimed: ${rows.length} hits, ${exact} exact, ${t} is not ${run.t}`);
  expect(why === (run.status === "completed" ? "" : run.status), `${name}, aimed: ${why}`);
}

// The rates that colour orbits are those of the program: their mean over the first trajectories.
for (const [name, t, last] of [["sinai", 20, 1e-12], ["magnetic-square", 30, 1e-12], ["lorentz-triangular", 25, 1e-12], ["henon-heiles", 12, 1e-6]]) {
  const toml = call({ do: "toml", name }).toml.replace(/\[\[table\.hole\]\][^[]*/g, "");
  const { system, walls, no_rates } = call({ do: "load", toml });
  expect(no_rates === "", `${name}: ${no_rates}`);
  const all = Array.from({ length: 5 }, (_, trajectory) => {
    const start = { seed: 1, trajectory, rates: true };
    const ahead = call({ do: "orbit", system, start }).orbit, { orbit } = call({ do: "orbit", system, start });
    const before = walls.length ? step(ahead, 200).filter((row) => row[0] <= t).length : 0;
    if (before) step(orbit, before);
    return rates([orbit], t)[0];
  });
  const { out } = await carom(["lyapunov", name, "--closed", "--trajectories", "5", "--seed", "1", "--t-max", String(t), "--window", `0:${t}`, "--json", "--quiet"]);
  const { lambda: program } = JSON.parse(out).convergence.at(-1), mean = all.reduce((a, b) => a + b) / all.length;
  expect(Math.abs(mean - program) <= last * Math.abs(program), `rates of ${name}: ${mean} is not ${program}`);
}
{
  const toml = `${call({ do: "toml", name: "stadium" }).toml}\n[[table.wall]]\nwall = "bottom"\nlaw = "diffuse"\n`;
  const { no_rates } = call({ do: "load", toml });
  expect(/reflects at random/.test(no_rates), `no rates: ${no_rates}`);
}

// How far doubles can be trusted is what the program says.
{
  const toml = call({ do: "toml", name: "stadium" }).toml.replace(/\[\[table\.hole\]\][^[]*/g, "");
  const { system } = call({ do: "load", toml });
  const { orbit } = call({ do: "orbit", system, start: { seed: 1, trajectory: 3, trust: true } });
  step(orbit, 200);
  const { out } = await carom(["run", "stadium", "--closed", "--trajectory", "3", "--collisions", "200", "--json", "--quiet"]);
  const trust = call({ do: "trust", orbit }), run = JSON.parse(out);
  expect(trust.hits === run.trusted_collisions && trust.t === run.trusted_time && !trust.open, `trusted: ${JSON.stringify(trust)}`);
}

// A start on the boundary is where it was asked for.
{
  const { system, length } = loaded.get("stadium");
  const { orbit } = call({ do: "orbit", system, start: { s: 0.7 * length, v: -0.25 } });
  const [x, y, vx, vy] = places([orbit], 0);
  expect(Math.abs(Math.hypot(vx, vy) - 1) < 1e-12 && Math.abs(Math.hypot(Math.max(0, Math.abs(x) - 2), y) - 1) < 1e-12, `on the boundary: ${x} ${y}`);
  expect(call({ do: "orbit", system, start: { position: [9, 9], velocity: [1, 0] } }).error, "a start outside is refused");
}

rmSync(folder, { recursive: true });
finish(`engine${without}`);
