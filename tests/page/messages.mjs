// System files that the program refuses, the page refuses with the same text: node messages.mjs PROGRAM FOLDER.
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { call, carom, each, expect, finish } from "./common.mjs";

// Each breaks one line "key = value" of a file, or the whole text.
const faults = [
  (line, key) => line.replace(key, `${key}s`),
  (line, key) => line.replace(key, key.slice(1) || "q"),
  (line) => line.replace(/=.*/, "= \"nonsense\""),
  (line) => line.replace(/=.*/, "= -1"),
  (line) => line.replace(/=.*/, "= [1, 2"),
  (line) => line.replace(/=.*/, "= true"),
  (line) => line.replace(/=.*/, "= 0"),
  (line) => line.replace(/=.*/, "= \"1/0\""),
  (line) => line.replace(/=.*/, "= 1e400"),
  (line) => line.replace("=", ""),
  (line) => line.replace(/=.*/, "= [[[]]]"),
  (line) => `${line}\n${line}`,
];

const { systems } = call({ do: "systems" });
const broken = [];
for (const { name } of systems) {
  const lines = call({ do: "toml", name }).toml.split("\n");
  lines.forEach((line, i) => {
    const key = /^\s*([a-z_A-Z]+)\s*=/.exec(line)?.[1];
    if (!key) return;
    const fault = faults[(broken.length + i) % faults.length];
    broken.push([...lines.slice(0, i), fault(line, key), ...lines.slice(i + 1)].join("\n"));
  });
}

let refused = 0;
await each(broken.entries(), async ([number, text]) => {
  const answer = call({ do: "load", toml: text });
  if (!answer.error) return call({ do: "unload", system: answer.system });
  if (++refused > 120) return;
  const folder = mkdtempSync(path.join(tmpdir(), "carom-page-"));
  writeFileSync(path.join(folder, "SYSTEM.toml"), text);
  const { error } = await carom(["table", "SYSTEM.toml", "--quiet"], { cwd: folder });
  rmSync(folder, { recursive: true });
  const flat = (words) => (words ?? "").replace(/\s+/g, " ").trim();
  expect(flat(error) === flat(`carom: ${answer.error}`), `${number}: ${answer.error}\n    ${error}`);
  const place = /^SYSTEM\.toml, line (\d+)(?:, column (\d+))?/.exec(answer.error);
  expect((place?.[1] ?? 0) == (answer.line ?? 0) && (place?.[2] ?? 0) == (answer.column ?? 0), `${number}: place of ${answer.error}`);
});
const file = call({ do: "load", toml: '[table]\nshape = "polygon"\npath = "corners.txt"\n' });
expect(file.line === 3 && /reads no files/.test(file.error), `a file: ${file.error}`);
expect(refused >= 100, `only ${refused} of ${broken.length} are refused`);
finish("messages");
