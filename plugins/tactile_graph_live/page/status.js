// The line of numbers on top, the latency chart, and what the server has to say.

import { History, latencyChart } from "./charts.js";
import { byId, make, mark, show, write } from "./dom.js";
import { counted, duration, told as inDigits } from "./numbers.js";

const STAYS_MS = 6000;
const MOST_TOLD = 4;
const MOST_DIFFERENCES = 3;
const WORDS = { note: "", warning: "Warning", error: "Error" };

export class Status {
  constructor() {
    this.median = new History(60);
    this.p99 = new History(60);
    this.deadlineUs = null;
    new ResizeObserver(() => this.chart()).observe(byId("latency-chart"));
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
    write(byId("latency-median"), duration(latency.median));
    write(byId("latency-p99"), duration(latency.p99));
    write(byId("page-latency"), duration(pulse.page_latency_us.median));
    write(byId("viewers"), counted(pulse.viewers));
    write(byId("missed"), counted(pulse.missed));
    byId("missed-stat").classList.toggle("alarm", pulse.missed > 0);
    byId("lost-stat").classList.toggle("alarm", pulse.lost > 0);
    byId("shed-stat").classList.toggle("alarm", pulse.shed > 0);
    this.beside(pulse.beside);
    if (pulse.state === "running" && !pulse.paused) {
      this.median.push(performance.now(), latency.median);
      this.p99.push(performance.now(), latency.p99);
    }
    this.chart();
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

  chart() {
    latencyChart(byId("latency-chart"), this.median, this.p99, this.deadlineUs, performance.now());
  }

  describe() {
    const range = this.p99.range();
    const text = range ? `99 % between ${duration(range[0])} and ${duration(range[1])}` : "nothing yet";
    mark(byId("latency-chart"), "aria-label", `Latency from sensor to result over the last minute: ${text}`);
  }
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
