// The page: its parts and how they meet.
import { Client } from "./client";
import { EngineError } from "./engine";
import { Editor } from "./editor";
import { csv, png, svg } from "./exports";
import { findHandles, pulled } from "./handles";
import { Motion } from "./motion";
import { Numbers } from "./numbers";
import { Picker, type Builtin } from "./picker";
import type { Start, System } from "./protocol";
import { Section } from "./section";
import { fragment, read, type Shared } from "./share";
import { rounded, Sliders } from "./sliders";
import { Table } from "./table";
import { Tint } from "./tint";
import { Trace } from "./trace";
import { byId, copy, count, make, plain, save } from "./words";

const FIRST = "stadium";

const trace = new Trace();
const tint = new Tint();
let byExponent = false; // is what the reader asks for; a system may refuse it
const client = new Client();
let helper: Client | undefined; // for pictures of systems and for handles
let system: System | undefined;
let builtin: string | undefined; // the one that was picked last
let original = ""; // its text
let name: string | undefined; // its name while the text is unchanged

const table = new Table(byId("table"), trace, tint, {
  start: (position, [x, y]) => start({ position, velocity: motion.velocity(x, y) }),
  pull: (handle, x, y) => {
    const span = Math.abs(handle.value) || 1;
    editor.setValue(handle.key.line, handle.key.key, rounded(pulled(handle, x, y), span));
  },
});
const section = new Section(byId("section"), trace, tint, (s, v) => start({ s, v }));
const motion = new Motion(client, trace, table, section, tint, { say, state, paced, tinted });
const numbers = new Numbers(byId("numbers"));
const editor = new Editor(byId("editor"), () => edited(120));
const sliders = new Sliders(byId("sliders"), (key, value) => editor.setValue(key.line, key.key, value));

function say(text: string): void {
  byId("say").textContent = text;
}

function state(text: string): void {
  byId("state-text").textContent = text;
  byId("run").hidden = !motion.command("");
}

function paced(): void {
  const speed = byId<HTMLInputElement>("speed");
  motion.hitsPerSecond = 10 ** Number(speed.value);
  byId("speed-text").textContent = motion.speedText;
  speed.setAttribute("aria-valuetext", motion.speedText);
}

/** The choice of colours, and their scale or why there is none. */
function tinted(): void {
  const choice = byId<HTMLSelectElement>("colour");
  const refused = system?.no_rates ?? "";
  choice.value = tint.by;
  choice.disabled = refused !== "";
  const place = byId("scale");
  if (tint.by === "exponent") {
    const ramp = make("span", { class: "ramp" });
    ramp.style.background = `linear-gradient(to right, ${tint.inks.join()})`;
    place.replaceChildren("0", ramp, `${plain(tint.top)} / time`);
    place.title = "The rate at which a deviation from the orbit has grown since its start: ln of its length, over the time";
  } else {
    place.textContent = refused && `no exponents: ${refused}`;
    place.title = "";
  }
}

function colourBy(): void {
  tint.by = byExponent && !system?.no_rates ? "exponent" : "orbit";
  tint.recolour();
  tinted();
}

function helping(): Client {
  return (helper ??= new Client());
}

async function start(from: Start, fresh = false): Promise<void> {
  if (!system) return;
  await motion.start(system, from, fresh);
  remember();
}

// The text of the system: loaded while it is typed, one load at a time.
let timer = 0;
let loading = false;
let again = false;

function edited(wait: number): void {
  clearTimeout(timer);
  timer = window.setTimeout(() => void load(false), wait);
}

async function load(fresh: boolean, from?: Start): Promise<boolean> {
  if (loading) {
    again = true;
    return false;
  }
  loading = true;
  const text = editor.text;
  let good = false;
  try {
    const loaded: System = await client.call({ do: "load", toml: text, ...(text === original && builtin ? { name: builtin } : {}) });
    const old = system;
    system = loaded;
    name = text === original ? builtin : undefined;
    shown(loaded, fresh);
    await motion.change(loaded, from, fresh);
    if (old) void client.call({ do: "unload", system: old.system }).catch(() => undefined);
    good = true;
  } catch (error) {
    failed(error as Error);
  }
  loading = false;
  if (again) {
    again = false;
    return load(fresh);
  }
  if (good) settle(text, fresh ? 250 : 500);
  return good;
}

function shown(loaded: System, fresh: boolean): void {
  byId("error").textContent = "";
  editor.mark();
  byId("title").textContent = loaded.title || name || "a system of your own";
  document.title = `${loaded.title || name || "Carom"} · Carom`;
  sliders.show(loaded.keys.filter((key) => key.section !== "run"), fresh);
  document.querySelector("main")!.classList.toggle("no-walls", loaded.walls.length === 0);
  trace.clear();
  colourBy();
  numbers.stop();
  table.show(loaded);
  section.show(loaded);
}

let broken: Error | undefined;

function failed(error: Error): void {
  broken = error;
  const place = error instanceof EngineError ? { line: error.line, column: error.column } : {};
  byId("error").textContent = error.message;
  editor.mark({ text: error.message, ...place });
}

/** What costs more, when the text has not changed for a while: numbers, handles, the link. */
let settling = 0;
function settle(text: string, wait: number): void {
  clearTimeout(settling);
  settling = window.setTimeout(() => {
    const now = system!;
    remember();
    numbers.show(text, now).catch(failed);
    void findHandles(helping(), text, now).then((handles) => {
      if (now === system) table.showHandles(handles);
    });
  }, wait);
}

