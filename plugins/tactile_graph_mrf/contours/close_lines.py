"""Step ``close_lines``: short gaps in a line field closed, where the image steps most."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from typing import Annotated, TypeAlias

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_mrf.contours.regions import require_grid
from tactile_graph_mrf.energy.line_field import LineField

Corner: TypeAlias = tuple[int, int]
"""Where four cells meet, or a place on the pad's rim: (row, column) of the cell below right."""
Site: TypeAlias = tuple[bool, int, int]
"""A line site: whether it is vertical, and its place in `LineField`."""
Path: TypeAlias = tuple[float, Corner, tuple[Site, ...]]

DETOUR = 2
"""A gap is closed if the way round it along lines is more than this many times as long."""


def close_lines(
    image: Image,
    lines: LineField,
    *,
    longest: Annotated[int, Ge(0), Le(6)] = 2,
    least_step: Annotated[float, Ge(0)] = 0.2,
) -> LineField:
    """Return the line field with the gaps in its contours closed.

    From each end of a line the cheapest way over sites that are off, to another line or to the
    pad's rim, is switched on; a site costs 1, less by up to a half the more the image steps
    there. Cheapest first. Left out are ways along which the image hardly steps, and ways that are
    no shortcut (their line leads there too, in at most twice their length), for they would enclose
    nothing.

    Parameters
    ----------
    image : Image
        As restored.
    lines : LineField
        On the same grid.
    longest : int
        Sites a gap may have at most.
    least_step : float
        What the image's mean step along a way must exceed, over its mean step across the lines.

    Returns
    -------
    LineField

    Raises
    ------
    DataError
        If the lines are not those of the image's grid.
    """
    require_grid(lines, image)
    field = _Field(image, lines, least_step)
    waiting = [path for end in field.ends() for path in field.closing(end, longest)]
    for _, end, _ in sorted(waiting):
        # A gap closed before may have reached this end, or made its way no shortcut any more.
        if len(field.on(end)) == 1:
            again = field.closing(end, longest)
            for site in again[0][2] if again else ():
                field.switch(site)
    return LineField.of(image, field.horizontal, field.vertical)


class _Field:
    """Lines as a graph of corners joined by sites.

    Parameters
    ----------
    image : Image
    lines : LineField
    least_step : float
        Over the mean step across the lines.
    """

    def __init__(self, image: Image, lines: LineField, least_step: float) -> None:
        self.rows, self.columns = image.shape
        self.horizontal, self.vertical = lines.horizontal.copy(), lines.vertical.copy()
        values = np.where(np.isfinite(image.values), image.values, 0.0)
        self._steps = [np.abs(np.diff(values, axis=0)), np.abs(np.diff(values, axis=1))]
        self._most = max(float(s.max(initial=0.0)) for s in self._steps) or 1.0
        across, down = self._steps[0][lines.horizontal], self._steps[1][lines.vertical]
        on = np.concatenate([across, down])
        self._least = least_step * float(on.mean()) if on.size else 0.0

    def switch(self, site: Site) -> None:
        """Switch a site on."""
        vertical, i, j = site
        (self.vertical if vertical else self.horizontal)[i, j] = True

    def is_on(self, site: Site) -> bool:
        """Return whether a site is on."""
        vertical, i, j = site
        return bool((self.vertical if vertical else self.horizontal)[i, j])

    def at_rim(self, corner: Corner) -> bool:
        """Return whether a corner lies on the rim of the pad."""
        return corner[0] in (0, self.rows) or corner[1] in (0, self.columns)

    def sites(self, corner: Corner) -> Iterator[tuple[Site, Corner]]:
        """Yield the sites that meet at a corner, each with the corner at its other end."""
        i, j = corner
        if 0 < i < self.rows:
            if j > 0:
                yield (False, i - 1, j - 1), (i, j - 1)
            if j < self.columns:
                yield (False, i - 1, j), (i, j + 1)
        if 0 < j < self.columns:
            if i > 0:
                yield (True, i - 1, j - 1), (i - 1, j)
            if i < self.rows:
                yield (True, i, j - 1), (i + 1, j)

    def on(self, corner: Corner) -> list[Corner]:
        """Return the corners that lines, or the rim, join with this one."""
        joined = [other for site, other in self.sites(corner) if self.is_on(site)]
        return joined + [other for other in self._along_rim(corner) if other not in joined]

    def _along_rim(self, corner: Corner) -> list[Corner]:
        i, j = corner
        beside = [(i, j - 1), (i, j + 1)] if i in (0, self.rows) else []
        beside += [(i - 1, j), (i + 1, j)] if j in (0, self.columns) else []
        return [(a, b) for a, b in beside if 0 <= a <= self.rows and 0 <= b <= self.columns]

    def ends(self) -> list[Corner]:
        """Return the corners within the pad where one line alone ends."""
        count = np.zeros((self.rows + 1, self.columns + 1), np.int64)
        count[1:-1, :-1] += self.horizontal
        count[1:-1, 1:] += self.horizontal
        count[:-1, 1:-1] += self.vertical
        count[1:, 1:-1] += self.vertical
        inside: NDArray[np.int64] = np.argwhere(count[1:-1, 1:-1] == 1) + 1
        return [(int(i), int(j)) for i, j in inside]

    def closing(self, end: Corner, longest: int) -> list[Path]:
        """Return the cheapest way that closes a gap (cost, end, sites), in a list; none: empty."""
        near = self._along_lines(end, DETOUR * longest)
        heap: list[tuple[float, tuple[Site, ...], Corner]] = [(0.0, (), end)]
        while heap:
            cost, path, corner = heapq.heappop(heap)
            if path and (self.at_rim(corner) or self.on(corner)):
                shortcut = near.get(corner, DETOUR * longest + 1) > DETOUR * len(path)
                if shortcut and sum(map(self._step, path)) > self._least * len(path):
                    return [(cost, end, path)]
                continue
            if len(path) < longest:
                for site, other in self.sites(corner):
                    if not self.is_on(site) and site not in path:
                        heapq.heappush(heap, (cost + self._cost(site), (*path, site), other))
        return []

    def _step(self, site: Site) -> float:
        vertical, i, j = site
        return float(self._steps[vertical][i, j])

    def _cost(self, site: Site) -> float:
        return 1.0 - 0.5 * self._step(site) / self._most

    def _along_lines(self, start: Corner, farthest: int) -> dict[Corner, int]:
        """Return how far corners are along lines and the rim, up to a distance."""
        far = {start: 0}
        wave = [start]
        for distance in range(1, farthest + 1):
            wave = [o for corner in wave for o in self.on(corner) if o not in far]
            far |= dict.fromkeys(wave, distance)
        return far
