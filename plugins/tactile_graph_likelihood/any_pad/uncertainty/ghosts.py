"""What is said of outlines where a frame looks as on a matrix without isolation."""

from __future__ import annotations

from typing import Any, TypeVar

from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_pads.circuits.ghosts import ADVICE

Found = TypeVar("Found", bound=Posterior)


def as_ghostly(found: Found) -> Found:
    """Return a posterior on any pad of what may be a ghost, or seem larger by some: none fits."""
    return changed(found, ghosts=True)


def tells_of_ghosts(value: Any) -> str:
    """Return what to say of outlines on a frame that seems to hold ghosts; else empty.

    Parameters
    ----------
    value : shape with a posterior, or record of one or several
    """
    shapes = value.shapes if hasattr(value, "shapes") else (getattr(value, "shape", value),)
    if not any(its.posterior.ghosts for its in shapes):
        return ""
    return (
        "elements read something where rows of one object cross columns of another, and not beside "
        "them: this may be a matrix without isolation, whose ghosts pass for objects or widen "
        f"some; {ADVICE}"
    )
