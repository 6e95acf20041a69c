// The line of numbers on top, the charts of latency and rate, and what the server has to say.

import { History, lineChart } from "./charts.js";
import { byId, make, mark, show, write } from "./dom.js";
import { counted, duration, told as inDigits } from "./numbers.js";

const KEPT_S = 60;
const STAYS_MS = 6000;
const MOST_TOLD = 4;
const MOST_DIFFERENCES = 3;
const OF_THE_BENCH = new Set(["frames", "troubles"]); // told elsewhere
const WORDS = { note: "", warning: "Warning", error: "Error" };

export class Status {
  constructor() {
    [this.median, this.p99, this.page] = [new History(KEPT_S), new History(KEPT_S), new History(KEPT_S)];
    [this.rate, this.lost, this.shed] = [new History(KEPT_S), new History(KEPT_S), new History(KEPT_S)];
    this.deadlineUs = null;
    this.counts = [];
    const resized = new ResizeObserver(() => this.chart());
    for (const name of ["latency-chart", "flow-chart"]) resized.observe(byId(name));
  }

  hello(hello) {
    this.deadlineUs = hello.deadline_us;
    show(byId("deadline-key"), this.deadlineUs !== null);
    show(byId("missed-stat"), this.deadlineUs !== null);
    write(byId("about"), [hello.about, hello.source && `from ${hello.source}`].filter(Boolean).join(" · "));
    mark(byId("file-sum"), "title", hello.file);
  }

  take(pulse) {
    const latency = pulse.latency_us;
    write(byId("rate"), pulse.rate_hz < 10 ? pulse.rate_hz.toFixed(1) : counted(Math.round(pulse.rate_hz)));
    write(byId("frames"), counted(pulse.frames));
    write(byId("lost-frames"), counted(pulse.lost));
    write(byId("shed-frames"), counted(pulse.shed));
    write(byId("shed-before"), pulse.shed_before > 0 ? `and ${counted(pulse.shed_before)} at the start` : "");
    write(byId("latency-median"), duration(latency.median));
    write(byId("latency-p99"), duration(latency.p99));
    write(byId("page-latency"), duration(pulse.page_latency_us.median));
    write(byId("viewers"), counted(pulse.viewers));
    write(byId("missed"), counted(pulse.missed));
    byId("missed-stat").classList.toggle("alarm", pulse.missed > 0);
    byId("lost-stat").classList.toggle("alarm", pulse.lost > 0);
    byId("shed-stat").classList.toggle("alarm", pulse.shed > 0);
    this.source(pulse.counters ?? {});
    this.beside(pulse.beside);
    this.keep(pulse, performance.now());
    this.chart();
  }

  /** Keep what the charts show. */
  keep(pulse, now) {
    const runs = pulse.state === "running" && !pulse.paused;
    this.median.push(now, runs ? pulse.latency_us.median : null);
    this.p99.push(now, runs ? pulse.latency_us.p99 : null);
    this.page.push(now, runs ? pulse.page_latency_us.median : null);
    this.counts.push({ at: now, lost: pulse.lost, shed: pulse.shed });
    while (this.counts.length > 2 && this.counts[1].at <= now - 1000) this.counts.shift();
    const before = this.counts[0];
    const seconds = Math.max(0.2, (now - before.at) / 1000);
    this.rate.push(now, pulse.rate_hz);
    this.lost.push(now, Math.max(0, pulse.lost - before.lost) / seconds); // below 0: a new server
    this.shed.push(now, Math.max(0, pulse.shed - before.shed) / seconds);
  }

  /** Tell what the source assumes and counts; recordings are counted each time they are played. */
  source(counters) {
    const said = Object.entries(counters).filter(([what, n]) => n > 0 && !OF_THE_BENCH.has(what))
      .map(([what, n]) => (what.startsWith("recordings ") ? what : `${counted(n)} ${what}`));
    show(byId("source-stat"), said.length > 0);
    write(byId("source-text"), said.join("; "));
  }

  beside(beside) {
    show(byId("beside-stat"), Boolean(beside));
    if (!beside) return;
    const { variant, frames, passed, same_outcomes: same, median_us: ours, beside_median_us: its } = beside;
    write(byId("beside-name"), `Beside: ${variant}`);
    const differences = Object.entries(beside.differences ?? {}).slice(0, MOST_DIFFERENCES)
      .map(([field, { mean, most }]) => `${field} ${inDigits(mean)} apart, ${inDigits(most)} at most`);
    const parts = [
      `${counted(frames)} frames, ${counted(passed)} passed by`,
      frames > 0 && `as here in ${((100 * same) / frames).toFixed(1)} %`,
      `${duration(its)} for ${duration(ours)} here`,
      ...differences, beside.trouble,
    ];
    write(byId("beside-text"), parts.filter(Boolean).join("; "));
  }

  /** Nothing is known from here on: lines end, and counts begin anew. */
  interrupt(now) {
    for (const history of [this.median, this.p99, this.page, this.rate, this.lost, this.shed]) history.push(now, null);
    this.counts = [];
  }

  chart() {
    const now = performance.now();
    lineChart(byId("latency-chart"), {
      title: "time since the sensor's frame was here", format: duration, level: this.deadlineUs,
      lines: [
        { history: this.page, paint: "--good", dash: [2, 3] },
        { history: this.p99, paint: "--p99", dash: [] },
        { history: this.median, paint: "--accent", dash: [] },
      ],
    }, now);
    lineChart(byId("flow-chart"), {
      title: "frames a second", format: inDigits,
      lines: [
        { history: this.rate, paint: "--accent", dash: [] },
        { history: this.shed, paint: "--p99", dash: [6, 3] },
        { history: this.lost, paint: "--bad", dash: [2, 3] },
      ],
    }, now);
  }

  describe() {
    const latency = between(this.p99, duration);
    const due = this.deadlineUs === null ? "" : `, deadline ${duration(this.deadlineUs)}`;
    mark(byId("latency-chart"), "aria-label", `Latency over the last minute: 99 % of results ${latency}, pictures on the page ${between(this.page, duration)}${due}`);
    const hertz = (value) => inDigits(Number(value.toPrecision(3)));
    mark(byId("flow-chart"), "aria-label", `Frames a second over the last minute: answered ${between(this.rate, hertz)}, lost ${between(this.lost, hertz)}, shed ${between(this.shed, hertz)}`);
  }
}

function between(history, format) {
  const range = history.range();
  return range ? `${format(range[0])} to ${format(range[1])}` : "not known yet";
}

/** Show something the server says; errors stay until they are put away. */
export function tell({ text, level }) {
  const list = byId("told");
  const kind = Object.hasOwn(WORDS, level) ? level : "note";
  const close = make("button", { type: "button", class: "quiet", "aria-label": "Put away" }, "✕");
  const note = make("p", { class: `say ${kind}` },
    ...(WORDS[kind] ? [make("b", {}, `${WORDS[kind]}:`), " "] : []), text, close);
  close.addEventListener("click", () => note.remove());
  list.append(note);
  while (list.children.length > MOST_TOLD) list.firstChild.remove();
  if (kind !== "error") setTimeout(() => note.remove(), STAYS_MS);
}
