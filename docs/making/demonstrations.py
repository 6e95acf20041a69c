"""One frame before and after each step: the pipeline that shows it, its picture, its cost.

A step is shown as `examples.yaml` beside this file has it, else in the shortest shipped pipeline
that has it at its top. Pictures and costs are kept in a folder under a digest of all they hang on,
so that a site is built anew in a fraction of the time.
"""

from __future__ import annotations

import hashlib
import json
import statistics
import time
from dataclasses import asdict, dataclass
from functools import cache
from itertools import cycle, islice
from pathlib import Path

import yaml

from tactile_graph import Pipeline, Result, load, loads
from tactile_graph.draw.display import is_picture
from tactile_graph.draw.strip import figure_bytes, strip_figure
from tactile_graph.inspect import FRAME, NO_VALUE, Node
from tactile_graph.plugins.registry import Registry

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
MOST_FRAMES = 9
MOST_INPUTS = 3
ENOUGH_S, LONGEST_S = 0.05, 0.6
"""How long a cost is measured at least, and the first round of the frames at most."""


@dataclass(frozen=True)
class Demonstration:
    """Where a step is shown.

    Parameters
    ----------
    pipeline : Pipeline
    node : str
        The node of the step.
    shipped : bool
        Whether the pipeline comes with the project, or was written for this page.
    """

    pipeline: Pipeline
    node: str
    shipped: bool

    @property
    def inputs(self) -> list[str]:
        """The names of what the step reads, the frame's image for the frame."""
        node = self.pipeline.nodes[self.node]
        read = [ref for b in node.inputs for ref in b.refs] + list(node.choices)
        names = [FRAME if ref.node == FRAME else str(ref) for ref in read]
        return list(dict.fromkeys(names))[:MOST_INPUTS]


@dataclass(frozen=True)
class Shown:
    """What a demonstration came to.

    Parameters
    ----------
    svg : str
        The picture; empty where nothing has a place on the pad.
    cost_us : float
        Median time of the node over the frames, in µs; of a source, which is no node, 0.
    rows, columns : int
        The frame's.
    frame : int
        Number of the frame drawn.
    note : str
        Why there is no picture, in words.
    """

    svg: str
    cost_us: float
    rows: int
    columns: int
    frame: int
    note: str = ""


@cache
def examples() -> dict[str, dict[str, object]]:
    """Return what is written by hand, by the step's name."""
    text = (HERE / "examples.yaml").read_text("utf-8")
    found: dict[str, dict[str, object]] = yaml.safe_load(text)
    return found


@cache
def shipped(registry: Registry) -> dict[str, Pipeline]:
    """Return every pipeline on offer, by name."""
    return {name: load(name) for name in registry.names("pipelines")}


def demonstration(registry: Registry, step: str) -> Demonstration | str:
    """Return where a step is shown, or why it is not, in a line."""
    told = examples().get(step)
    if told is not None:
        return str(told["why_not"]) if "why_not" in told else _by_hand(step, told)
    uses = [
        (registry.offer("pipelines", name).plugin.name == "thesis", len(p.nodes), name, node.name)
        for name, p in shipped(registry).items()
        for node in p.nodes.values()
        if _is(node, step)
    ]
    if not uses:
        raise LookupError(f"step {step!r} stands in no pipeline: show it in {HERE}/examples.yaml")
    *_, name, node = min(uses)
    return Demonstration(shipped(registry)[name], node, True)


def _is(node: Node, step: str) -> bool:
    return node.signature is not None and node.signature.name == step and "/" not in node.name


def _by_hand(step: str, told: dict[str, object]) -> Demonstration:
    nodes = told["nodes"]
    assert isinstance(nodes, dict)
    last = list(nodes)[-1]
    source = told.get("source", {"step": "sample", "with": {"name": "discs"}})
    text = f"pipeline: {step.replace('_', '-')}-shown\nsource: {_flow(source)}\nnodes:\n"
    text += "".join(f"  {name}: {_flow(body)}\n" for name, body in nodes.items())
    return Demonstration(loads(f"{text}outputs: [{last}]\n", f"example of {step}"), last, False)


