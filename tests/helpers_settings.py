"""Defaults of all steps of a family, as text."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from importlib import import_module


def defaults(steps: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """Return each step's settings that have a default, and these.

    Parameters
    ----------
    steps : mapping
        Name -> ``module:object``, as a family offers them.
    """
    found = {}
    for name, home in sorted(steps.items()):
        module, _, thing = home.partition(":")
        given = inspect.signature(getattr(import_module(module), thing)).parameters.values()
        told = {p.name: str(p.default) for p in given if p.default is not inspect.Parameter.empty}
        found[name] = told
    return found
