"""The type of options that take a number: a finite one, which click's own are not."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any

import click


class Finite(click.FloatRange):
    """A finite number, within a range where one is told; for the options of plugins too.

    Parameters
    ----------
    min, max : float, optional
    min_open, max_open : bool
        Whether the end itself is left out.
    clamp : bool
        Whether a number beyond an end is taken for that end.
    """

    name = "float"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number; click compares nan with no end of a range, and knows no finite one."""
        number = float(super().convert(value, param, ctx))
        if not isfinite(number):
            within = self._describe_range()
            allowed = f"a finite number in the range {within}" if within else "a finite number"
            self.fail(f"must be {allowed}, got {value}{_hint(number, param)}", param, ctx)
        return number

    def _describe_range(self) -> str:
        """Return the range as help shows it, which click takes to have an end."""
        return "" if self.min is None and self.max is None else super()._describe_range()


def _hint(number: float, param: click.Parameter | None) -> str:
    may_go = param is not None and not (param.required or isinstance(param.default, int | float))
    return "; for no limit leave the option out" if number == inf and may_go else ""
