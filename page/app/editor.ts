// The system file, edited: CodeMirror with TOML, and the program's error at its line.
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { EditorView, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { valueRange } from "./toml";

const style = HighlightStyle.define([
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
  { tag: [tags.propertyName, tags.name], color: "var(--ink)" },
  { tag: [tags.string, tags.number, tags.atom, tags.bool], color: "var(--accent)" },
]);

export class Editor {
  private readonly view: EditorView;
  private quiet = false;

  constructor(place: HTMLElement, changed: (text: string) => void) {
    this.view = new EditorView({
      parent: place,
      state: EditorState.create({
        extensions: [
          lineNumbers(),
          history(),
          keymap.of([...defaultKeymap, ...historyKeymap]),
          StreamLanguage.define(toml),
          syntaxHighlighting(style),
          EditorView.lineWrapping,
          EditorView.contentAttributes.of({ "aria-label": "System file (TOML)", spellcheck: "false" }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged && !this.quiet) changed(this.text);
          }),
        ],
      }),
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Replaces the text, without calling `changed`. */
  set text(text: string) {
    if (text === this.text) return;
    this.quiet = true;
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
    this.quiet = false;
  }

  /** Replaces the value of a key on a line (from 1): as if it had been typed. */
  setValue(line: number, key: string, value: string): boolean {
    if (line < 1 || line > this.view.state.doc.lines) return false;
    const place = this.view.state.doc.line(line);
    const range = valueRange(place.text, key);
    if (!range) return false;
    this.view.dispatch({ changes: { from: place.from + range[0], to: place.from + range[1], insert: value } });
    return true;
  }

  /** Marks an error at its place; none: the text is good. */
  mark(error?: { text: string; line?: number; column?: number }): void {
    const { doc } = this.view.state;
    const diagnostics = [];
    if (error?.line && error.line <= doc.lines) {
      const line = doc.line(error.line);
      const from = error.column && error.column > 1 ? Math.min(line.from + error.column - 1, line.to) : line.from;
      diagnostics.push({ from: from === line.to ? line.from : from, to: line.to, severity: "error" as const, message: error.text });
    }
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }
}
