// Lines over time on small canvases.

import { fitted } from "./dom.js";
import { duration, ticks } from "./numbers.js";
import { colour } from "./theme.js";

/** What a number was over the last seconds; `push` forgets what is older. */
export class History {
  constructor(seconds) {
    this.ms = seconds * 1000;
    this.times = [];
    this.values = [];
  }

  push(at, value) {
    this.times.push(at);
    this.values.push(Number.isFinite(value) ? value : null);
    let old = 0;
    while (this.times[old] < at - this.ms) old += 1;
    if (old > 64 || this.times.length > 4096) {
      old = Math.max(old, this.times.length - 4096);
      this.times.splice(0, old);
      this.values.splice(0, old);
    }
  }

  /** Lowest and highest of what is kept, or null without any. */
  range() {
    let [low, high] = [Infinity, -Infinity];
    for (const value of this.values) {
      if (value === null) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return low <= high ? [low, high] : null;
  }
}

function drawLine(context, history, x, y) {
  let pen = false;
  context.beginPath();
  history.times.forEach((time, i) => {
    const value = history.values[i];
    if (value === null) {
      pen = false;
      return;
    }
    if (pen) context.lineTo(x(time), y(value));
    else context.moveTo(x(time), y(value));
    pen = true;
  });
  context.stroke();
}

/** Draw the line of one number, from its lowest to its highest, and a dot where it is now. */
export function sparkline(canvas, history, now) {
  const { context, width, height } = fitted(canvas);
  context.clearRect(0, 0, width, height);
  const range = history.range();
  if (!range) return;
  const [low, high] = range;
  const span = high - low || 1;
  const x = (time) => width - 4 - ((now - time) / history.ms) * (width - 6);
  const y = (value) => (high > low ? height - 4 - ((value - low) / span) * (height - 8) : height / 2);
  context.strokeStyle = colour("--accent");
  context.lineWidth = 1.4;
  context.lineJoin = "round";
  drawLine(context, history, x, y);
  const last = history.values.at(-1);
  if (last === null) return;
  context.fillStyle = colour("--found");
  context.beginPath();
  context.arc(x(history.times.at(-1)), y(last), 2.4, 0, 2 * Math.PI);
  context.fill();
}

/** Draw latencies in microseconds over a minute, with axes and the deadline where there is one. */
export function latencyChart(canvas, median, p99, deadlineUs, now) {
  const { context, width, height } = fitted(canvas);
  context.clearRect(0, 0, width, height);
  const edge = { left: 52, right: 8, top: 8, bottom: 22 };
  const highest = Math.max(p99.range()?.[1] ?? 0, median.range()?.[1] ?? 0, (deadlineUs ?? 0) * 1.1, 1) * 1.08;
  const x = (time) => width - edge.right - ((now - time) / median.ms) * (width - edge.left - edge.right);
  const y = (us) => height - edge.bottom - (us / highest) * (height - edge.top - edge.bottom);
  context.font = "11px ui-sans-serif, system-ui, sans-serif";
  context.textBaseline = "middle";
  context.lineWidth = 1;
  for (const us of ticks(0, highest, 4)) {
    context.strokeStyle = colour("--grid");
    context.beginPath();
    context.moveTo(edge.left, Math.round(y(us)) + 0.5);
    context.lineTo(width - edge.right, Math.round(y(us)) + 0.5);
    context.stroke();
    context.fillStyle = colour("--soft");
    context.textAlign = "right";
    context.fillText(us === 0 ? "0" : duration(us), edge.left - 6, y(us));
  }
  context.textBaseline = "top";
  for (const [seconds, align] of [[60, "left"], [30, "center"], [0, "right"]]) {
    context.textAlign = align;
    context.fillText(seconds ? `${seconds} s ago` : "now", x(now - seconds * 1000), height - edge.bottom + 7);
  }
  context.save();
  context.beginPath();
  context.rect(edge.left, 0, width - edge.left, height);
  context.clip();
  context.lineWidth = 1.6;
  for (const [history, paint] of [[p99, "--p99"], [median, "--accent"]]) {
    context.strokeStyle = colour(paint);
    drawLine(context, history, x, y);
  }
  if (deadlineUs) {
    context.setLineDash([5, 4]);
    context.strokeStyle = colour("--bad");
    context.beginPath();
    context.moveTo(edge.left, y(deadlineUs));
    context.lineTo(width - edge.right, y(deadlineUs));
    context.stroke();
  }
  context.restore();
}
