// How a node fared: a shape and a word, never a colour alone.

import { mark, write } from "./dom.js";

const SVG = "http://www.w3.org/2000/svg";
const WORDS = { ran: "ran", reused: "reused", skipped: "skipped", failed: "failed", deadline: "no time" };
const SHAPES = {
  ran: "M3 8.5l3.2 3.2L13 5",
  reused: "M12.5 6A5 5 0 1 0 13 9M13 3v3.4H9.6",
  skipped: "M3 11C4 5 11 4 12.5 10M12.9 6.4v3.9l-3.6-.6",
  failed: "M4 4l8 8M12 4l-8 8",
  deadline: "M8 2.6a5.4 5.4 0 1 0 .01 0M8 5v3.2l2.4 1.6",
};

/** Return the word's key for an outcome; what was skipped for the deadline has one of its own. */
export function fateOf(story) {
  if (!story) return "skipped";
  if (story.outcome === "skipped" && story.reason === "deadline") return "deadline";
  return Object.hasOwn(WORDS, story.outcome) ? story.outcome : "skipped";
}

/** Return a new badge, as yet without an outcome. */
export function badge() {
  const made = document.createElement("span");
  made.className = "badge";
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  svg.append(document.createElementNS(SVG, "path"));
  made.append(svg, document.createElement("span"));
  return made;
}

export function setBadge(made, fate) {
  if (made.dataset.fate === fate) return;
  mark(made, "data-fate", fate);
  made.firstChild.firstChild.setAttribute("d", SHAPES[fate]);
  write(made.lastChild, WORDS[fate]);
}
