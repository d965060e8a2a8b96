// The one place of the page that touches the text of a system file: the value of a key on a line.

/** From and to of the value of a key on a line of text. */
export function valueRange(line: string, key: string): [number, number] | undefined {
  const name = key.replace(/[^A-Za-z0-9_]/g, "\\$&");
  const found = new RegExp(`(?:^|[{,\\s.])${name}\\s*=\\s*("[^"]*"|'[^']*'|[^,}#\\s]+)`).exec(line);
  return found ? [found.index + found[0].length - found[1].length, found.index + found[0].length] : undefined;
}

/** The text with another value of a key; lines count from 1. */
export function withValue(text: string, line: number, key: string, value: string): string | undefined {
  const lines = text.split("\n");
  const range = line >= 1 && line <= lines.length ? valueRange(lines[line - 1], key) : undefined;
  if (!range) return undefined;
  lines[line - 1] = lines[line - 1].slice(0, range[0]) + value + lines[line - 1].slice(range[1]);
  return lines.join("\n");
}
