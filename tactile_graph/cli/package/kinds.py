"""The kinds of steps that a new package can begin with."""

from __future__ import annotations

from typing import NamedTuple


class Kind(NamedTuple):
    """A kind of step: what it is, which hooks it takes, and how it is tried."""

    about: str
    target: str = "$step"
    """The step in its module: a function of its own name, or a class."""
    hooks: str = ""
    """Hooks beside the one that offers the step."""
    imports: str = ""
    """What these hooks need."""
    try_it: str = "run $step-demo --plot strip.png"
    """The words behind ``tactile-graph`` that show it at work."""


_PIPELINES = '''

@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer the pipeline."""
    folder = Path(__file__).parent / "pipelines"
    return {"$step-demo": folder / "$step-demo.yaml"}
'''
_READERS = '''

@hookimpl
def tactile_graph_readers() -> Mapping[str, str]:
    """Read the recordings of a command line that names the step with ``--source``."""
    return {"$step": "path"}
'''


def _with_pipeline(about: str, target: str = "$step") -> Kind:
    return Kind(about, target, _PIPELINES, "from pathlib import Path\n")


KINDS: dict[str, Kind] = {
    "filter": _with_pipeline("an image made of an image; here each cell less the pad's level"),
    "stateful": _with_pipeline("a step that remembers; here what changes over time", "$Step"),
    "source": _with_pipeline("frames from anywhere; here a load that walks in a circle"),
    "fitter": _with_pipeline("a shape of one's own put to points; here a line with its length"),
    "reader": Kind(
        "frames from a file format of one's own; here lines of numbers",
        hooks=_READERS,
        try_it="run contacts example.txt --source $step --plot strip.png",
    ),
    "restorer": _with_pipeline("an image restored by an energy; here smooth, near what was read"),
}
