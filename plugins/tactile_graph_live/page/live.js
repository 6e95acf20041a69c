// A running pad in the browser: messages come in, the newest frame is drawn when the screen is ready.

import { Connection } from "./connection.js";
import { WORDS_MS, byId, mark, own, show, write } from "./dom.js";
import { NodeList, changeInWords } from "./graph.js";
import { startKeys } from "./keys.js";
import { NodeCard } from "./node.js";
import { Pad, describe, legend } from "./pad.js";
import { Results } from "./results.js";
import { Settings } from "./settings.js";
import { Speech } from "./speech.js";
import { Status, tell } from "./status.js";
import { startTheme } from "./theme.js";
import { Transport } from "./transport.js";
import { Yaml, trouble } from "./yaml.js";

const DESCRIBE_MS = 2000;
const SETTLED_MS = 300;
const PROTOCOL = 1;

const send = (type, fields) => {
  if (!connection.send(type, fields)) tell({ level: "warning", text: "There is no connection; nothing was done." });
};

const pad = new Pad();
const results = new Results();
const status = new Status();
const transport = new Transport(send);
const settings = new Settings(
  (node, setting, value) => send("set", { node, setting, value }),
  (node = "", setting = "") => send("unset", { node, setting }));
const yaml = new Yaml((name) => send("save", { name }));
const nodes = new NodeList(open, look);
const card = new NodeCard(settings, closed);
const speech = new Speech(() => [transport.paused ? "paused" : "", results.summary].filter(Boolean).join(": "));

let graph = null;
let latest = null; // the newest frame, not drawn yet
let shown = null; // the one on the screen
let asked = "";
let pictures = 0;
let drawn = [];
let settling;
let whenAt = 0;

function open(name) {
  if (!graph) return;
  card.open(name, graph);
  nodes.mark(name);
  look([...nodes.inSight]);
  if (shown) card.paint(shown);
}

function closed() {
  nodes.mark(null);
  nodes.focus();
  look([...nodes.inSight]);
}

/** Ask for the pictures that are in sight. */
function look(names) {
  const wanted = [...new Set(card.name === null ? names : [...names, card.name])].sort();
  if (JSON.stringify(wanted) === asked) return;
  if (connection.send("show", { nodes: wanted })) asked = JSON.stringify(wanted);
}

const TAKE = {
  hello(message) {
    if (message.protocol !== PROTOCOL) {
      tell({ level: "error", text: "The server is of another version than this page. Load the page again." });
      return;
    }
    status.hello(message);
    write(byId("pipeline"), message.pipeline);
    document.title = `${message.pipeline} · tactile-graph live`;
  },
  graph(message) {
    graph = message;
    write(byId("pipeline"), graph.name);
    mark(document.documentElement, "data-graph", graph.version);
    nodes.take(graph);
    if (graph.anew.length) speech.say(changeInWords(graph));
    settings.take(graph);
    yaml.take(graph);
    results.take(graph);
    card.take(graph);
    look([...nodes.inSight]);
  },
  trouble,
  frame(message) {
    const waiting = latest !== null;
    if (waiting) answer(latest); // never drawn: the newer one is
    latest = message;
    if (document.hidden) answer(message);
    else if (!waiting) requestAnimationFrame(paint);
  },
  pulse(message) {
    connection.runs(message.paused ? "paused" : message.state);
    show(byId("silent"), Boolean(message.trouble));
    write(byId("silent-text"), message.trouble ?? "");
    status.take(message);
    nodes.takeProcesses(message.processes ?? {});
    card.takeProcesses(message.processes ?? {});
    transport.take(message);
  },
  told(message) {
    tell(message);
    if (message.level === "error") settings.refuse();
  },
};

const answer = (frame) => connection.send("pong", { index: frame.index });

/** Say in words what pictures show. */
function inWords() {
  if (document.hidden || !shown) return;
  describe(pad);
  results.describe();
  status.describe();
}

function paint() {
  const frame = latest;
  latest = null;
  if (frame === null) return;
  const begun = performance.now();
  const first = shown === null;
  shown = frame;
  pictures += 1;
  pad.paint(frame);
  legend(frame, pad);
  nodes.paint(frame);
  card.paint(frame);
  results.paint(frame);
  transport.paint(frame);
  tellWhen(frame, begun);
  drawn.push(performance.now() - begun);
  if (first) inWords(); // whoever cannot see reads the page as soon as it is there
  mark(document.documentElement, "data-drawn", frame.version);
  clearTimeout(settling);
  settling = setTimeout(settle, SETTLED_MS);
  answer(frame);
}

/** No frame follows for now: what is written less often than drawn catches up. */
function settle() {
  nodes.paint(shown);
  card.paint(shown);
  results.paint(shown);
  tellWhen(shown, performance.now());
  inWords();
}

function tellWhen(frame, now) {
  if (now - whenAt < WORDS_MS) return;
  whenAt = now;
  write(byId("when"), whenOf(frame));
}

function whenOf(frame) {
  const time = frame.time_s === null ? "" : `${frame.time_s.toFixed(2)} s`;
  return [`frame ${frame.index}`, time, frame.label, frame.gap ? "after a gap" : ""].filter(Boolean).join(" · ");
}

/** Once a second: how many pictures were drawn, and how long that took. */
function count() {
  write(byId("picture-rate"), String(pictures));
  pictures = 0;
  if (!drawn.length) return;
  drawn.sort((a, b) => a - b);
  const [median, worst] = [drawn[Math.floor(drawn.length / 2)], drawn.at(-1)];
  write(byId("draw-ms"), median.toFixed(1));
  mark(document.documentElement, "data-draw-ms", `${median.toFixed(2)} ${worst.toFixed(2)}`);
  drawn = [];
}

function connected(up) {
  document.body.classList.toggle("stale", !up);
  asked = "";
  if (!up) {
    show(byId("silent"), false); // nobody knows
    status.interrupt(performance.now());
  }
  if (up) look([...nodes.inSight]);
}

const connection = new Connection((message) => own(TAKE, message?.type)?.(message), connected);
startTheme(() => {
  pad.draw();
  status.chart();
  if (shown) nodes.paint(shown);
}, (words) => speech.say(words));
startKeys({
  " ": () => transport.pause(),
  ".": () => transport.step(),
  ",": () => transport.back(),
  l: () => transport.live(),
  t: () => transport.tare(),
  r: () => transport.record(),
  g: () => nodes.focus(),
  p: () => byId("pad-canvas").focus(),
  d: () => byId("theme").click(),
  escape: () => card.close(),
});
/** Spread the cards over columns where there is room; reading order is that of the eye either way. */
function arrange() {
  const places = wide.matches ? WIDE : { left: NARROW };
  for (const [column, cards] of Object.entries(places)) byId(column).append(...cards.map(byId));
}

const NARROW = ["pad", "graph", "node", "results", "contacts", "timing", "flow", "settings", "file"];
const WIDE = { left: ["pad", "file"], middle: ["graph", "settings"], right: ["node", "results", "contacts", "timing", "flow"] };
const wide = matchMedia("(min-width: 781px)");
wide.addEventListener("change", arrange);
arrange();
setInterval(count, 1000);
setInterval(inWords, DESCRIBE_MS);
show(byId("lost"), false);
