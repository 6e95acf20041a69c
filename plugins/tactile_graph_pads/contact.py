"""How an object's weight comes down on the elements: exact coverage, bumps, sand, foam, tilt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.wires import Shape
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.geometry import Geometry

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grain:
    """A grain of sand under one element, on which an object comes to rest (figure 2.13).

    Parameters
    ----------
    row, column : int
        The element, counted from 0.
    share : float
        Part of the weight that the grain takes of any object that covers it.
    """

    row: Annotated[int, Ge(0)]
    column: Annotated[int, Ge(0)]
    share: Annotated[float, Gt(0), Le(1)] = 0.9
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Contact:
    """What lies between object and elements.

    Parameters
    ----------
    cardboard : bool
        A piece of cardboard on each element, so that none of the weight rests on the gaps
        (thesis section 2.4.1). Without it what lies over a gap is lost.
    foam_cm : float
        Width (standard deviation) over which a foam pad spreads the load (figure 2.14).
    sand : tuple of Grain
        Grains under single elements.
    lean_cm : float
        Standard deviation, along x and y, of how far the centre of pressure lies from an object's
        own centre each time it is put down: neither object nor pad is flat (section 2.4), and what
        is stacked differs by its order (section 2.4.3).
    """

    cardboard: bool = True
    foam_cm: Annotated[float, Ge(0)] = 0.0
    sand: tuple[Grain, ...] = ()
    lean_cm: Annotated[float, Ge(0)] = 0.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def load_g(
        self,
        shape: Shape,
        weight_g: float,
        geometry: Geometry,
        gains: Array | float = 1.0,
        offset_cm: tuple[float, float] = (0.0, 0.0),
    ) -> Array:
        """Return the load of one object on each element, shape (rows, columns), in grams.

        Parameters
        ----------
        shape : Circle, Ellipse, Rectangle or Polygon
            Its footprint, in pad coordinates.
        weight_g : float
            All that it carries, stacked weights included.
        geometry : Geometry
        gains : ndarray of float64, shape (rows, columns), optional
            Unevenness; an element's part of the load grows with its coverage times its gain.
        offset_cm : (float, float)
            Where the load's centre of pressure lies from the footprint's centre: weights
            stacked off centre tilt the pressure linearly over the footprint, down to lift-off.

        Notes
        -----
        The loads sum to the weight times the share of the footprint that lies on the pad (on
        elements only, without cardboard); to 0 where the object touches no element.
        """
        covered = coverage_cm2(shape, geometry)
        part = covered * gains
        if offset_cm != (0.0, 0.0):
            part = part * _tilt(covered, geometry, offset_cm)
        total = float(part.sum())
        if total <= 0.0:
            return np.zeros(geometry.shape)
        load = part * (weight_g * self._share_on_pad(shape, covered, geometry) / total)
        load = self._onto_grains(load, covered)
        return spread(load, geometry, self.foam_cm) if self.foam_cm > 0.0 else load

    def _share_on_pad(self, shape: Shape, covered: Array, geometry: Geometry) -> float:
        """Return how much of the weight the elements bear at all."""
        if not self.cardboard:
            return min(1.0, float(covered.sum()) / shape.area_cm2)
        width, height = geometry.size_cm
        xy = shape.outline_cm()
        on_pad = (xy >= 0.0).all() and (xy <= (width, height)).all()
        if on_pad:
            return 1.0
        margin = 0.5 * geometry.gap_cm  # each cell of pitch size carries to its element
        whole = Geometry(geometry.rows, geometry.columns, geometry.pitch_cm, 0.0)
        shifted = _moved(shape, margin)
        return min(1.0, float(coverage_cm2(shifted, whole).sum()) / shape.area_cm2)

    def _onto_grains(self, load: Array, covered: Array) -> Array:
        for grain in self.sand:
            if covered[grain.row, grain.column] > 0.0:
                taken = grain.share * load.sum()
                load = (1.0 - grain.share) * load
                load[grain.row, grain.column] += taken
        return load


def _moved(shape: Shape, by_cm: float) -> Shape:
    from dataclasses import replace

    from tactile_graph.wires import Polygon

    if isinstance(shape, Polygon):
        return Polygon(shape.xy_cm + by_cm)
    return replace(shape, x_cm=shape.x_cm + by_cm, y_cm=shape.y_cm + by_cm)


def _tilt(covered: Array, geometry: Geometry, offset_cm: tuple[float, float]) -> Array:
    """Return the linear pressure that moves the load's centre by ``offset_cm``, 0 at lift-off."""
    total = covered.sum()
    if total <= 0.0:
        return np.ones(geometry.shape)
    x, y = np.meshgrid(geometry.x_cm, geometry.y_cm)
    x = x - (covered * x).sum() / total
    y = y - (covered * y).sum() / total
    xx, xy, yy = (float((covered * a * b).sum() / total) for a, b in ((x, x), (x, y), (y, y)))
    moments = np.array([[xx, xy], [xy, yy]])
    # an object on one row of elements cannot tilt across it: least squares leaves that out
    slope = np.linalg.lstsq(moments, np.array(offset_cm), rcond=1e-9)[0]
    return np.asarray(np.maximum(1.0 + slope[0] * x + slope[1] * y, 0.0))


def spread(load_g: Array, geometry: Geometry, width_cm: float) -> Array:
    """Return the load as a foam pad passes it on: blurred, its sum kept.

    Parameters
    ----------
    load_g : ndarray of float64, shape (rows, columns)
    geometry : Geometry
    width_cm : float
        Standard deviation of the blur; each element takes what falls on its cell.
    """
    down = _blur(geometry.y_cm, geometry.pitch_cm, width_cm)
    across = _blur(geometry.x_cm, geometry.pitch_cm, width_cm)
    return np.asarray(down @ load_g @ across.T)


def _blur(at_cm: Array, pitch_cm: float, width_cm: float) -> Array:
    """Return the matrix of one axis' blur; its columns sum to 1, so no load leaves the pad."""
    from scipy.special import ndtr

    distance = at_cm[:, None] - at_cm[None, :]
    half = 0.5 * pitch_cm
    weights = ndtr((distance + half) / width_cm) - ndtr((distance - half) / width_cm)
    return np.asarray(weights / weights.sum(axis=0, keepdims=True))
