// Keys of one letter, where nothing is being typed; they can be switched off.

import { byId, isTyping } from "./dom.js";
import { remember, remembered } from "./theme.js";

const PRESSES = /^(BUTTON|A|SUMMARY)$/;

/** Make keys work: `actions` maps a key to what it does. */
export function startKeys(actions) {
  const box = byId("single-keys");
  box.checked = remembered("keys", "yes") === "yes";
  box.addEventListener("change", () => remember("keys", box.checked ? "yes" : "no"));
  const help = byId("help");
  const open = () => help.open || help.showModal();
  byId("keys").addEventListener("click", open);
  document.addEventListener("keydown", (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey || event.defaultPrevented || event.repeat) return;
    if (isTyping(event.target) && event.target.type !== "range" && event.target.type !== "checkbox") return;
    if (help.open || !box.checked) return;
    const key = event.key.toLowerCase();
    if (key === " " && (PRESSES.test(event.target.tagName) || isTyping(event.target))) return;
    const action = key === "?" ? open : actions[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
