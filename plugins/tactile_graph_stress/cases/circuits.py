"""Cases for decouplers: readings of known conductances, and readings no circuit could give."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_stress.case import Case
from tactile_graph_stress.cases.images import image_cases
from tactile_graph_stress.cases.stress_cases import StressCases
from tactile_graph_stress.references.network import readings
from tactile_graph_stress.subject import Subject

Values = NDArray[np.float64]

TRIED: dict[str, dict[str, Any]] = {
    "divider": {"kind": "divider", "bias_ohm": 33e3},
    "divider with drivers": {"kind": "divider", "bias_ohm": 33e3, "driver_ohm": 60.0,
                             "mux_ohm": 100.0},
    "floating": {"kind": "floating", "bias_ohm": 33e3},
    "feedback with drivers": {"kind": "feedback", "bias_ohm": 1e3, "driver_ohm": 50.0},
}  # fmt: skip

LOADS = (
    ("1 to 100 kOhm", -5.0, -3.0),
    ("all 1 MOhm", -6.0, -6.0),
    ("1 kOhm to 10 GOhm", -10.0, -3.0),
    ("all 1 kOhm", -3.0, -3.0),
    ("all 1 GOhm", -9.0, -9.0),
    ("1 Ohm to 1 TOhm", -12.0, 0.0),
)
"""Name, and the powers of ten between which the conductances lie."""

SIZE = 3


def circuit_cases(subject: Subject, rng: np.random.Generator, quick: bool) -> Iterator[Case]:
    """Yield the cases, few of each circuit if ``quick``."""
    few = 3 if quick else 6
    takes_pads = subject.signature.name == "decouple"
    for kind, circuit in TRIED.items() if takes_pads else ():
        pad = _pad(circuit)
        for name, low, high in LOADS[:few]:
            siemens = 10.0 ** rng.uniform(low, high, (SIZE, SIZE))
            volts = readings(pad.circuit, siemens)
            yield Case(
                "truth", f"{kind}, {name}", Image(volts, quantity="volt"),
                settings={"pad": {"circuit": circuit}},
                facts={"circuit": pad.circuit, "siemens": siemens},
            )  # fmt: skip
        for name, share in (("nothing reads", 0.0), ("all read the supply", 1.0),
                            ("all read twice the supply", 2.0), ("below 0", -0.1),
                            ("1e-300 of the supply", 1e-300)):  # fmt: skip
            volts = np.full((SIZE, SIZE), share * pad.circuit.supply_v)
            yield Case("cells", f"{kind}, {name}", Image(volts, quantity="volt"),
                       settings={"pad": {"circuit": circuit}})  # fmt: skip
    yield from image_cases(subject, rng, quick)


def _pad(circuit: dict[str, Any]) -> Any:
    from tactile_graph_pads.pad import load_pad

    return load_pad({"circuit": circuit})


CIRCUITS = StressCases(lambda subject: subject.kind == "decouple", circuit_cases)
