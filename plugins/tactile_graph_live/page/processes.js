// Nodes whose steps run in another process: which one that is, and how it fares.

import { own } from "./dom.js";

/** Return the nodes that run apart of a box: itself, or those of the pipeline it runs over a list. */
export function withinOf(name, nodes) {
  return nodes.filter((node) => node.apart && (node.name === name || node.name.startsWith(`${name}/`)))
    .map((node) => ({ node: node.name, within: node.name.slice(name.length + 1), ...node.apart }));
}

/** Return how such nodes' processes fare: in a word or two, in sentences, and whether one starts. */
export function faresInWords(isolated, processes) {
  const all = isolated.map((one) => ({ ...one, fares: own(processes, one.node) }));
  const starting = all.some(({ fares }) => fares?.starting);
  const restarts = Math.max(0, ...all.map(({ fares }) => fares?.restarts ?? 0));
  const short = starting ? "restarting" : `apart${restarts ? `, restarted ${restarts}\u00d7` : ""}`;
  return { short, long: all.map(sentences).join(" "), starting };
}

function sentences({ within, process, time_limit_s: limit, fares }) {
  const who = within ? `${within} runs` : "Runs";
  const where = process ? `in a process shared as ${process}` : "in a process of its own";
  const parts = [`${who} ${where}${limit === null ? "" : `, ended there after ${limit} s`}.`];
  if (fares?.starting) parts.push("It is being started anew.");
  if (fares?.restarts) {
    parts.push(`Started anew ${fares.restarts === 1 ? "once" : `${fares.restarts} times`}; the last ${fares.why}.`);
  }
  return parts.join(" ");
}
