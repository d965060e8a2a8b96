// The curve of a flight between two hits, for drawing: a line, or an arc whose curvature the engine gave.

export interface Arc {
  x: number;
  y: number;
  r: number;
  /** Angle of the start, and the turn: positive is anticlockwise. */
  from: number;
  turn: number;
}

/** The arc from a state (t, x, y, vx, vy) to a point, with this curvature (positive to the left). */
export function arc(from: ArrayLike<number>, x: number, y: number, curvature: number): Arc {
  const [vx, vy] = [from[3], from[4]];
  const speed = Math.hypot(vx, vy);
  const cx = from[1] - vy / (speed * curvature);
  const cy = from[2] + vx / (speed * curvature);
  const [dx, dy] = [x - from[1], y - from[2]];
  // The chord lies half the turn off the velocity.
  let half = Math.atan2(vx * dy - vy * dx, vx * dx + vy * dy);
  if (half * curvature < 0) half += Math.sign(curvature) * Math.PI;
  return { x: cx, y: cy, r: 1 / Math.abs(curvature), from: Math.atan2(from[2] - cy, from[1] - cx), turn: 2 * half };
}

/** Where the particle is on its flight after a time dt. */
export function along(x: number, y: number, vx: number, vy: number, dt: number, curvature: number): [number, number] {
  const half = (Math.hypot(vx, vy) * dt * curvature) / 2;
  if (Math.abs(half) < 1e-9) return [x + vx * dt, y + vy * dt];
  const chord = (dt * Math.sin(half)) / half;
  return [x + chord * (vx * Math.cos(half) - vy * Math.sin(half)), y + chord * (vx * Math.sin(half) + vy * Math.cos(half))];
}
