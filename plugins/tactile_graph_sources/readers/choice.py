"""``SeveralSensorsError``: a file holds more than one, and none of them is asked for."""

from __future__ import annotations

from collections.abc import Iterable

from tactile_graph.errors import DataError


class SeveralSensorsError(DataError):
    """A recording of several sensors, nodes, arrays or topics of which one is to be named.

    Parameters
    ----------
    where, what : str
        As of `DataError`.
    sensors : iterable of str
        What the setting ``sensor`` may be.
    """

    def __init__(self, where: str, what: str, sensors: Iterable[str] = ()) -> None:
        super().__init__(where, what)
        self.sensors = tuple(sensors)
