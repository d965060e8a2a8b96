// Numbers as text, and small helpers for elements.

/** Round numbers between two ends, about `count` of them. */
export function ticks(from: number, to: number, count: number): { value: number; text: string }[] {
  const span = to - from;
  if (!(span > 0)) return [];
  const raw = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((m) => m * power >= raw) ?? 10);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let i = Math.ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; ++i) {
    found.push({ value: i * step, text: minus((i * step).toFixed(Math.min(digits, 12))) });
  }
  return found;
}

export function minus(text: string): string {
  return text.replace(/^-(?=[\d.])/, "\u2212").replace(/^\u22120(\.0*)?$/, "0$1");
}

/** A value and its error with two digits of the error: 0.346(61)e-2 is written 0.00346 ± 0.00061. */
export function withError(value: number, error: number): string {
  if (!(error > 0) || !isFinite(error)) return plain(value);
  const digits = 1 - Math.floor(Math.log10(error));
  if (digits > 7 || digits < -3) return `${minus(value.toExponential(Math.max(1, Math.floor(Math.log10(Math.abs(value / error))) + 1)))} ± ${error.toExponential(1)}`;
  const places = Math.max(0, digits);
  return `${minus(value.toFixed(places))} ± ${error.toFixed(places)}`;
}

export function plain(value: number, digits = 4): string {
  return minus(String(Number(value.toPrecision(digits))));
}

/** 12 345 678 with thin spaces, as the program prints it. */
export function count(value: number): string {
  return String(value).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

export function byId<E extends HTMLElement = HTMLElement>(id: string): E {
  return document.getElementById(id) as E;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  set: Partial<HTMLElementTagNameMap[K]> & { class?: string } = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  const { class: name, ...rest } = set;
  if (name) element.className = name;
  Object.assign(element, rest);
  element.append(...children);
  return element;
}

/** Copies text; `button` says so for a moment. */
export async function copy(text: string, button: HTMLButtonElement): Promise<void> {
  const before = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = make("textarea", { value: text });
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  button.textContent = "copied";
  setTimeout(() => (button.textContent = before), 1200);
}

/** Offers a file for saving. */
export function save(name: string, data: Blob): void {
  const url = URL.createObjectURL(data);
  const link = make("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
