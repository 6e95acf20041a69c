"""How a variant is told from others on the page: by number, and by colour beside it."""

from __future__ import annotations

from tactile_graph_compare.records.comparison import Comparison, Variant
from tactile_graph_compare.report.markup import Html, tag

LIGHT = ("#0072b2", "#b84a00", "#007a5c", "#a63d7f", "#856300", "#4a5ec4", "#576372", "#8f2020")
"""After Okabe and Ito, darkened until white numbers can be read on them."""
DARK = ("#5ab4f0", "#ff9a5c", "#3ccb9e", "#ec9ccb", "#e0bf55", "#a9b4ff", "#b8c1cd", "#f59a94")


def class_of(number: int) -> str:
    """Return the class that sets ``--c`` to a variant's colour; they repeat after eight."""
    return f"v{(number - 1) % len(LIGHT) + 1}"


def paint_of(number: int) -> str:
    """Return the colour on white."""
    return LIGHT[(number - 1) % len(LIGHT)]


def chip(number: int) -> Html:
    """Return the number on its colour."""
    return tag("span", str(number), class_=f"chip {class_of(number)}")


def named(comparison: Comparison, label: str) -> Html:
    """Return a variant's number and label."""
    return of(comparison.variant(label))


def of(variant: Variant) -> Html:
    """Return a variant's number and label."""
    return tag("span", chip(variant.number), " ", variant.label, class_="variant")


def legend(comparison: Comparison) -> Html:
    """Return all variants."""
    items = [tag("li", of(v)) for v in comparison.variants]
    return tag("ul", items, class_="legend", aria_label="variants")
