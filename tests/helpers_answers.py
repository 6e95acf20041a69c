"""What a step gives, as YAML keeps it, and whether two such answers are the same."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest

from helpers_modes import answered_by
from tactile_graph.errors import TactileGraphError
from tactile_graph.wires import Image, Mask, Polygon


class Case(NamedTuple):
    """A step, what it is given, and a name."""

    name: str
    step: Callable[..., Any]
    given: tuple[Any, ...]


def answer(case: Case) -> Any:
    """Return what a step gives in plain code; of a refusal its words."""
    with answered_by("plain"):
        try:
            return told(case.step(*case.given))
        except TactileGraphError as error:
            return f"{type(error).__name__}: {error}"


def told(found: Any) -> Any:
    """Return an answer in numbers, texts, lists and mappings; of an image sums alone."""
    if isinstance(found, np.ndarray):
        if found.dtype == bool:
            return ["".join(".#"[int(on)] for on in row) for row in found]
        return [told(one) for one in found]
    if isinstance(found, (bool, np.bool_)):
        return bool(found)
    if isinstance(found, (int, np.integer)):
        return int(found)
    if isinstance(found, (float, np.floating)):
        return float(f"{found:.10g}") + 0.0
    if isinstance(found, Image):
        weights = np.sqrt(np.arange(1, found.values.size + 1)).reshape(found.shape)
        sums = float(found.values.sum()), float((found.values * weights).sum())
        valid = None if found.valid is None else int((found.valid * weights**2).sum())
        grid = *found.shape, *found.origin_cm, *found.pitch_cm
        return [*told(sums), valid, found.quantity, *told(grid)]
    if isinstance(found, Mask):
        return {"origin_cm": told(found.origin_cm), "cells": told(found.values)}
    if isinstance(found, Polygon):
        return told(found.xy_cm)
    if hasattr(found, "_asdict"):
        return {name: told(one) for name, one in found._asdict().items()}
    if is_dataclass(found):
        return {f.name: told(getattr(found, f.name)) for f in fields(found)}
    return [told(one) for one in found] if isinstance(found, tuple) else found


CREEPS = 100
"""Rounds from which a search creeps: where another processor rounds otherwise, its path differs."""


def alike(one: Any, other: Any, near: float = 1e-8) -> bool:
    """Return whether two answers are the same but for the last digits of numbers."""
    if isinstance(one, dict):
        near = 1e-7 if other.get("iterations", 0) >= CREEPS else near
        return one.keys() == other.keys() and all(
            as_many_rounds(v, other[k]) if k == "iterations" else alike(v, other[k], near)
            for k, v in one.items()
        )
    if isinstance(one, list):
        return len(one) == len(other) and all(
            alike(*pair, near) for pair in zip(one, other, strict=True)
        )
    if isinstance(one, float):
        return one == pytest.approx(other, rel=near, abs=1e-8)
    return bool(one == other)


def as_many_rounds(one: int, other: int) -> bool:
    """Return whether a search took as many rounds; one that creeps, give or take one in twelve."""
    return one == other if other < CREEPS else one == pytest.approx(other, rel=1 / 12, abs=0)
