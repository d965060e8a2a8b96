// The worker: one instance of the engine, and the orbits that fly in it.
// @ts-expect-error: the factory is made by emscripten
import createCarom from "carom-engine";
import { Engine, EngineError } from "./engine";
import { Flock } from "./flock";
import type { Request } from "./protocol";

declare const self: {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: unknown, transfer?: Transferable[]): void;
};

let ready: Promise<{ engine: Engine; flock: Flock }> | undefined;

async function start(wasm: ArrayBuffer): Promise<{ engine: Engine; flock: Flock }> {
  const engine = new Engine(await createCarom({ wasmBinary: wasm }));
  return { engine, flock: new Flock(engine) };
}

self.onmessage = async (event: MessageEvent) => {
  if (event.data.wasm) {
    ready = start(event.data.wasm);
    return;
  }
  const { id, ask } = event.data as { id: number; ask: Request };
  try {
    const { engine, flock } = await ready!;
    switch (ask.do) {
      case "call":
        self.postMessage({ id, result: engine.call(ask.request) });
        break;
      case "begin":
        self.postMessage({ id, result: flock.begin(ask) });
        break;
      case "trust":
        self.postMessage({ id, result: flock.trust() });
        break;
      case "grain":
        flock.grain = ask.grain;
        self.postMessage({ id, result: null });
        break;
      case "frame": {
        const frame = flock.frame(ask.t, ask.budget);
        self.postMessage({ id, result: frame }, [frame.dots.buffer, frame.hits.buffer, frame.slots.buffer, frame.trail.buffer, frame.rates.buffer]);
        break;
      }
      case "decisions":
        self.postMessage({ id, result: flock.decisions() });
        break;
    }
  } catch (error) {
    const place = error instanceof EngineError ? { line: error.line, column: error.column } : {};
    self.postMessage({ id, error: error instanceof Error ? error.message : String(error), ...place });
  }
};
