// What the page and its workers say to each other, and the objects of the engine's answers.

export type Start =
  | { position: [number, number]; velocity: [number, number] }
  | { s: number; v: number }
  | { seed: number; trajectory: number };

/** At most so many orbits are followed by how far they can be trusted. */
export const TRUSTED = 8;

export interface Wall {
  name: string;
  /** None where the other side of an edge has them. */
  points: number[];
  closed: boolean;
  hole: boolean;
  /** Particles go through: the edge of a region, or a hole. */
  passed: boolean;
  length: number;
  offset: number;
}

/** A number of the file that a slider can change. */
export interface Key {
  section: string;
  key: string;
  value: number;
  /** number, whole number, angle, ... */
  type: string;
  meaning: string;
  line: number;
}

export interface System {
  system: number;
  title: string;
  keys: Key[];
  walls: Wall[];
  box: [number, number, number, number];
  lattice: [number, number, number, number] | null;
  length: number;
  /** Forces act: the paths are neither lines nor arcs. */
  potential: boolean;
  field: number;
  particles: number;
  /** Why orbits have no exponents; "" where they have. */
  no_rates: string;
}

export type Request =
  | { do: "call"; request: object }
  | { do: "begin"; system: number; forces: boolean; walls: boolean; starts: Start[]; slots: number[]; keep: boolean; rates: boolean }
  /** Under forces paths are drawn through places this far apart in time. */
  | { do: "grain"; grain: number }
  | { do: "frame"; t: number; budget: number }
  | { do: "decisions" }
  | { do: "trust" };

/** How far the doubles of an orbit can be trusted: its first hits, until t. */
export interface Trust {
  slot: number;
  hits: number;
  t: number;
  /** Still, at its last hit. */
  open: boolean;
}

/** The answer to `begin`. */
export interface Begun {
  /** Why the engine refused starts. */
  refused: string[];
  /** x, y, vx, vy of each particle that was started, in the order of `slots`. */
  states: Float64Array;
  slots: number[];
  /** Mean time between hits of the first orbit; 0 where it has none. */
  pace: number;
}

/** Numbers of a row of a frame: the orbit's slot, then the hit. */
export const FRAME_ROW = 10;

/** The answer to `frame`. */
export interface Frame {
  /** The time that was reached: less than asked for where the budget was spent. */
  t: number;
  /** x, y for each orbit that still flies. */
  dots: Float64Array;
  slots: Uint32Array;
  /** Rows of FRAME_ROW: the hits since the last frame. */
  hits: Float64Array;
  /** Under forces, rows of three: slot, x, y along the paths. */
  trail: Float64Array;
  /** Now and then rows of two: slot, and how fast the orbit's deviations have grown. */
  rates: Float64Array;
  ended: { slot: number; why: string; t: number; x: number; y: number }[];
  flying: number;
  cost: number;
}

export type Answer = { id: number; result: unknown } | { id: number; error: string; line?: number; column?: number };
