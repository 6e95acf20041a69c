"""Every item in the order of the thesis, found by its id, its number or its study's name."""

from __future__ import annotations

from functools import cache
from importlib import import_module

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph_thesis.item import Item

CONTENTS = {
    "chapter_2": (
        "figure_2_2_force_law",
        "section_2_1_2_hysteresis",
        "section_2_2_current",
        "section_2_2_2_converter",
        "section_2_2_3_samples",
        "section_2_3_2_coupling_directions",
        "figures_2_8_to_2_11_bias",
        "figures_2_12_to_2_14_footprints",
        "figures_2_15_to_2_17_groups_of_four",
        "figure_2_18_calibration_curve",
        "figure_2_19_weight_against_area",
        "section_2_4_3_stack_order",
    ),
    "chapter_3": (
        "section_3_1_2_operators",
        "section_3_1_3_morphology",
        "figures_3_2_to_3_6_techniques",
    ),
    "chapter_4": (
        "figures_4_1_to_4_3_threshold",
        "figures_4_4_and_4_5_variance",
        "figures_4_6_to_4_17_discs",
        "figures_4_18_to_4_21_hull",
        "figures_4_22_to_4_28_rectangles",
        "figures_4_29_to_4_36_rounding",
        "figures_4_37_to_4_43_identification",
        "section_4_3_4_broken_image",
        "tables_4_3_to_4_8_errors",
        "section_4_3_9_one_pad",
        "section_4_1_thresholds",
        "section_4_2_2_to_4_5_erosion",
        "section_4_3_5_order_of_rotation",
        "table_4_9_identification",
    ),
    "chapter_5": (
        "section_5_3_2_line_patterns",
        "section_5_4_1_schedule",
        "figures_5_8_to_5_14_restoration",
        "table_5_2_radii",
        "section_5_5_2_heavier_side",
    ),
    "chapter_6": (
        "section_6_1_2_finer_pad",
        "section_6_1_2_heavier_smaller",
        "section_6_1_3_subdivision",
        "section_6_1_3_noise_on_localisers",
        "section_6_1_3_noise_before_blocks",
        "section_6_1_1_site_isolation",
        "section_6_1_3_direct_ellipse",
        "section_6_1_4_restoration",
    ),
}
"""Room of ``items/`` -> its modules, each with a tuple ``ITEMS``."""


@cache
def items() -> tuple[Item, ...]:
    """Return every item in the order of the thesis."""
    found = [
        item
        for room, modules in CONTENTS.items()
        for module in modules
        for item in import_module(f"tactile_graph_thesis.items.{room}.{module}").ITEMS
    ]
    return tuple(sorted(found, key=lambda item: item.place))


def known() -> list[str]:
    """Return every name that `chosen` takes, each once."""
    names = (n for item in items() for n in (item.id, item.number, item.study) if n)
    return ["all", *dict.fromkeys(names)]


def chosen(names: tuple[str, ...]) -> list[Item]:
    """Return the items of these names, each once, in the order of the thesis.

    Parameters
    ----------
    names : tuple of str
        ``4.5`` is the table and the figure of that number; ``table-4.5``, ``figure-4.5`` or the
        name of a study is one; ``all`` is everything.

    Raises
    ------
    UsageError
        If there is none of a name.
    """
    wanted: set[str] = set()
    for name in names:
        found = [i.id for i in items() if name in ("all", i.id, i.number, i.study) and name]
        if not found:
            hint = did_you_mean(name, known())
            raise UsageError(
                f"no table, figure or study named {name!r}{hint}; "
                "'tactile-graph reproduce' lists them"
            )
        wanted |= set(found)
    return [item for item in items() if item.id in wanted]
