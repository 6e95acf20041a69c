// The graph as the page's table of contents: a row for each node, its wires as rails beside it.

import { WORDS_MS, byId, make, mark, own, show, write } from "./dom.js";
import { duration } from "./numbers.js";
import { badge, fateOf, setBadge } from "./outcomes.js";
import { drawPicture } from "./paint.js";
import { faresInWords, withinOf } from "./processes.js";
import { ordered, rails } from "./rails.js";

const SVG = "http://www.w3.org/2000/svg";
const ROW = 3.875 * parseFloat(getComputedStyle(document.documentElement).fontSize); // as the style's --row
const LANE = 13;
const TIMES = 31;

export class NodeList {
  /** `open` is called with the name of the node to show large, `look` with those in sight. */
  constructor(open, look) {
    this.list = byId("nodes");
    this.open = open;
    this.look = look;
    this.rows = new Map();
    this.inSight = new Set();
    this.processes = {};
    this.wordsAt = 0;
    this.list.addEventListener("keydown", (event) => this.key(event));
    this.list.addEventListener("click", (event) => {
      const row = event.target.closest?.("[role=option]");
      if (row) this.choose(row.dataset.name, true);
    });
    this.observer = new IntersectionObserver((entries) => this.seen(entries), { rootMargin: "80px" });
  }

  /** Show another graph; rows of the same name stay what they are, with their focus. */
  take(graph) {
    const boxes = ordered(graph.boxes.filter((box) => box.role !== "source"), graph.wires);
    const drawn = rails(boxes, graph.wires);
    const outputs = new Set(graph.outputs);
    const about = new Map(graph.nodes.map((node) => [node.name, node]));
    const names = new Set(boxes.map((box) => box.name));
    for (const [name, row] of this.rows) if (!names.has(name)) this.drop(name, row);
    boxes.forEach((box, i) => {
      const row = this.rows.get(box.name) ?? this.row(box.name);
      write(row.step, box.role === "frame" ? "what the source gives" : box.step);
      row.element.classList.toggle("output", outputs.has(box.name));
      mark(row.element, "title", about.get(box.name)?.about ?? "");
      row.isolated = withinOf(box.name, graph.nodes);
      this.apart(box.name, row);
      row.rail.replaceWith((row.rail = railOf(drawn.rows[i], drawn.count)));
      if (this.list.children[i] !== row.element) this.list.insertBefore(row.element, this.list.children[i] ?? null);
    });
    this.order = boxes.map((box) => box.name);
    this.current = names.has(this.current) ? this.current : this.order[0];
    this.rove();
    show(byId("change"), graph.version > 1);
    write(byId("change"), changeInWords(graph));
  }

  row(name) {
    const canvas = make("canvas", { class: "thumb", "aria-hidden": "true" });
    const rail = document.createElementNS(SVG, "svg");
    const step = make("span", { class: "step" });
    const apart = make("span", { class: "apart", hidden: true }, make("span", { "aria-hidden": "true" }), make("span", { class: "unseen" }));
    const reason = make("span", { class: "reason" });
    const fate = badge();
    const time = make("span", { class: "time" });
    const bar = make("span", { class: "share", "aria-hidden": "true" });
    const element = make("div", { role: "option", "aria-selected": "false", tabindex: "-1", "data-name": name },
      rail, canvas,
      make("span", { class: "words" }, make("b", { class: "line" }, make("span", {}, name)), make("span", { class: "line" }, step, apart), reason),
      make("span", { class: "fate" }, fate, time, bar));
    const row = { element, rail, canvas, step, apart, isolated: [], reason, fate, time, bar, us: null, times: [], next: -1 };
    this.rows.set(name, row);
    this.observer.observe(element);
    return row;
  }

  /** Show how the processes fare of nodes that run apart. */
  takeProcesses(processes) {
    this.processes = processes;
    for (const [name, row] of this.rows) if (row.isolated.length) this.apart(name, row);
  }

  apart(name, row) {
    const { short, long, starting } = faresInWords(row.isolated, this.processes);
    show(row.apart, row.isolated.length > 0);
    write(row.apart.firstChild, short);
    write(row.apart.lastChild, `${short}: ${long}`);
    row.apart.classList.toggle("starting", starting);
    mark(row.apart, "title", long);
  }

  drop(name, row) {
    this.observer.unobserve(row.element);
    row.element.remove();
    this.rows.delete(name);
    this.inSight.delete(name);
  }

  seen(entries) {
    for (const entry of entries) {
      const name = entry.target.dataset.name;
      if (entry.isIntersecting) this.inSight.add(name);
      else this.inSight.delete(name);
    }
    this.look([...this.inSight]);
  }

