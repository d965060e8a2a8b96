// Colours: the page's own, from its style sheet, and those of orbits.

const light = ["#b3372a", "#1f5f8b", "#3f7d3a", "#8a5a00", "#6b4a9c", "#00787a", "#a03a72", "#555e68"];
const dark = ["#ff8a73", "#7cbcf0", "#8fd08a", "#e5b95c", "#bda3f0", "#5fd0cf", "#ee9cc4", "#b4bec9"];

export interface Ink {
  ink: string;
  soft: string;
  rule: string;
  paper: string;
  accent: string;
  font: string;
  orbits: string[];
}

export function ink(): Ink {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  return {
    ink: colour("--ink"),
    soft: colour("--soft"),
    rule: colour("--rule"),
    paper: colour("--paper"),
    accent: colour("--accent"),
    font: getComputedStyle(document.body).fontFamily,
    orbits: colour("--scheme") === "dark" ? dark : light,
  };
}

/** 0xAABBGGRR, as image data takes it. */
export function packed(colour: string, alpha: number): number {
  const n = parseInt(colour.slice(1), 16);
  return (((alpha * 255) << 24) | ((n & 255) << 16) | (n & 0xff00) | (n >> 16)) >>> 0;
}
