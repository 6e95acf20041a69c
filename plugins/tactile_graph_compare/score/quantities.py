"""What is compared with the truth, and in which unit."""

from __future__ import annotations

from collections.abc import Mapping

QUANTITIES: Mapping[str, str] = {
    "centre": "cm",
    "radius": "cm",
    "length": "cm",
    "breadth": "cm",
    "angle": "°",
    "area": "cm²",
    "count": "",
    "identity": "",
}
"""Quantity -> unit, in the order of the tables."""

DECIMALS: Mapping[str, int] = {"cm": 3, "°": 2, "cm²": 2, "": 3}
"""Unit -> decimals that tables show."""