  /** Show how the nodes fared in a frame. */
  paint(frame) {
    const now = performance.now();
    const words = now - this.wordsAt > WORDS_MS;
    if (words) this.wordsAt = now;
    for (const [name, row] of this.rows) {
      const story = name === "frame" ? { outcome: "ran", reason: "", us: null } : own(frame.nodes, name);
      const ran = story && (story.outcome === "ran" || story.outcome === "failed") && story.us !== null;
      if (ran) row.times[(row.next = (row.next + 1) % TIMES)] = story.us;
      setBadge(row.fate, fateOf(story));
      if (row.element.dataset.fate !== fateOf(story)) row.element.dataset.fate = fateOf(story);
      const shapes = own(frame.pictures, name);
      if (this.inSight.has(name)) this.thumb(row, shapes, frame.pad);
      if (words) write(row.reason, story?.outcome === "ran" ? notesOf(shapes) : story?.reason ?? "");
    }
    if (words) this.times(frame);
  }

  thumb(row, shapes, pad) {
    if (!shapes) return; // not sent for this frame: the last stays
    const drawn = drawPicture(row.canvas, shapes, pad, 0.6);
    if (row.empty === drawn) row.canvas.classList.toggle("empty", (row.empty = !drawn));
    else if (row.empty === undefined) row.canvas.classList.toggle("empty", (row.empty = !drawn));
  }

  /** Tell the usual time of each node: the median of the last ones. */
  times(frame) {
    let [longest, total] = [1, 0];
    for (const row of this.rows.values()) {
      row.us = row.times.length ? [...row.times].sort((a, b) => a - b)[row.times.length >> 1] : null;
      longest = Math.max(longest, row.us ?? 0);
    }
    for (const [name, row] of this.rows) {
      const story = own(frame.nodes, name);
      const us = story?.us ?? null;
      const ran = story?.outcome === "ran";
      if (ran && us !== null) total += row.us ?? us;
      write(row.time, row.us !== null && ran ? duration(row.us) : "\u00a0");
      row.bar.style.setProperty("--share", ran ? ((row.us ?? 0) / longest).toFixed(3) : 0);
    }
    const stories = Object.values(frame.nodes);
    const ran = stories.filter((s) => s.outcome === "ran" || s.outcome === "reused").length;
    write(byId("graph-sum"), `${ran} of ${stories.length} ran, ${duration(total)}`);
  }

  key(event) {
    const at = this.order?.indexOf(this.current) ?? -1;
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: (this.order?.length ?? 0) - 1 }[event.key];
    if (event.altKey || event.ctrlKey || event.metaKey || at < 0) return;
    if (to !== undefined) {
      event.preventDefault();
      this.current = this.order[Math.max(0, Math.min(this.order.length - 1, to))];
      this.rove();
      this.focus();
    } else if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      event.stopPropagation();
      this.choose(this.current, true);
    }
  }

  /** Make a node the chosen one; `large` shows it. */
  choose(name, large) {
    this.current = name;
    this.rove();
    if (large) this.open(name);
  }

  /** Say which node is shown large, or none. */
  mark(name) {
    for (const [other, row] of this.rows) mark(row.element, "aria-selected", other === name);
  }

  rove() {
    for (const [name, row] of this.rows) mark(row.element, "tabindex", name === this.current ? "0" : "-1");
  }

  focus() {
    this.rows.get(this.current)?.element.focus();
  }
}

/** Return how long a change took, and which nodes lost by it what they kept. */
export function changeInWords({ took_ms: took, anew }) {
  const lost = anew.length ? `What ${anew.join(", ")} kept of earlier frames began anew.` : "";
  return [`The last change ran after ${duration(1000 * took)}.`, lost].filter(Boolean).join(" ");
}

/** Return the notes of a picture in one line. */
export function notesOf(shapes) {
  return (shapes ?? []).filter((s) => s.shape === "note").slice(0, 3)
    .map((s) => `${s.name} ${s.value}`.trim()).join(", ");
}

function railOf({ lane, arriving, passing, goesOn }, count) {
  const width = count * LANE + 6;
  const svg = document.createElementNS(SVG, "svg");
  for (const [name, value] of [["class", "rail"], ["width", width], ["height", ROW], ["viewBox", `0 0 ${width} ${ROW}`], ["aria-hidden", "true"]]) {
    svg.setAttribute(name, value);
  }
  const x = (number) => number * LANE + 8;
  const middle = ROW / 2;
  for (const other of passing) line(svg, `M${x(other)} 0V${ROW}`, "data");
  for (const { from, kind } of arriving) {
    const straight = from === lane;
    line(svg, straight ? `M${x(lane)} 0V${middle}` : `M${x(from)} 0C${x(from)} ${middle * 0.7} ${x(lane)} ${middle * 0.3} ${x(lane)} ${middle}`, kind);
  }
  if (goesOn) line(svg, `M${x(lane)} ${middle}V${ROW}`, "data");
  const spot = document.createElementNS(SVG, "circle");
  for (const [name, value] of [["cx", x(lane)], ["cy", middle], ["r", 5]]) spot.setAttribute(name, value);
  svg.append(spot);
  return svg;
}

function line(svg, path, kind) {
  const made = document.createElementNS(SVG, "path");
  made.setAttribute("d", path);
  made.setAttribute("class", `wire ${["data", "guard", "choice"].includes(kind) ? kind : "data"}`);
  svg.append(made);
}
