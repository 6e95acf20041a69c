// What every part of the page uses to speak with the document. Whatever comes from a file or a
// frame reaches it through textContent or an attribute: it stays text.

/**
 * How long what runs is left as it is written: nobody reads thirty numbers a second, and a screen
 * reader that is told of so many leaves out what matters.
 */
export const WORDS_MS = 250;

export const byId = (id) => document.getElementById(id);

/** Return what a message has under a name; a name like `constructor` finds nothing inherited. */
export const own = (record, name) => (Object.hasOwn(record, name) ? record[name] : undefined);

/** Return a new element with attributes and children; a child that is no element is text. */
export function make(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== undefined && value !== null) made.setAttribute(name, value);
  }
  made.append(...children.map((child) => (child instanceof Node ? child : String(child))));
  return made;
}

/** Write a text where it is not there yet: writing costs a layout, reading does not. */
export function write(element, text) {
  if (element.firstChild?.nodeValue !== text || element.childNodes.length !== 1) {
    element.textContent = text;
  }
}

export function show(element, shown) {
  if (element.hidden === shown) element.hidden = !shown;
}

export function mark(element, name, value) {
  const text = String(value);
  if (element.getAttribute(name) !== text) element.setAttribute(name, text);
}

/** Return a canvas' context, in CSS pixels, its store as fine as the screen. */
export function fitted(canvas) {
  const ratio = Math.min(window.devicePixelRatio || 1, 3);
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== wide || canvas.height !== high) {
    canvas.width = wide;
    canvas.height = high;
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

export const isTyping = (target) =>
  target instanceof HTMLElement &&
  (target.isContentEditable || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName));
