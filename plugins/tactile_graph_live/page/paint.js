// Display lists on a canvas: grids of cells beneath, lines over them, words on top. The one place
// that knows what `tactile_graph.draw.display` gives.

import { fitted, own } from "./dom.js";
import { colour } from "./theme.js";

const STOPS = [
  [68, 1, 84], [70, 50, 127], [54, 92, 141], [39, 127, 142], [31, 161, 135], [74, 194, 109],
  [159, 218, 58], [253, 231, 37],
];
const BROKEN = 255;
const FARTHEST_PX = 1e5;
const LONGEST_WORD = 40;
const SMALLEST_TEXT_PX = 6;
const SANS = "ui-sans-serif, system-ui, sans-serif";

const packed = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

function ramp(share) {
  const at = share * (STOPS.length - 1);
  const below = Math.min(Math.floor(at), STOPS.length - 2);
  return STOPS[below].map((low, i) => Math.round(low + (at - below) * (STOPS[below + 1][i] - low)));
}

function palette(colourOf) {
  return Uint32Array.from({ length: 256 }, (_, level) => packed(level === BROKEN ? [120, 120, 120] : colourOf(level / 254)));
}

const HEAT = palette(ramp);
const PALE = palette((share) => [255, 255, 255].map((white) => Math.round(white - 110 * share ** 0.6)));
const YES_NO = palette((share) => (share > 0 ? [55, 71, 79] : [236, 239, 241]));

/** The colours from low to high, as CSS takes them. */
export const heatStops = STOPS.map((stop) => `rgb(${stop.join(",")})`);

/** Return the levels of a grid's cells, 0 to 254 from low to high, 255 without a reading. */
export function levelsOf(grid) {
  if (grid.levels === undefined) {
    const bytes = atob(grid.values);
    grid.levels = Uint8Array.from(bytes, (c) => c.charCodeAt(0));
  }
  return grid.levels;
}

/** Whether it is known what cells read; of a large pad only their colours are. */
export const isExact = (grid) => Boolean(grid.readings);

/** Return what a cell reads, as fine as its colour tells where no more is known; null without a reading. */
export function valueAt(grid, row, column) {
  const cell = row * grid.columns + column;
  const level = levelsOf(grid)[cell];
  if (level === undefined || level === BROKEN) return null;
  if (isExact(grid)) {
    const exact = readingsOf(grid);
    return exact instanceof Float32Array ? Number(exact[cell].toPrecision(7)) : exact[cell];
  }
  const step = (grid.high - grid.low) / 254;
  const fine = 10 ** Math.floor(Math.log10(step || 1));
  return Number((Math.round((grid.low + level * step) / fine) * fine).toPrecision(10));
}

function readingsOf(grid) {
  if (grid.exact === undefined) {
    const bytes = Uint8Array.from(atob(grid.readings), (c) => c.charCodeAt(0));
    const one = bytes.length === 4 * grid.rows * grid.columns ? Float32Array : Float64Array;
    grid.exact = new one(bytes.buffer);
  }
  return grid.exact;
}

export function extentOf(grid) {
  const [x, y] = grid.origin_cm;
  return { left: x, top: y, right: x + grid.columns * grid.pitch_cm[0], bottom: y + grid.rows * grid.pitch_cm[1] };
}

/** Where centimetres of the pad lie on a canvas. */
export class View {
  constructor(extent, left, top, width, height) {
    const wide = Math.max(extent.right - extent.left, 1e-9);
    const high = Math.max(extent.bottom - extent.top, 1e-9);
    this.perCm = Math.min(width / wide, height / high);
    this.extent = extent;
    this.width = wide * this.perCm;
    this.height = high * this.perCm;
    this.left = left + (width - this.width) / 2;
    this.top = top + (height - this.height) / 2;
  }

  x(cm) {
    return clipped(this.left + (cm - this.extent.left) * this.perCm);
  }

  y(cm) {
    return clipped(this.top + (cm - this.extent.top) * this.perCm);
  }
}

const clipped = (px) => Math.max(-FARTHEST_PX, Math.min(FARTHEST_PX, px));
const scratch = document.createElement("canvas");
const scratchContext = scratch.getContext("2d", { willReadFrequently: true });

/** Draw the cells of a grid; `smooth` blends them, for the eye only. */
export function drawGrid(context, view, grid, smooth = false, paints = HEAT) {
  const { rows, columns } = grid;
  if (!(rows > 0 && columns > 0)) return;
  const levels = levelsOf(grid);
  if (scratch.width !== columns || scratch.height !== rows) {
    scratch.width = columns;
    scratch.height = rows;
  }
  const cells = scratchContext.createImageData(columns, rows);
  const pixels = new Uint32Array(cells.data.buffer);
  for (let cell = 0; cell < pixels.length; cell += 1) pixels[cell] = paints[levels[cell] ?? BROKEN];
  scratchContext.putImageData(cells, 0, 0);
  const extent = extentOf(grid);
  const [x, y] = [view.x(extent.left), view.y(extent.top)];
  context.imageSmoothingEnabled = smooth;
  context.imageSmoothingQuality = "high";
  context.drawImage(scratch, x, y, view.x(extent.right) - x, view.y(extent.bottom) - y);
}

