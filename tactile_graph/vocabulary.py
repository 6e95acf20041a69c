"""``Vocabulary``: names that plugins offer and that mean the same wherever they are read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module

_REGISTRY = "tactile_graph.plugins.registry"
"""By name, as plugins name what they offer: the registry knows who reads these words."""


class Vocabulary(Mapping[str, str]):
    """Name -> what is printed for it, over the whole process.

    Registries enter what their plugins offer. Whoever asks for a name before there is any has the
    installed plugins found.
    """

    _asking = False

    def __init__(self) -> None:
        self._words: dict[str, str] = {}

    def enter(self, name: str, word: str) -> None:
        """Make a name known."""
        self._words[name] = word

    def __getitem__(self, name: str) -> str:
        if name not in self._words:
            self._ask()
        return self._words[name]

    def __iter__(self) -> Iterator[str]:
        self._ask()
        return iter(tuple(self._words))

    def __len__(self) -> int:
        self._ask()
        return len(self._words)

    def _ask(self) -> None:
        if Vocabulary._asking:  # a plugin may read a name while it is found
            return
        Vocabulary._asking = True
        try:
            import_module(_REGISTRY).installed()
        finally:
            Vocabulary._asking = False


QUANTITIES = Vocabulary()
"""What the values of an image mean -> their unit; "" where the quantity is its own unit."""
UNITS = Vocabulary()
"""How a unit is spelled in the name of a field (``cm2``) -> how people write it (``cm²``)."""

_PER = {("N", "cm²"), ("g", "cm²"), ("V", "s"), ("V", "g"), ("V", "N")}
"""Units of one letter, and what they are often divided by: such a letter may be an axis, too."""
_ALSO_TIMES = ("N", "g")
"""Units of one letter that are as often multiplied: ``torque_n_cm``."""


def words_and_unit(name: str) -> tuple[str, str]:
    """Return a field's words and its unit: ``("radius", "cm")`` of ``radius_cm``.

    A unit before the unit is what there is per that: ``("pressure", "N/cm²")`` of
    ``pressure_n_cm2``, unless somebody offers both together as a unit of its own. There is none
    where both may be multiplied as well: ``torque_n_cm`` is in N cm, ``stiffness_n_cm`` in N/cm.
    A letter may be an axis: ``centre_v_cm`` is in cm.
    """
    for n_words in (2, 1):  # vx_cm_s is in cm_s, not in s
        head, *tail = name.rsplit("_", n_words)
        if head and tail and (unit := UNITS.get("_".join(tail), "")):
            words, _, before = head.rpartition("_")
            of = UNITS.get(before, "") if words else ""
            if (len(before) > 1 and of) or (of, unit) in _PER:
                return words.replace("_", " "), f"{of}/{unit}"
            if of in _ALSO_TIMES:
                return words.replace("_", " "), ""
            return head.replace("_", " "), unit
    return name.replace("_", " "), ""


def error_name(measure: str) -> str:
    """Return the name of a measure's error: ``pressure_error_n_cm2`` of ``pressure_n_cm2``."""
    words, _ = words_and_unit(measure)
    head, unit = measure[: len(words)], measure[len(words) + 1 :]
    if not unit:
        head, _, unit = measure.rpartition("_")
    return f"{head}_error_{unit}"
