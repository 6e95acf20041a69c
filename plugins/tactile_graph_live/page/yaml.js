// The pipeline as the file would have it, with the lines marked that differ from the file's.

import { byId, make, show, write } from "./dom.js";

export class Yaml {
  /** `save` is called with the name to save it under. */
  constructor(save) {
    byId("save-form").addEventListener("submit", (event) => {
      event.preventDefault();
      const name = byId("save-name").value.trim();
      if (name) save(name);
      else byId("save-name").focus();
    });
  }

  take(graph) {
    const lines = graph.yaml.trimEnd().split("\n");
    const marks = changes(graph.file_yaml.trimEnd().split("\n"), lines);
    const list = byId("yaml");
    while (list.children.length > lines.length) list.lastChild.remove();
    while (list.children.length < lines.length) list.append(make("li"));
    lines.forEach((line, i) => {
      const element = list.children[i];
      if (element.dataset.text === line && element.className === marks[i]) return;
      element.dataset.text = line;
      element.className = marks[i];
      element.replaceChildren(...(marks[i] ? [make("span", { class: "unseen" }, `${marks[i]}: `)] : []), ...coloured(line));
    });
    const n = marks.filter(Boolean).length;
    write(byId("file-sum"), n ? `${n} ${n === 1 ? "line differs" : "lines differ"} from the file` : "as saved");
    if (!byId("save-name").value) byId("save-name").value = `${graph.name}-live`;
  }
}

/** Return for each new line "" where the old text has it too, else "changed" or "added". */
export function changes(before, after) {
  let head = 0;
  while (head < before.length && head < after.length && before[head] === after[head]) head += 1;
  let tail = 0;
  while (tail < Math.min(before.length, after.length) - head && before.at(-1 - tail) === after.at(-1 - tail)) tail += 1;
  const [old, young] = [before.slice(head, before.length - tail), after.slice(head, after.length - tail)];
  const kept = commonLines(old, young);
  const word = old.length - kept.size >= young.length - kept.size ? "changed" : "added";
  return after.map((_, i) => {
    const within = i >= head && i < after.length - tail;
    return within && !kept.has(i - head) ? word : "";
  });
}

function commonLines(old, young) {
  const longest = Array.from({ length: old.length + 1 }, () => new Uint16Array(young.length + 1));
  for (let i = old.length - 1; i >= 0; i -= 1) {
    for (let j = young.length - 1; j >= 0; j -= 1) {
      longest[i][j] = old[i] === young[j] ? longest[i + 1][j + 1] + 1 : Math.max(longest[i + 1][j], longest[i][j + 1]);
    }
  }
  const kept = new Set();
  for (let i = 0, j = 0; i < old.length && j < young.length; ) {
    if (old[i] === young[j]) {
      kept.add(j);
      i += 1;
      j += 1;
    } else if (longest[i + 1][j] >= longest[i][j + 1]) i += 1;
    else j += 1;
  }
  return kept;
}

function coloured(line) {
  if (/^\s*#/.test(line)) return [make("span", { class: "comment" }, line)];
  const found = /^(\s*(?:- )?)([^:#'"{}[\]\s][^:#]*)(:)(\s.*|)$/.exec(line);
  if (!found) return [line || " "];
  const [, indent, key, colon, rest] = found;
  return [indent, make("span", { class: "key" }, key), colon, rest];
}

/** Show what is wrong with the file as it was saved, or that it is right again. */
export function trouble({ errors, title }) {
  const banner = byId("trouble");
  show(banner, errors.length > 0);
  const many = `${errors.length} errors`;
  const said = title || `The file as saved has ${errors.length === 1 ? "an error" : many}.`;
  write(byId("trouble-title"), `${said} The old graph still runs.`);
  const key = JSON.stringify(errors);
  if (banner.dataset.key === key) return;
  banner.dataset.key = key;
  byId("trouble-list").replaceChildren(...errors.map(({ line, column, text }) =>
    make("li", {}, ...(line > 0 ? [make("b", {}, `Line ${line}, column ${column}`), ": "] : []), text)));
}
