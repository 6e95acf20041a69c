// The pad: cells with what was found over them, axes in centimetres, a bar of colours, where
// contacts came from, and the value of the cell that is pointed at.

import { byId, fitted, make, mark, write } from "./dom.js";
import { ticks } from "./numbers.js";
import { View, drawGrid, drawNumbers, drawShapes, extentOf, heatStops, inDigits, isExact, valueAt } from "./paint.js";
import { colour, remember, remembered } from "./theme.js";

const MARGIN = { left: 38, top: 8, right: 72, bottom: 34 };
const TRAIL_S = 2;
const READOUT_MS = 200;
const LONGEST_GAP_S = 0.5;
const LONGEST_JUMP_CM = 3;
const MOST_PLACES = 90;
const LEAST_PX = 160;
const MOST_OF_WINDOW = 0.6;

export class Pad {
  constructor() {
    this.canvas = byId("pad-canvas");
    this.frame = null;
    this.cell = null;
    this.trails = new Map();
    this.toldAt = 0;
    this.canvas.addEventListener("pointermove", (event) => this.point(event));
    this.canvas.addEventListener("pointerleave", () => this.move(null));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    for (const name of ["smooth", "numbers"]) {
      const box = byId(name);
      box.checked = remembered(name, "") === "yes";
      box.addEventListener("change", () => {
        remember(name, box.checked ? "yes" : "no");
        this.draw();
      });
    }
    new ResizeObserver(() => this.resized()).observe(this.canvas);
    addEventListener("resize", () => this.resized());
  }

  /** Whether any object left a trail. */
  get moved() {
    return [...this.trails.values()].some((trail) => trail.length > 3);
  }

  /** Show a frame. */
  paint(frame) {
    const before = this.frame?.pad;
    this.frame = frame;
    if (!before || String(gridOf(before)) !== String(gridOf(frame.pad))) this.begin();
    this.follow(frame);
    this.draw();
    if (performance.now() - this.toldAt > READOUT_MS) this.tell();
  }

  resized() {
    this.shape();
    this.draw();
  }

  /** Another pad: nothing of the one before holds. */
  begin() {
    this.cell = null;
    this.trails.clear();
    this.shape();
  }

  /** Give the canvas the height that suits the pad and the window. */
  shape() {
    if (!this.frame) return;
    const { left, top, right, bottom } = extentOf(this.frame.pad);
    const across = this.canvas.clientWidth - MARGIN.left - MARGIN.right;
    const ideal = (across * (bottom - top)) / (right - left) + MARGIN.top + MARGIN.bottom;
    const height = Math.max(LEAST_PX, Math.min(ideal, MOST_OF_WINDOW * window.innerHeight));
    this.canvas.style.height = `${Math.round(height)}px`;
  }

  /** Remember where objects were, for as long as their trail is shown. */
  follow(frame) {
    const now = frame.time_s ?? 0;
    const places = placesOf(frame.rows);
    for (const [key, [x, y]] of places) {
      const trail = this.trails.get(key) ?? [];
      const [lastX, lastY, last] = trail.at(-1) ?? [x, y, now];
      const jumped = now < last || now > last + LONGEST_GAP_S || Math.hypot(x - lastX, y - lastY) > LONGEST_JUMP_CM;
      if (jumped) trail.length = 0; // scrubbed, or another object
      trail.push([x, y, now]);
      while (trail[0][2] < now - TRAIL_S || trail.length > MOST_PLACES) trail.shift();
      this.trails.set(key, trail);
    }
    for (const key of this.trails.keys()) if (!places.has(key)) this.trails.delete(key);
  }

  draw() {
    const { context, width, height } = fitted(this.canvas);
    context.clearRect(0, 0, width, height);
    if (!this.frame || width < 60) return;
    const grid = this.frame.pad;
    const view = new View(extentOf(grid), MARGIN.left, MARGIN.top,
      width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom);
    this.view = view;
    drawGrid(context, view, grid, byId("smooth").checked);
    const room = !byId("numbers").checked || drawNumbers(context, view, grid);
    write(byId("numbers-word"), room ? "numbers" : "numbers: no room");
    this.drawTrails(context, view);
    context.save();
    context.beginPath();
    context.rect(view.left - 4, view.top - 4, view.width + 8, view.height + 8);
    context.clip();
    drawShapes(context, view, this.frame.drawing, { scale: Math.max(0.8, width / 620) });
    context.restore();
    this.drawAxes(context, view);
    this.drawBar(context, view, grid);
    this.drawCell(context, view, grid);
  }

