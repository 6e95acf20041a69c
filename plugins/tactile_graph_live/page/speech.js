// What a screen reader hears: at most one sentence every two seconds, and none said twice.

import { byId, write } from "./dom.js";
import { remember, remembered } from "./theme.js";

const APART_MS = 2000;

export class Speech {
  /** `sentence` returns what there is to say just now. */
  constructor(sentence) {
    this.last = "";
    const box = byId("spoken");
    box.checked = remembered("spoken", "yes") === "yes";
    box.addEventListener("change", () => remember("spoken", box.checked ? "yes" : "no"));
    setInterval(() => box.checked && !document.hidden && this.say(sentence()), APART_MS);
  }

  /** Say something now: the answer to a key. */
  say(text) {
    if (text === this.last) return;
    this.last = text;
    write(byId("speech"), text);
  }
}
