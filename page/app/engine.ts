// The compiled engine as TypeScript sees it. All physics is behind these calls; the page makes no number but pixels.

/** What emscripten's factory gives. */
interface Module {
  HEAPF64: Float64Array;
  HEAPU8: Uint8Array;
  _malloc(bytes: number): number;
  _free(address: number): void;
  _carom_call(text: number): number;
  _carom_free(text: number): void;
  _carom_step(orbit: number, rows: number, out: number): number;
  _carom_places(orbits: number, count: number, t: number, out: number): void;
  _carom_rates(orbits: number, count: number, t: number, out: number): void;
}

/** Numbers of a row of a hit: t, x, y, vx, vy, wall, s, v_parallel, curvature of the flight that led there. */
export const ROW = 9;

/** An error of the engine: the program's text, and where in the file it is. */
export class EngineError extends Error {
  constructor(text: string, readonly line?: number, readonly column?: number) {
    super(text);
  }
}

export class Engine {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder();
  private scratch = 0;
  private scratchBytes = 0;

  constructor(private readonly module: Module) {}

  call(request: object): any {
    const bytes = this.encoder.encode(JSON.stringify(request));
    const text = this.module._malloc(bytes.length + 1);
    this.module.HEAPU8.set(bytes, text);
    this.module.HEAPU8[text + bytes.length] = 0;
    const answer = this.module._carom_call(text);
    this.module._free(text);
    const heap = this.module.HEAPU8;
    const end = heap.indexOf(0, answer);
    const result = JSON.parse(this.decoder.decode(heap.subarray(answer, end)));
    this.module._carom_free(answer);
    if (result.error !== undefined) throw new EngineError(result.error, result.line, result.column);
    return result;
  }

  /** At most `rows` further hits of an orbit, nine numbers each; fewer when it ended. The view holds until the next call. */
  step(orbit: number, rows: number): Float64Array {
    const out = this.room(rows * ROW * 8);
    const written = this.module._carom_step(orbit, rows, out);
    return this.module.HEAPF64.subarray(out / 8, out / 8 + written * ROW);
  }

  /** x, y, vx, vy of each orbit at time t. The view holds until the next call. */
  places(orbits: Uint32Array, t: number): Float64Array {
    return this.ofEach(this.module._carom_places, 4, orbits, t);
  }

  /** How fast the deviations of each orbit have grown until t. The view holds until the next call. */
  rates(orbits: Uint32Array, t: number): Float64Array {
    return this.ofEach(this.module._carom_rates, 1, orbits, t);
  }

  private ofEach(ask: (ids: number, count: number, t: number, out: number) => void, numbers: number, orbits: Uint32Array, t: number): Float64Array {
    const count = orbits.length;
    const out = this.room(count * (8 * numbers + 4) + 8);
    const ids = out + count * 8 * numbers;
    this.module.HEAPU8.set(new Uint8Array(orbits.buffer, orbits.byteOffset, orbits.byteLength), ids);
    ask(ids, count, t, out);
    return this.module.HEAPF64.subarray(out / 8, out / 8 + count * numbers);
  }

  private room(bytes: number): number {
    if (bytes > this.scratchBytes) {
      if (this.scratch) this.module._free(this.scratch);
      this.scratch = this.module._malloc(bytes);
      this.scratchBytes = bytes;
    }
    return this.scratch;
  }
}