/** Draw the numbers of a grid's cells; return whether there is room for them. */
export function drawNumbers(context, view, grid) {
  const [wide, high] = grid.pitch_cm.map((cm) => cm * view.perCm);
  if (Math.min(wide, high) < SMALLEST_TEXT_PX) return false;
  const texts = Array.from({ length: grid.rows * grid.columns }, (_, cell) => {
    const value = valueAt(grid, Math.floor(cell / grid.columns), cell % grid.columns);
    return value === null ? "" : inDigits(grid, value, 3);
  });
  context.font = `100px ${SANS}`;
  const longest = texts.reduce((long, text) => (text.length > long.length ? text : long), "");
  const size = Math.min(13, high / 1.3, (90 * wide) / context.measureText(longest).width);
  if (size < SMALLEST_TEXT_PX) return false;
  context.font = `${size}px ${SANS}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  const extent = extentOf(grid);
  const levels = levelsOf(grid);
  for (let row = 0; row < grid.rows; row += 1) {
    for (let column = 0; column < grid.columns; column += 1) {
      const cell = row * grid.columns + column;
      context.fillStyle = levels[cell] > 140 ? "#10131a" : "#f4f6fa";
      context.fillText(texts[cell], view.x(extent.left + (column + 0.5) * grid.pitch_cm[0]),
        view.y(extent.top + (row + 0.5) * grid.pitch_cm[1]));
    }
  }
  return true;
}

/** Return a reading in so many digits, a whole number in all of its own. */
export function inDigits(grid, value, digits) {
  const residue = 1e-9 * Math.max(Math.abs(grid.low), Math.abs(grid.high)); // of a subtraction
  if (Math.abs(value) < residue) return "0";
  if (Number.isInteger(value) || Math.abs(value) >= 10 ** (digits - 1)) return value.toFixed(0);
  return String(Number(value.toPrecision(digits)));
}

/** Draw a display list: its grids first, then its lines; `scale` is how thick those are. */
export function drawShapes(context, view, shapes, { smooth = false, scale = 1 } = {}) {
  for (const shape of shapes) {
    if (shape.image) drawGrid(context, view, shape.image, smooth, shape.shape === "cells" ? YES_NO : HEAT);
  }
  context.lineCap = "round";
  context.lineJoin = "round";
  for (const shape of shapes) drawShape(context, view, shape, scale);
  context.setLineDash([]);
}

function drawShape(context, view, shape, scale) {
  const ink = colour(shape.role === "true" ? "--true" : "--found");
  if (shape.shape === "text") {
    drawWord(context, view, shape, ink, scale);
    return;
  }
  const path = own(PATHS, shape.shape)?.(shape, view, scale);
  if (!path) return;
  if (shape.fill) {
    context.globalAlpha = 0.3;
    context.fillStyle = ink;
    context.fill(path);
    context.globalAlpha = 1;
    return;
  }
  const points = shape.shape === "points";
  const width = (points ? 4 : 2) * scale;
  const dashes = shape.role === "true" && !points ? [7 * scale, 4 * scale] : [];
  context.setLineDash([]);
  stroke(context, path, "rgba(255,255,255,.85)", width + 2 * scale);
  context.setLineDash(dashes);
  stroke(context, path, ink, width);
}

function stroke(context, path, ink, width) {
  context.strokeStyle = ink;
  context.lineWidth = width;
  context.stroke(path);
}

function drawWord(context, view, { x, y, text }, ink, scale) {
  context.font = `600 ${Math.max(9, 13 * scale)}px ${SANS}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.setLineDash([]);
  context.strokeStyle = "rgba(255,255,255,.9)";
  context.lineWidth = 3.5 * scale;
  const word = String(text).slice(0, LONGEST_WORD);
  context.strokeText(word, view.x(x), view.y(y));
  context.fillStyle = ink;
  context.fillText(word, view.x(x), view.y(y));
}

function through(places, closed, view) {
  const path = new Path2D();
  places.forEach(([x, y], i) => (i ? path.lineTo(view.x(x), view.y(y)) : path.moveTo(view.x(x), view.y(y))));
  if (closed && places.length) path.closePath();
  return path;
}

const PATHS = {
  polygon: ({ xy }, view) => through(xy, true, view),
  polyline: ({ xy }, view) => through(xy, false, view),
  segments({ xy }, view) {
    const path = new Path2D();
    for (const [[x0, y0], [x1, y1]] of xy) {
      path.moveTo(view.x(x0), view.y(y0));
      path.lineTo(view.x(x1), view.y(y1));
    }
    return path;
  },
  points({ xy }, view) {
    const path = new Path2D();
    for (const [x, y] of xy) {
      path.moveTo(view.x(x), view.y(y));
      path.lineTo(view.x(x) + 0.01, view.y(y));
    }
    return path;
  },
  circle({ x, y, radius }, view) {
    const path = new Path2D();
    path.arc(view.x(x), view.y(y), Math.min(Math.abs(radius) * view.perCm, FARTHEST_PX), 0, 2 * Math.PI);
    return path;
  },
  cross({ x, y }, view, scale) {
    const path = new Path2D();
    const [left, top, arm] = [view.x(x), view.y(y), 6 * scale];
    path.moveTo(left - arm, top);
    path.lineTo(left + arm, top);
    path.moveTo(left, top - arm);
    path.lineTo(left, top + arm);
    return path;
  },
};

/**
 * Draw what a node gave into a whole canvas, lines over a pale picture of the pad; false where it
 * has no place there.
 */
export function drawPicture(canvas, shapes, pad, scale) {
  const { context, width, height } = fitted(canvas);
  context.clearRect(0, 0, width, height);
  const drawn = shapes.filter((shape) => shape.shape !== "note");
  if (!drawn.length) return false;
  context.fillStyle = colour("--sheet");
  const view = new View(extentOf(pad), 0, 0, width, height);
  context.fillRect(view.left, view.top, view.width, view.height);
  if (!drawn.some((shape) => shape.image)) drawGrid(context, view, pad, false, PALE);
  drawShapes(context, view, drawn, { scale });
  return true;
}
