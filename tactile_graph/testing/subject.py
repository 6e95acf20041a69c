"""A step with its settings, as a test holds it."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactile_graph.engine.outcomes.promises import absent_column, broken_rule, misfit
from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.checks import check_signature
from tactile_graph.steps.settings import spelled, validate_settings
from tactile_graph.steps.signature import Kind, Signature, read_signature

SEED = 7


@dataclass(frozen=True)
class Bound:
    """A step and what it is called with beside its ports; pickled as these."""

    target: Callable[..., Any]
    rest: Mapping[str, Any]

    def __call__(self, **inputs: Any) -> Any:
        """Return what the step gives; its random numbers are the same at every call."""
        return self.target(**inputs, **copy.deepcopy(dict(self.rest)))


@dataclass(frozen=True)
class Subject:
    """A step with its settings, checked as a pipeline's are."""

    signature: Signature
    settings: Mapping[str, Any]

    @property
    def name(self) -> str:
        """The step's name."""
        return self.signature.name

    @property
    def package(self) -> str:
        """Whose lines errors are told by."""
        return self.signature.target.__module__.partition(".")[0]

    def call(self) -> Bound:
        """Return the step, ready for its ports; with a state of its own if it keeps one.

        Raises
        ------
        UsageError
            If its ``__init__`` refuses the settings.
        """
        signature = self.signature
        settings = signature.arguments(self.settings)
        injected: dict[str, Any] = {}
        if signature.rng:
            injected[signature.rng] = np.random.default_rng(SEED)
        if signature.kind is not Kind.CLASS:
            return Bound(signature.target, {**settings, **injected})
        at_init = injected if signature.rng_at_init else {}
        at_call = {} if signature.rng_at_init else injected
        if signature.gap:
            at_call[signature.gap] = None
        try:
            made = signature.target(**settings, **at_init)
        except Exception as error:
            raise UsageError(f"it refuses these settings: {error}") from error
        return Bound(made, at_call)

    def misfit(self, inputs: Mapping[str, Any], value: Any) -> str:
        """Return which promise of type, quantity or grid a value breaks, in words; "" if none."""
        if value is None:
            is_sink = self.signature.output in (None, type(None))
            return "" if is_sink else "returns None; raise Degenerate or Skip with the reason"
        told = misfit(value, self.signature.output) or absent_column(value)
        return told or broken_rule(self.signature, self.settings, inputs.get, value)


def subject_of(
    step: str | Callable[..., Any], settings: Mapping[str, Any], registry: Registry | None = None
) -> Subject:
    """Return a step with its settings.

    Raises
    ------
    PluginError
        If it is no step.
    UsageError
        If a setting is missing or not allowed, or no step of that name is on offer.
    """
    if isinstance(step, str):
        signature = (registry or installed()).step(step)
    else:
        signature = read_signature(getattr(step, "__name__", repr(step)), step)
        check_signature(signature)
    values, troubles = validate_settings(signature, dict(settings))
    if troubles:
        path, what = troubles[0]
        raise UsageError(f"{spelled(path)}: {what}" if path else what)
    return Subject(signature, values)