  drawTrails(context, view) {
    context.lineCap = "round";
    context.strokeStyle = colour("--found");
    for (const trail of this.trails.values()) {
      for (let i = 1; i < trail.length; i += 1) {
        context.globalAlpha = 0.75 * (i / trail.length);
        context.lineWidth = 1 + 2 * (i / trail.length);
        context.beginPath();
        context.moveTo(view.x(trail[i - 1][0]), view.y(trail[i - 1][1]));
        context.lineTo(view.x(trail[i][0]), view.y(trail[i][1]));
        context.stroke();
      }
    }
    context.globalAlpha = 1;
  }

  drawAxes(context, view) {
    const { left, right, top, bottom } = view.extent;
    const [foot, side] = [view.top + view.height, view.left];
    context.strokeStyle = colour("--soft");
    context.fillStyle = colour("--soft");
    context.lineWidth = 1;
    context.font = "11px ui-sans-serif, system-ui, sans-serif";
    context.beginPath();
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const tick of ticks(left, right, view.width / 70)) {
      const x = Math.round(view.x(tick)) + 0.5;
      context.moveTo(x, foot);
      context.lineTo(x, foot + 4);
      context.fillText(String(tick), x, foot + 6);
    }
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const tick of ticks(top, bottom, view.height / 60)) {
      const y = Math.round(view.y(tick)) + 0.5;
      context.moveTo(side - 4, y);
      context.lineTo(side, y);
      context.fillText(String(tick), side - 6, y);
    }
    context.stroke();
    context.textBaseline = "alphabetic";
    context.textAlign = "center";
    context.fillText("x, cm", side + view.width / 2, foot + 31);
    context.save();
    context.translate(side - 28, view.top + view.height / 2);
    context.rotate(-Math.PI / 2);
    context.fillText("y, cm", 0, 0);
    context.restore();
  }

  drawBar(context, view, grid) {
    const [x, width] = [view.left + view.width + 12, 12];
    const paint = context.createLinearGradient(0, view.top + view.height, 0, view.top);
    heatStops.forEach((stop, i) => paint.addColorStop(i / (heatStops.length - 1), stop));
    context.fillStyle = paint;
    context.fillRect(x, view.top, width, view.height);
    context.fillStyle = colour("--soft");
    context.font = "11px ui-sans-serif, system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    const span = grid.high - grid.low || 1;
    for (const tick of ticks(grid.low, grid.high, view.height / 60)) {
      const y = view.top + view.height * (1 - (tick - grid.low) / span);
      context.fillText(String(tick), x + width + 5, Math.max(view.top + 5, y));
    }
    context.save();
    context.translate(x + width + 44, view.top + view.height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(measured(grid), 0, 0);
    context.restore();
  }

  drawCell(context, view, grid) {
    if (!this.cell) return;
    const [row, column] = this.cell;
    const { left, top } = extentOf(grid);
    const [w, h] = grid.pitch_cm;
    const at = [view.x(left + column * w), view.y(top + row * h), w * view.perCm, h * view.perCm];
    context.lineWidth = 3;
    context.strokeStyle = "#fff";
    context.strokeRect(...at);
    context.lineWidth = 1.5;
    context.strokeStyle = "#000";
    context.strokeRect(...at);
  }

  point(event) {
    if (!this.frame || !this.view) return;
    const box = this.canvas.getBoundingClientRect();
    const { left, top } = extentOf(this.frame.pad);
    const [w, h] = this.frame.pad.pitch_cm;
    const column = Math.floor(((event.clientX - box.left - this.view.left) / this.view.perCm + this.view.extent.left - left) / w);
    const row = Math.floor(((event.clientY - box.top - this.view.top) / this.view.perCm + this.view.extent.top - top) / h);
    const within = row >= 0 && column >= 0 && row < this.frame.pad.rows && column < this.frame.pad.columns;
    this.move(within ? [row, column] : null);
  }

  key(event) {
    const steps = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
    if (!this.frame || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === "Escape" && this.cell) {
      event.stopPropagation();
      this.move(null);
      this.telling("no cell chosen");
    }
    if (!steps[event.key]) return;
    event.preventDefault();
    const { rows, columns } = this.frame.pad;
    const [row, column] = this.cell ?? [Math.floor(rows / 2), Math.floor(columns / 2)];
    const [down, right] = this.cell ? steps[event.key] : [0, 0];
    this.move([(row + down + rows) % rows, (column + right + columns) % columns]);
    this.telling(byId("readout").textContent);
  }

  /** A slider through the cells: only with one do screen readers leave the arrow keys to the page. */
  telling(words) {
    const { rows, columns } = this.frame.pad;
    mark(this.canvas, "aria-valuemax", rows * columns - 1);
    mark(this.canvas, "aria-valuenow", this.cell ? this.cell[0] * columns + this.cell[1] : 0);
    mark(this.canvas, "aria-valuetext", words);
  }

  move(cell) {
    if (String(cell) === String(this.cell)) return;
    this.cell = cell;
    this.draw();
    this.tell();
  }

  /** Tell the value of the cell that is pointed at. */
  tell() {
    this.toldAt = performance.now();
    write(byId("readout"), this.cell ? this.cellInWords() : "\u00a0");
  }

  cellInWords() {
    const [row, column] = this.cell;
    const grid = this.frame.pad;
    const { left, top } = extentOf(grid);
    const value = valueAt(grid, row, column);
    const x = left + (column + 0.5) * grid.pitch_cm[0];
    const y = top + (row + 0.5) * grid.pitch_cm[1];
    const read = value === null ? "no reading" : reading(grid, value);
    return `Row ${row}, column ${column}: ${read}, at ${x.toFixed(1)}, ${y.toFixed(1)} cm`;
  }

  /** Return in words what a look at the pad tells. */
  inWords() {
    if (!this.frame) return "The pad; no frame yet";
    const grid = this.frame.pad;
    let best = null;
    for (let row = 0; row < grid.rows; row += 1) {
      for (let column = 0; column < grid.columns; column += 1) {
        const value = valueAt(grid, row, column);
        if (value !== null && (best === null || value > best[0])) best = [value, row, column];
      }
    }
    const size = `The pad, ${grid.rows} rows of ${grid.columns} cells, ${measured(grid)}`;
    return best ? `${size}; highest ${reading(grid, best[0])} at row ${best[1]}, column ${best[2]}` : size;
  }
}


