// Light, dark, or as the system has it; and the colours that canvases need as they are just now.

import { byId, write } from "./dom.js";

const CHOICES = ["system", "light", "dark"];
const known = new Map();
const probe = document.createElement("span");

/** Return the present value of a colour of the style sheet, `--ink` say. */
export function colour(name) {
  if (!known.has(name)) {
    probe.style.color = `var(${name})`;
    known.set(name, getComputedStyle(probe).color);
  }
  return known.get(name);
}

export function remembered(key, otherwise) {
  try {
    return localStorage.getItem(`tactile-graph-${key}`) ?? otherwise;
  } catch {
    return otherwise; // a browser that keeps nothing
  }
}

export function remember(key, value) {
  try {
    localStorage.setItem(`tactile-graph-${key}`, value);
  } catch {
    // a browser that keeps nothing
  }
}

/** Make the switch work: `changed` is called whenever colours are others, `say` says what was chosen. */
export function startTheme(changed, say) {
  probe.hidden = true;
  document.body.append(probe);
  let choice = remembered("theme", "system");
  const apply = () => {
    if (!CHOICES.includes(choice)) choice = "system";
    document.documentElement.dataset.theme = choice;
    write(byId("theme"), `Theme: ${choice}`);
    known.clear();
    changed();
  };
  byId("theme").addEventListener("click", () => {
    choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length];
    remember("theme", choice);
    apply();
    say(byId("theme").textContent);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
  apply();
}
