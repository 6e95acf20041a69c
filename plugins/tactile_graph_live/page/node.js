// One node, large: its picture, how it fared and why, what it may be set to.

import { WORDS_MS, byId, make, mark, own, show, write } from "./dom.js";
import { duration } from "./numbers.js";
import { badge, fateOf, setBadge } from "./outcomes.js";
import { faresInWords, withinOf } from "./processes.js";
import { drawPicture, extentOf } from "./paint.js";

export class NodeCard {
  /** `settings` makes the controls of a node; `closed` is called when it is shut. */
  constructor(settings, closed) {
    this.card = byId("node");
    this.canvas = byId("node-canvas");
    this.settings = settings;
    this.closed = closed;
    this.badge = badge();
    this.name = null;
    this.isolated = [];
    this.processes = {};
    this.wordsAt = 0;
    this.why = make("span");
    byId("node-outcome").append(this.badge, this.why);
    byId("node-close").addEventListener("click", () => this.close());
    this.card.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close();
    });
  }

  /** Show a node of the graph. */
  open(name, graph) {
    this.name = name;
    this.take(graph);
    show(this.card, true);
    const { top } = this.card.getBoundingClientRect();
    if (top < 0 || top > window.innerHeight * 0.6) this.card.scrollIntoView({ block: "start" });
    byId("node").focus({ preventScroll: true });
  }

  /** Show the same node of another graph, or nothing where it has none. */
  take(graph) {
    if (this.name === null) return;
    const node = graph.nodes.find((other) => other.name === this.name);
    const box = graph.boxes.find((other) => other.name === this.name);
    if (!node && !box) {
      this.close();
      return;
    }
    write(byId("node-title"), this.name);
    write(byId("node-step"), node?.step ?? box?.step ?? "");
    write(byId("node-about"), [node?.about, node?.guard && `Runs when ${node.guard}.`, node?.keeps && "Keeps a state from frame to frame."].filter(Boolean).join(" "));
    this.isolated = withinOf(this.name, graph.nodes);
    this.takeProcesses(this.processes);
    this.settings.fill(byId("node-settings"), node);
  }

  /** Tell how the process fares where the node runs apart. */
  takeProcesses(processes) {
    this.processes = processes;
    if (this.name !== null) write(byId("node-apart"), faresInWords(this.isolated, processes).long);
  }

  close() {
    if (this.name === null) return;
    this.name = null;
    show(this.card, false);
    this.closed();
  }

  paint(frame) {
    if (this.name === null) return;
    const story = this.name === "frame" ? { outcome: "ran", reason: "", us: null } : own(frame.nodes, this.name);
    const shapes = own(frame.pictures, this.name);
    const { left, top, right, bottom } = extentOf(frame.pad);
    this.canvas.style.setProperty("--ratio", Math.min(1.4, Math.max(0.35, (bottom - top) / (right - left))));
    const drawn = shapes ? drawPicture(this.canvas, shapes, frame.pad, 1) : undefined;
    if (drawn !== undefined) show(this.canvas, drawn);
    setBadge(this.badge, fateOf(story));
    if (performance.now() - this.wordsAt < WORDS_MS) return;
    this.wordsAt = performance.now();
    const time = story?.us ? `in ${duration(story.us)}` : "";
    write(this.why, story?.reason || time);
    const notes = (shapes ?? []).filter((shape) => shape.shape === "note");
    this.notes(notes);
    mark(this.canvas, "aria-label", `What ${this.name} gives, on the pad. ${notes.map((n) => `${n.name} ${n.value}`).join(", ")}`);
  }

  notes(notes) {
    const list = byId("node-notes");
    while (list.children.length > notes.length) list.lastChild.remove();
    while (list.children.length < notes.length) list.append(make("li", {}, make("span"), make("b")));
    notes.forEach(({ name, value }, i) => {
      write(list.children[i].firstChild, name);
      write(list.children[i].lastChild, String(value));
    });
  }
}
