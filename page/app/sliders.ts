// A slider for each number of the system file, with the number itself beside it.
import type { Key } from "./protocol";
import { make, plain } from "./words";

interface Row {
  key: Key;
  range: HTMLInputElement;
  number: HTMLInputElement;
  low: number;
  high: number;
}

export class Sliders {
  private rows = new Map<string, Row>();

  constructor(private readonly place: HTMLElement, private readonly changed: (key: Key, value: string) => void) {}

  /** Keeps the rows (and their ranges) that are there already, so that a slider can be moved on. */
  show(keys: Key[], fresh: boolean): void {
    const rows = new Map<string, Row>();
    for (const key of keys) {
      const name = `${key.section}.${key.key}.${keys.filter((k) => k.section === key.section && k.key === key.key).indexOf(key)}`;
      const old = fresh ? undefined : this.rows.get(name);
      const row = old ?? this.row(key);
      row.key = key;
      const value = Number(key.value);
      if (value < row.low || value > row.high) [row.low, row.high] = ends(value);
      [row.range.min, row.range.max] = [String(row.low), String(row.high)];
      row.range.step = whole(key) ? "1" : "any";
      if (document.activeElement !== row.range) row.range.value = String(value);
      if (document.activeElement !== row.number) row.number.value = plain(value, 6).replace("\u2212", "-");
      rows.set(name, row);
    }
    this.rows = rows;
    const wanted = [...rows.values()].map((row) => row.range.parentElement!);
    if (wanted.length !== this.place.children.length || wanted.some((e, i) => e !== this.place.children[i])) {
      this.place.replaceChildren(...wanted);
    }
  }

  private row(key: Key): Row {
    const name = key.key.replace(/_/g, " ");
    const range = make("input", { type: "range" });
    const number = make("input", { type: "text", inputMode: "decimal", autocomplete: "off" });
    range.setAttribute("aria-label", `${key.section} ${name}`);
    number.setAttribute("aria-label", `${key.section} ${name}, value`);
    const label = make("span", { title: key.meaning, textContent: name });
    make("div", { class: "slider" }, label, range, number);
    const [low, high] = ends(Number(key.value));
    const row: Row = { key, range, number, low, high };
    range.addEventListener("input", () => {
      const value = whole(row.key) ? range.value : rounded(Number(range.value), row.high - row.low);
      number.value = value;
      this.changed(row.key, value);
    });
    number.addEventListener("change", () => {
      const text = number.value.trim();
      this.changed(row.key, /^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(text) ? text : JSON.stringify(text));
    });
    return row;
  }
}

function whole(key: Key): boolean {
  return /whole|integer/.test(key.type);
}

/** A range about a value: to its double, and over zero only where the value does so. */
function ends(value: number): [number, number] {
  if (!value || !isFinite(value)) return [-1, 1];
  return value > 0 ? [0, 2 * value] : [2 * value, -2 * value];
}

/** As many digits as a slider can show. */
export function rounded(value: number, span: number): string {
  const digits = Math.max(0, Math.ceil(2 - Math.log10(span)));
  return String(Number(value.toFixed(Math.min(digits, 15))));
}
