// Results as tables: a line for each number of an output that gives one thing, with what it was
// over the last seconds; a line for each thing of an output that gives several.

import { History, sparkline } from "./charts.js";
import { WORDS_MS, byId, make, mark, own, show, write } from "./dom.js";
import { named, told } from "./numbers.js";

const LEAD = new Set(["output", "item", "outcome", "type"]);
const KEPT_S = 10;
const MOST_THINGS = 50;

export class Results {
  constructor() {
    this.lines = new Map();
    this.several = new Set();
    this.columns = new Map();
    this.wordsAt = 0;
    this.summary = "";
  }

  /** Forget the outputs of the graph before. */
  take(graph) {
    const key = JSON.stringify([graph.outputs, graph.columns]);
    if (key === this.key) return;
    this.key = key;
    this.columns = new Map(graph.columns.map((column) => [column.key, column]));
    this.begin();
  }

  /** Begin the tables anew. */
  begin() {
    this.lines.clear();
    this.several.clear();
    byId("result-rows").replaceChildren();
    byId("contact-rows").replaceChildren();
    byId("contact-head").replaceChildren();
    delete byId("contact-head").dataset.key;
    show(byId("contacts"), false);
  }

  paint(frame) {
    if (this.quantity !== frame.pad.quantity) {
      this.quantity = frame.pad.quantity; // by which units go
      this.begin();
    }
    const now = performance.now();
    const words = now - this.wordsAt > WORDS_MS;
    for (const row of frame.rows) if (row.item > 1) this.split(row.output);
    const one = frame.rows.filter((row) => !this.several.has(row.output));
    const present = new Set();
    for (const row of one) this.note(row, now, frame.back_s > 0, present);
    if (!words) return;
    this.wordsAt = now;
    for (const [key, line] of this.lines) this.write(line, present.has(key), now);
    show(byId("no-results"), frame.rows.length === 0 && this.lines.size === 0);
    show(byId("results"), this.lines.size > 0 || this.several.size === 0);
    this.things(frame.rows.filter((row) => this.several.has(row.output)));
    this.summary = inWords(frame.rows, (key) => this.label(key));
  }

  /** From now on an output's things have a table of their own. */
  split(output) {
    if (this.several.has(output)) return;
    this.several.add(output);
    for (const [key, line] of this.lines) {
      if (line.output !== output) continue;
      line.element.remove();
      this.lines.delete(key);
    }
    byId("result-rows").querySelector(`[data-output="${CSS.escape(output)}"]`)?.remove();
  }

  note(row, now, again, present) {
    for (const [field, value] of Object.entries(row)) {
      if (LEAD.has(field) || Array.isArray(value) || (typeof value === "object" && value !== null)) continue;
      const key = `${row.output} ${field}`;
      const line = this.lines.get(key) ?? this.line(key, row.output, field);
      present.add(key);
      line.value = value;
      if (!again && typeof value === "number") line.history.push(now, value);
    }
    const outcome = row.outcome ?? "ok";
    const head = byId("result-rows").querySelector(`[data-output="${CSS.escape(row.output)}"] .said`);
    if (head) write(head, [row.type, outcome === "ok" ? "" : outcome].filter(Boolean).join(", "));
  }

  line(key, output, field) {
    const body = byId("result-rows");
    let head = body.querySelector(`[data-output="${CSS.escape(output)}"]`);
    if (!head) {
      head = make("tr", { "data-output": output, class: "head-row" },
        make("th", { scope: "rowgroup", colspan: "3" }, make("span", {}, output), " ", make("span", { class: "said soft" })));
      body.append(head);
    }
    const [name, unit] = this.label(field);
    const canvas = make("canvas", { class: "spark", role: "img", "aria-label": `${name} over time` });
    const number = make("b");
    const wrong = field.includes("_error_");
    const element = make("tr", wrong ? { class: "wrong" } : {}, make("th", { scope: "row" }, name),
      make("td", { class: "number" }, number, " ", make("span", { class: "unit" }, unit)), make("td", {}, canvas));
    let after = head;
    while (after.nextSibling && !after.nextSibling.dataset.output) after = after.nextSibling;
    after.after(element);
    const line = { element, number, canvas, output, name, unit, value: null, history: new History(KEPT_S) };
    this.lines.set(key, line);
    return line;
  }