def _flow(body: object) -> str:
    return yaml.safe_dump(body, default_flow_style=True, width=10_000, sort_keys=False).strip()


def shown(found: Demonstration, kept: Path) -> Shown:
    """Return picture and cost of a demonstration, from the folder where they are kept if there."""
    signature = found.pipeline.nodes[found.node].signature
    module = "" if signature is None else signature.target.__module__
    parts = (found.pipeline.text, found.node, module.partition(".")[0])
    path = kept / f"{_digest(parts)}.json"
    if path.is_file():
        return Shown(**json.loads(path.read_text("utf-8")))
    made = _show(found)
    kept.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(asdict(made)), "utf-8")
    return made


def strip_of(pipeline: Pipeline, kept: Path) -> Shown:
    """Return the first frame with all outputs, node by node, and what a pipeline costs."""
    path = kept / f"{_digest((pipeline.text, 'strip', ''))}.json"
    if path.is_file():
        return Shown(**json.loads(path.read_text("utf-8")))
    results = _results(pipeline, list(pipeline.outputs))
    drawn = next((r for r in results if r.ok and len(r) == len(pipeline.outputs)), results[-1])
    cost_us = statistics.median(sum(r.times_us.values()) for r in results if r.times_us)
    svg = figure_bytes(strip_figure([drawn]), "svg").decode()
    image = drawn.frame.image
    made = Shown(svg, cost_us, image.rows, image.columns, drawn.frame.index)
    kept.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(asdict(made)), "utf-8")
    return made


def _show(found: Demonstration) -> Shown:
    results = _results(found.pipeline, [found.node])
    drawn = _best(results, found)
    image = drawn.frame.image
    times = [r.times_us[found.node] for r in results if found.node in r.times_us]
    value = drawn.outcome(found.node)
    seen = value.__class__ not in NO_VALUE and is_picture(value)
    names = list(dict.fromkeys([*found.inputs, found.node]))
    svg = figure_bytes(strip_figure([drawn], names), "svg").decode()
    note = "" if seen else "What comes out has no place on the pad: it stands in words."
    is_source = found.pipeline.nodes[found.node].signature is None
    cost_us = 0.0 if is_source else statistics.median(times)
    return Shown(svg, cost_us, image.rows, image.columns, drawn.frame.index, note)


def _results(pipeline: Pipeline, only: list[str]) -> list[Result]:
    """Return the results of a pipeline's frames, run again and again for a while.

    The first frame is run once before, so that no compiler is in any of the times. Costly pipelines
    end after fewer frames, but never before the second.
    """
    frames = list(islice(pipeline.frames(), MOST_FRAMES))
    pipeline.run(frames[0], only)
    runner = pipeline.runner(only)
    results: list[Result] = []
    start = time.perf_counter()
    for frame in cycle(frames):
        results.append(runner(frame))
        spent_s = time.perf_counter() - start
        first_round = len(results) < len(frames) and spent_s < LONGEST_S
        if len(results) > 1 and not first_round and spent_s > ENOUGH_S:
            return results
    return results


def _best(results: list[Result], found: Demonstration) -> Result:
    """Return the first frame in which the node has a value; of a stateful one the last."""
    valued = [r for r in results if r.outcome(found.node).__class__ not in NO_VALUE]
    if not valued:
        raise LookupError(
            f"{found.pipeline.name}: node {found.node!r} has no value: {results[-1].explain()}"
        )
    return valued[-1 if found.pipeline.nodes[found.node].stateful else 0]


@cache
def code_of(package: str) -> str:
    """Return a digest of what draws, and of a family's own code (the wires are the core's)."""
    digest = hashlib.sha256()
    digest.update(Path(__file__).read_bytes())
    places = [ROOT / "tactile_graph" / "draw", ROOT / "tactile_graph" / "wires"]
    places += [ROOT / "plugins" / package] if package else [ROOT / "plugins"]
    for place in places:
        for path in sorted(place.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()


def _digest(parts: tuple[str, str, str]) -> str:
    text = "\0".join((*parts, code_of(parts[2])))
    return hashlib.sha256(text.encode()).hexdigest()[:32]
