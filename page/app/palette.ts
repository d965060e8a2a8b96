// Colours: the page's own, from its style sheet, and those of orbits.

const onLight = ["#b3372a", "#1f5f8b", "#3f7d3a", "#8a5a00", "#6b4a9c", "#00787a", "#a03a72", "#555e68"];
const onDark = ["#ff8a73", "#7cbcf0", "#8fd08a", "#e5b95c", "#bda3f0", "#5fd0cf", "#ee9cc4", "#b4bec9"];

export interface Ink {
  ink: string;
  soft: string;
  rule: string;
  paper: string;
  accent: string;
  font: string;
  orbits: string[];
  dark: boolean;
}

export function ink(): Ink {
  const style = getComputedStyle(document.documentElement);
  const dark = style.getPropertyValue("--scheme").trim() === "dark";
  const colour = (name: string) => style.getPropertyValue(name).trim();
  return {
    ink: colour("--ink"),
    soft: colour("--soft"),
    rule: colour("--rule"),
    paper: colour("--paper"),
    accent: colour("--accent"),
    font: getComputedStyle(document.body).fontFamily,
    orbits: dark ? onDark : onLight,
    dark,
  };
}

/** From violet to yellow green in steps that look equal, lighter all the way: circles of hue in Ottosson's space OKLab. */
export function scale(dark: boolean, steps: number): string[] {
  const [low, high] = dark ? [0.52, 0.92] : [0.3, 0.8];
  return Array.from({ length: steps }, (_, i) => {
    const share = i / (steps - 1);
    const light = low + (high - low) * share;
    const hue = ((300 - 185 * share) * Math.PI) / 180;
    const [a, b] = [0.15 * Math.cos(hue), 0.15 * Math.sin(hue)];
    const l = (light + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (light - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (light - 0.0894841775 * a - 1.291485548 * b) ** 3;
    const linear = [
      4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
      -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
      -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
    return `#${linear.map((x) => {
      const shown = x < 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
      return Math.round(255 * Math.max(0, Math.min(1, shown))).toString(16).padStart(2, "0");
    }).join("")}`;
  });
}

/** 0xAABBGGRR, as image data takes it. */
export function packed(colour: string, alpha: number): number {
  const n = parseInt(colour.slice(1), 16);
  return (((alpha * 255) << 24) | ((n & 255) << 16) | (n & 0xff00) | (n >> 16)) >>> 0;
}