async function shared(): Promise<string> {
  const held: Shared = { ...(name ? { name } : { toml: editor.text }), start: motion.from, particles: motion.particles, byExponent };
  return fragment(held);
}

function remember(): void {
  void shared().then((hash) => {
    // In a frame of a notebook the page has no address of its own.
    if (hash !== location.hash && location.protocol !== "about:") history.replaceState(null, "", hash);
  });
}

async function pick(wanted: string, from?: Start): Promise<void> {
  const { toml } = await client.call({ do: "toml", name: wanted });
  builtin = wanted;
  original = toml;
  editor.text = toml;
  clearTimeout(timer);
  await load(true, from);
}

async function open(): Promise<void> {
  let held: Shared = {};
  let damage: Error | undefined;
  try {
    held = await read(location.hash);
  } catch {
    damage = new Error("The link is damaged; this is the first system.");
  }
  if (held.particles) setParticles(held.particles);
  byExponent = held.byExponent ?? false;
  if (held.toml !== undefined) {
    editor.text = held.toml;
    clearTimeout(timer);
    if (await load(true, held.start)) return;
    if (system) return;
    // The text is kept, with its error; a system flies meanwhile.
    const { toml } = await client.call({ do: "toml", name: FIRST });
    system = await client.call({ do: "load", toml });
    shown(system!, true);
    sliders.show([], true);
    failed(broken!);
    await motion.change(system!, undefined, true);
    return;
  }
  try {
    await pick(held.name ?? FIRST, held.start);
    if (damage) failed(damage);
  } catch (error) {
    await pick(FIRST);
    failed(error as Error);
  }
}

function setParticles(n: number): void {
  motion.particles = Math.max(1, Math.min(10000, Math.round(n)));
  byId<HTMLInputElement>("particles").value = String(Math.log10(motion.particles));
  byId("particles-text").textContent = count(motion.particles);
}

function controls(): void {
  const play = byId<HTMLButtonElement>("play");
  const playing = (on: boolean) => {
    motion.playing = on;
    play.textContent = on ? "pause" : "play";
    play.setAttribute("aria-pressed", String(on));
    if (!on) say(`Paused. ${byId("state-text").textContent}`);
  };
  play.addEventListener("click", () => playing(!motion.playing));
  const speed = byId<HTMLInputElement>("speed");
  speed.addEventListener("input", paced);
  const particles = byId<HTMLInputElement>("particles");
  particles.addEventListener("input", () => {
    setParticles(10 ** Number(particles.value));
    particles.setAttribute("aria-valuetext", String(motion.particles));
    void start(motion.from, true);
  });
  byId<HTMLSelectElement>("colour").addEventListener("change", (event) => {
    byExponent = (event.target as HTMLSelectElement).value === "exponent";
    colourBy();
    if (system) void motion.change(system, undefined, false).then(remember);
  });
  byId("again").addEventListener("click", () => void start(motion.nextOfFile(), motion.particles > 1));
  byId("clear").addEventListener("click", () => motion.clear());
  byId("run").addEventListener("click", () => {
    const command = motion.command(name ?? "SYSTEM.toml");
    if (command) void copy(command, byId<HTMLButtonElement>("run"));
  });
  byId("pick").addEventListener("click", () => picker?.open());
  byId("link").addEventListener("click", async () => {
    history.replaceState(null, "", await shared());
    void copy(location.href, byId<HTMLButtonElement>("link"));
  });
  const theme = byId<HTMLButtonElement>("theme");
  const scheme = matchMedia("(prefers-color-scheme: dark)");
  const paint = (dark: boolean) => {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    theme.textContent = dark ? "light" : "dark";
    colourBy();
    table.recolour();
    section.recolour();
    numbers.recolour();
  };
  paint(scheme.matches);
  scheme.addEventListener("change", () => paint(scheme.matches));
  theme.addEventListener("click", () => paint(document.documentElement.dataset.theme !== "dark"));
  for (const button of document.querySelectorAll<HTMLButtonElement>("[data-save]")) {
    button.addEventListener("click", async () => {
      const kind = button.dataset.save!;
      const stem = name ?? "system";
      if (!system) return;
      if (kind === "toml") save(`${stem}.toml`, new Blob([editor.text], { type: "application/toml" }));
      if (kind === "csv") save(`${stem}.csv`, csv(trace, system));
      if (kind === "svg") save(`${stem}.svg`, svg(trace, system, tint));
      if (kind === "png") save(`${stem}.png`, await png(table, section));
    });
  }
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (event.key === " " && !target.closest("button, input, .cm-editor, dialog")) {
      event.preventDefault();
      playing(!motion.playing);
    }
  });
  window.addEventListener("hashchange", () => void open());
}

let picker: Picker | undefined;

async function main(): Promise<void> {
  controls();
  await open();
  const { systems } = await client.call({ do: "systems" }) as { systems: Builtin[] };
  picker = new Picker(byId<HTMLDialogElement>("systems"), byId("system-list"), systems, helping, (wanted) => {
    motion.from = { seed: 1, trajectory: 0 };
    void pick(wanted);
  });
  const { version } = await client.call({ do: "version" });
  byId("version").textContent = `Carom ${version}.`;
}

void main().catch(failed);