  label(field) {
    const column = this.columns.get(field);
    const [name, unit] = named(field.split(".").slice(-2).join(" "));
    return [column && column.name !== field ? column.name : name.replace(/ error$/, ", off by"), column?.unit || own(column?.units ?? {}, this.quantity) || unit];
  }

  write(line, present, now) {
    line.element.classList.toggle("gone", !present);
    write(line.number, present ? told(line.value) : "–");
    if (typeof line.value !== "number") return;
    if (!present) line.history.push(now, null);
    sparkline(line.canvas, line.history, now);
  }

  things(rows) {
    show(byId("contacts"), this.several.size > 0);
    if (!this.several.size) return;
    const shown = rows.filter((row) => row.outcome === undefined || row.outcome === "ok").slice(0, MOST_THINGS);
    const more = rows.length > shown.length && shown.length === MOST_THINGS ? `, the first ${MOST_THINGS} shown` : "";
    write(byId("contacts-count"), `${rows.length}${more}`);
    const fields = [...new Set(shown.flatMap((row) => Object.keys(row)))]
      .filter((f) => !LEAD.has(f) && shown.some((row) => typeof row[f] !== "object"));
    if (fields.length) this.heads(fields);
    const lines = [];
    for (const [i, row] of shown.entries()) {
      const begins = this.several.size > 1 && row.output !== shown[i - 1]?.output;
      if (begins) lines.push([row.output.split(".")[0]]);
      lines.push([String(row.item), ...fields.map((f) => told(row[f]))]);
    }
    fill(byId("contact-rows"), lines, fields.length + 1);
  }

  heads(fields) {
    const head = byId("contact-head");
    const key = JSON.stringify(fields);
    if (head.dataset.key === key) return;
    head.dataset.key = key;
    head.replaceChildren(make("tr", {}, make("th", { scope: "col" }, "no."),
      ...fields.map((field) => {
        const [name, unit] = this.label(field);
        return make("th", { scope: "col", class: "number" }, name, ...(unit ? [" ", make("span", { class: "unit" }, unit)] : []));
      })));
  }

  /** Say under each line what it was: for those who do not see it. */
  describe() {
    for (const line of this.lines.values()) {
      const range = line.history.range();
      const text = range ? `${line.name}, last ten seconds: ${told(range[0])} to ${told(range[1])} ${line.unit}` : `${line.name}: nothing yet`;
      mark(line.canvas, "aria-label", text);
    }
  }
}

/** Write lines of cells into a table; a line of one cell is a heading over those below it. */
function fill(body, lines, columns) {
  while (body.children.length > lines.length) body.lastChild.remove();
  while (body.children.length < lines.length) body.append(make("tr"));
  lines.forEach((cells, i) => {
    const line = body.children[i];
    while (line.children.length > cells.length) line.lastChild.remove();
    while (line.children.length < cells.length) {
      line.append(line.children.length ? make("td", { class: "number" }) : make("th"));
    }
    const heading = cells.length === 1;
    line.classList.toggle("head-row", heading);
    mark(line.firstChild, "scope", heading ? "rowgroup" : "row");
    mark(line.firstChild, "colspan", heading ? columns : 1);
    cells.forEach((cell, c) => write(line.children[c], cell));
  });
}

/** Return the results in a sentence, rounded so that it changes when something happened. */
function inWords(rows, label) {
  const good = rows.filter((row) => row.outcome === undefined || row.outcome === "ok").slice(0, 5);
  const parts = good.map((row) => {
    const numbers = Object.entries(row)
      .filter(([field, value]) => /(^|\.)(x|y|radius|angle|area)_(cm2?|deg)$/.test(field) && typeof value === "number")
      .slice(0, 4)
      .map(([field, value]) => `${label(field)[0]} ${Number(value.toPrecision(2))} ${label(field)[1]}`);
    const named = row.type && row.type.toLowerCase() !== row.output.toLowerCase();
    const name = named ? `${row.output}, ${row.type}` : row.output;
    return [`${name}${row.item > 1 ? ` ${row.item}` : ""}`, ...numbers].join(", ");
  });
  return parts.length ? parts.join("; ") : "nothing found";
}
