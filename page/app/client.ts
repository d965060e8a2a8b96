// A worker as the page calls it: each request is a promise.
import type { Answer, Begun, Frame, Request } from "./protocol";
import { EngineError } from "./engine";

let source: string | undefined;
let wasm: Promise<ArrayBuffer> | undefined;

function text(id: string): string {
  const element = document.getElementById(id)!;
  const content = element.textContent!;
  element.remove();
  return content;
}

/** The engine's bytes, which lie compressed in the page. */
async function engineBytes(): Promise<ArrayBuffer> {
  const characters = atob(text("carom-wasm"));
  const packed = new Uint8Array(characters.length);
  for (let i = 0; i < packed.length; ++i) packed[i] = characters.charCodeAt(i); // much faster than a callback
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

export class Client {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, { resolve(value: any): void; reject(error: Error): void }>();
  private next = 1;

  constructor() {
    source ??= URL.createObjectURL(new Blob([text("carom-worker")], { type: "text/javascript" }));
    wasm ??= engineBytes();
    this.worker = new Worker(source);
    this.worker.onmessage = (event: MessageEvent<Answer>) => {
      const answer = event.data;
      const waiting = this.waiting.get(answer.id)!;
      this.waiting.delete(answer.id);
      if ("error" in answer) waiting.reject(new EngineError(answer.error, answer.line, answer.column));
      else waiting.resolve(answer.result);
    };
    this.worker.onerror = (event) => {
      for (const { reject } of this.waiting.values()) reject(new Error(event.message));
      this.waiting.clear();
    };
    void wasm.then((bytes) => this.worker.postMessage({ wasm: bytes }));
  }

  async ask(ask: Request): Promise<any> {
    await wasm;
    return new Promise((resolve, reject) => {
      const id = this.next++;
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, ask });
    });
  }

  call(request: object): Promise<any> {
    return this.ask({ do: "call", request });
  }

  begin(ask: Extract<Request, { do: "begin" }>): Promise<Begun> {
    return this.ask(ask);
  }

  frame(t: number, budget: number): Promise<Frame> {
    return this.ask({ do: "frame", t, budget });
  }

  /** Requests that are not answered are refused. */
  stop(): void {
    this.worker.terminate();
    for (const { reject } of this.waiting.values()) reject(new Error("stopped"));
    this.waiting.clear();
  }
}
