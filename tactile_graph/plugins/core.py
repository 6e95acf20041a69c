"""What the core offers itself, by the hooks that all plugins answer."""

from __future__ import annotations

from collections.abc import Mapping

from tactile_graph.plugins.hookspecs import hookimpl


@hookimpl
def tactile_graph_quantities() -> Mapping[str, str]:
    """Offer what readings of tactile pads are usually given in.

    ``raw`` is a vendor's unit without a stated meaning; ``level`` and ``binary`` are what images
    become when they are told apart in steps.
    """
    return {
        "counts": "",
        "volt": "V",
        "siemens": "S",
        "gram": "g",
        "kilopascal": "kPa",
        "raw": "",
        "level": "",
        "binary": "",
    }
