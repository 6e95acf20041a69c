// Settings as controls: a slider with its range and unit, a box for the number, a way back.

import { byId, make, mark, write } from "./dom.js";
import { named, told } from "./numbers.js";

const SEND_MS = 60;
const OPEN_SETTINGS = 7;
const HANDS_OFF_MS = 600;
let count = 0;

export class Settings {
  /** `set` is called with node, setting and value; `unset` with node and setting, or for all. */
  constructor(set, unset) {
    this.set = set;
    this.unset = unset;
    this.controls = new Set();
    byId("reset-all").addEventListener("click", () => unset());
  }

  /** Show the settings of another graph. */
  take(graph) {
    this.graph = graph;
    const nodes = graph.nodes.filter((node) => node.settings.length);
    const home = byId("setting-groups");
    const wanted = new Set(nodes.map((node) => node.name));
    for (const group of [...home.children]) if (!wanted.has(group.dataset.node)) group.remove();
    let room = OPEN_SETTINGS;
    nodes.forEach((node, i) => {
      room -= node.settings.length;
      let group = [...home.children].find((other) => other.dataset.node === node.name);
      if (!group) {
        group = make("details", { "data-node": node.name, open: i === 0 || room >= 0 },
          make("summary", {}, make("b", {}, node.name), " ", make("span", { class: "soft" })), make("div"));
      }
      write(group.querySelector("summary .soft"), node.step);
      this.fill(group.lastChild, node);
      if (home.children[i] !== group) home.insertBefore(group, home.children[i] ?? null);
    });
    const changed = nodes.flatMap((node) => node.settings).filter((setting) => setting.changed).length;
    write(byId("settings-sum"), changed ? `${changed} changed` : "as in the file");
    byId("reset-all").disabled = changed === 0;
  }

  /** Fill an element with a node's settings; controls that are there keep their focus. */
  fill(home, node) {
    const key = node ? JSON.stringify([node.name, node.settings.map((s) => [s.name, s.kind, s.choices, s.unit, s.help])]) : "";
    if (home.dataset.key !== key) {
      home.dataset.key = key;
      for (const control of this.controls) if (control.home === home) this.controls.delete(control);
      const made = (node?.settings ?? []).map((setting) => this.control(home, node.name, setting));
      home.replaceChildren(...made.map((control) => control.element));
      if (node && !made.length) home.append(make("p", { class: "soft" }, "No settings."));
    }
    for (const setting of node?.settings ?? []) this.show(node.name, setting, false);
  }

  /** Have all controls of a setting show what runs. */
  show(node, setting, refused) {
    for (const control of this.controls) {
      if (control.node === node && control.name === setting.name) control.take(setting, refused);
    }
  }

  /** Put all controls back to what runs: what was asked for was refused. */
  refuse() {
    for (const node of this.graph?.nodes ?? []) {
      for (const setting of node.settings) this.show(node.name, setting, true);
    }
  }

  control(home, node, setting) {
    const control = new Control(home, node, setting, {
      set: (value) => this.set(node, setting.name, value),
      unset: () => this.unset(node, setting.name),
    });
    this.controls.add(control);
    return control;
  }
}

class Control {
  constructor(home, node, setting, { set, unset }) {
    this.home = home;
    this.node = node;
    this.name = setting.name;
    this.kind = setting.kind;
    this.send = set;
    this.touchedAt = -Infinity;
    const id = `setting-${(count += 1)}`;
    this.inputs = makeInputs(setting, id, `${node}, ${setting.name.replaceAll("_", " ")}`);
    for (const input of this.inputs) {
      const dragged = input.type === "range";
      input.addEventListener(dragged ? "input" : "change", () => this.changed(input));
    }
    this.reset = make("button", { type: "button", class: "quiet reset", "aria-label": `Reset ${node}, ${setting.name}`, title: "Back to what the file says" }, "↺");
    this.reset.addEventListener("click", () => {
      this.touchedAt = -Infinity; // the hand is off: what comes is shown
      unset();
    });
    const help = setting.help ? [make("p", { class: "help", id: `${id}-help`, title: setting.help }, setting.help.replaceAll("`", ""))] : [];
    if (help.length) for (const input of this.inputs) mark(input, "aria-describedby", `${id}-help`);
    this.element = make("div", { class: `setting ${setting.kind}` },
      make("label", { for: id }, setting.unit ? named(setting.name)[0] : setting.name.replaceAll("_", " "), ...(setting.unit ? [" ", make("span", { class: "unit" }, setting.unit)] : [])),
      make("div", { class: "inputs" }, ...this.inputs), this.reset, ...help);
  }

  changed(input) {
    const value = this.read(input);
    if (value === undefined) {
      put(input, this.runs); // no number: what runs is shown again
      return;
    }
    this.touchedAt = performance.now();
    for (const other of this.inputs) if (other !== input) put(other, value);
    this.pending = value;
    this.timer ??= setTimeout(() => this.flush(), SEND_MS);
  }

  flush() {
    this.timer = undefined;
    this.send(this.pending);
  }

  read(input) {
    if (this.kind === "boolean") return input.checked;
    if (this.kind === "choice") return JSON.parse(input.value);
    if (this.kind === "text") return input.value;
    const number = Number(input.value);
    return input.value.trim() === "" || !Number.isFinite(number) ? undefined : number;
  }

  /** Show what runs; under the hand of who is just now dragging only later, unless that was refused. */
  take(setting, refused) {
    this.element.classList.toggle("changed", setting.changed);
    this.reset.disabled = !setting.changed;
    clearTimeout(this.later);
    this.runs = setting.value;
    const handsOffMs = this.touchedAt + HANDS_OFF_MS - performance.now();
    if (!refused && handsOffMs > 0) {
      this.later = setTimeout(() => this.take(setting, false), handsOffMs);
      return;
    }
    for (const input of this.inputs) {
      if (input.type === "range") widen(input, setting);
      put(input, setting.value);
    }
  }
}

/** Let a slider reach a value that is beyond its ends; they stay where they are otherwise. */
function widen(slider, { value, slider_low: low, slider_high: high }) {
  if (value < Number(slider.min)) slider.min = Math.min(low, value);
  if (value > Number(slider.max)) slider.max = Math.max(high, value);
}

function makeInputs(setting, id, name) {
  const { kind, value } = setting;
  if (kind === "boolean") return [make("input", { type: "checkbox", id, checked: value === true })];
  if (kind === "choice") {
    const options = setting.choices.map((choice) => make("option", { value: JSON.stringify(choice) }, told(choice)));
    const select = make("select", { id }, ...options);
    put(select, value);
    return [select];
  }
  if (kind === "text") return [make("input", { type: "text", id, value: told(value), spellcheck: "false", autocomplete: "off" })];
  const box = make("input", { type: "number", id, value, step: kind === "integer" ? "1" : "any", min: setting.low, max: setting.high, placeholder: "none" });
  if (setting.slider_low === null || setting.slider_high === null) return [box];
  const slider = make("input", {
    type: "range", min: setting.slider_low, max: setting.slider_high, value, "aria-label": name,
    step: setting.step ?? (kind === "integer" ? 1 : "any"),
  });
  return [slider, box];
}

function put(input, value) {
  if (input.type === "checkbox") input.checked = value === true;
  else if (input.tagName === "SELECT") input.value = JSON.stringify(value);
  else if (Number.isInteger(value)) input.value = String(value);
  else if (Number.isFinite(value)) input.value = String(Number(value.toPrecision(6)));
  else if (input.type === "range") input.value = input.min;
  else input.value = value === null || typeof value === "number" ? "" : String(value); // no number is infinite
}