/** Return a reading in words, and whether it is told by its colour alone. */
const reading = (grid, value) => `${isExact(grid) ? "" : "about "}${inDigits(grid, value, 4)} ${grid.unit || ""}`.trim();

const gridOf = (pad) => [pad.rows, pad.columns, ...pad.pitch_cm, ...pad.origin_cm];

const measured = (grid) => (grid.unit && grid.unit !== grid.quantity ? `${grid.quantity}, ${grid.unit}` : grid.quantity || "");

/** Return where each object that is known again is: [x, y] in cm by its output and number. */
export function placesOf(rows) {
  const places = new Map();
  for (const row of rows) {
    const field = Object.keys(row).find((key) => /(^|\.)x_cm$/.test(key));
    const [x, y] = [row[field], row[field?.replace(/x_cm$/, "y_cm")]];
    const alone = !rows.some((other) => other !== row && other.output === row.output);
    const id = row.id ?? row.number;
    if (id === undefined && !alone) continue; // which of them it was before, nobody knows
    if (Number.isFinite(x) && Number.isFinite(y)) places.set(`${row.output} ${id ?? ""}`, [x, y]);
  }
  return places;
}

/** Show what lines over the pad mean. */
export function legend(frame, pad) {
  const list = byId("legend");
  const roles = new Set(frame.drawing.map((shape) => shape.role));
  const wanted = [
    roles.has("found") && ["stroke found", "found"],
    roles.has("true") && ["stroke true", "truly there"],
    pad.moved && ["stroke trail", "where it came from"],
    frame.pad.levels?.includes(255) && ["swatch broken", "no reading"],
  ].filter(Boolean);
  const key = wanted.map(([, word]) => word).join();
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  list.replaceChildren(...wanted.map(([look, word]) =>
    make("li", {}, make("span", { class: look, "aria-hidden": "true" }), word)));
}

export const describe = (pad) => mark(pad.canvas, "aria-label", pad.inWords());
