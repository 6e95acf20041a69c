// Lines over time on small canvases.

import { fitted } from "./dom.js";
import { short, ticks } from "./numbers.js";
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

const EDGE = { left: 52, right: 8, top: 20, bottom: 22 };
const LETTERS = "11px ui-sans-serif, system-ui, sans-serif";

/**
 * Draw lines from 0 up over the time their histories keep, with axes.
 *
 * `lines` have a `history`, a `paint` (a colour of the style sheet) and a `dash`; `level` is drawn
 * all the way, `title` says what goes up, and `format` writes a number of the axis.
 */
export function lineChart(canvas, { lines, level, title, format }, now) {
  const { context, width, height } = fitted(canvas);
  context.clearRect(0, 0, width, height);
  const { ms } = lines[0].history;
  const most = lines.map(({ history }) => history.range()?.[1] ?? 0);
  const highest = Math.max(...most, (level ?? 0) * 1.1, 1) * 1.08;
  const x = (time) => width - EDGE.right - ((now - time) / ms) * (width - EDGE.left - EDGE.right);
  const y = (value) => height - EDGE.bottom - (value / highest) * (height - EDGE.top - EDGE.bottom);
  context.font = LETTERS;
  drawAxes(context, width, { x, y, highest, title, format, now, seconds: ms / 1000 });
  context.save();
  context.beginPath();
  context.rect(EDGE.left, 0, width - EDGE.left, height);
  context.clip();
  context.lineWidth = 1.6;
  for (const { history, paint, dash } of lines) {
    context.setLineDash(dash);
    context.strokeStyle = colour(paint);
    drawLine(context, history, x, y);
  }
  if (level) {
    context.setLineDash([5, 4]);
    context.strokeStyle = colour("--bad");
    drawLevel(context, width, y(level));
  }
  context.restore();
}

function drawAxes(context, width, { x, y, highest, title, format, now, seconds }) {
  context.lineWidth = 1;
  context.strokeStyle = colour("--grid");
  context.fillStyle = colour("--soft");
  context.textBaseline = "middle";
  context.textAlign = "right";
  for (const value of ticks(0, highest, 4)) {
    drawLevel(context, width, Math.round(y(value)) + 0.5);
    context.fillText(value === 0 ? "0" : short(format(value)), EDGE.left - 6, y(value));
  }
  context.textBaseline = "top";
  context.textAlign = "left";
  context.fillText(title, EDGE.left, 2);
  for (const [ago, align] of [[seconds, "left"], [seconds / 2, "center"], [0, "right"]]) {
    context.textAlign = align;
    context.fillText(ago ? `${ago} s ago` : "now", x(now - ago * 1000), y(0) + 7);
  }
}

function drawLevel(context, width, y) {
  context.beginPath();
  context.moveTo(EDGE.left, y);
  context.lineTo(width - EDGE.right, y);
  context.stroke();
}
