// Which lanes the wires of a graph take beside the list of its nodes, as histories of a repository
// are drawn: a node stands in one lane, and its lane goes on until the last that reads it.

/** Return nodes ({name, …}) so that each stands after what it reads, else as they were. */
export function ordered(nodes, wires) {
  const waiting = new Map(nodes.map((node) => [node.name, new Set()]));
  for (const { start, end } of wires) {
    if (waiting.has(start) && start !== end) waiting.get(end)?.add(start);
  }
  const left = [...nodes];
  const found = [];
  while (left.length) {
    const next = Math.max(0, left.findIndex((node) => waiting.get(node.name).size === 0));
    const [node] = left.splice(next, 1);
    for (const names of waiting.values()) names.delete(node.name);
    found.push(node);
  }
  return found;
}

/**
 * Return the rows beside ordered nodes, and how many lanes there are. A row has its `lane`, the
 * wires that arrive (`from` lane, `kind`), the lanes that pass, and whether its own goes on.
 */
export function rails(nodes, wires) {
  const rowOf = new Map(nodes.map((node, row) => [node.name, row]));
  const reads = nodes.map(() => []);
  const lastReader = nodes.map((_, row) => row);
  for (const { start, end, kind } of wires) {
    const [from, to] = [rowOf.get(start), rowOf.get(end)];
    if (from === undefined || to === undefined || from >= to) continue;
    reads[to].push({ from, kind });
    lastReader[from] = Math.max(lastReader[from], to);
  }
  const owners = []; // by lane: the row whose value runs there, or null
  const lanes = [];
  const rows = nodes.map((node, row) => {
    const arriving = reads[row].map(({ from, kind }) => ({ from: lanes[from], kind }));
    owners.forEach((owner, lane) => {
      if (owner !== null && lastReader[owner] <= row) owners[lane] = null;
    });
    const passing = owners.flatMap((owner, lane) => (owner === null ? [] : [lane]));
    const inherited = arriving.find(({ from }) => owners[from] === null)?.from;
    const free = inherited ?? owners.indexOf(null);
    const lane = free >= 0 ? free : owners.length;
    lanes[row] = lane;
    const goesOn = lastReader[row] > row;
    owners[lane] = goesOn ? row : null;
    return { lane, arriving, passing, goesOn };
  });
  return { rows, count: Math.max(1, owners.length) };
}
