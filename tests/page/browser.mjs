// What the tests of the page share: the browser, the page's file, and a word where something is missing.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const source = resolve(dirname(fileURLToPath(import.meta.url)), "../..");

export const page = resolve(process.env.CAROM_PAGE ?? resolve(source, "build/page/carom.html"));
export const program = process.env.CAROM_PROGRAM ?? resolve(source, "build/release/carom");

/** ctest counts this exit status as skipped. */
export function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}

export async function launch() {
  if (!existsSync(page)) skip(`no page at ${page} (./dev page makes it)`);
  const chromium = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find((path) => existsSync(path));
  if (!chromium) skip("no chromium (apt-get install chromium)");
  let playwright;
  try {
    playwright = createRequire(resolve(source, "page/package.json"))("playwright-core");
  } catch {
    skip("no playwright-core (npm ci in page/)");
  }
  return playwright.chromium.launch({ executablePath: chromium, args: ["--no-sandbox"] });
}
