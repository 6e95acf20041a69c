"""Rules a step can declare about images: quantity and grid (shape and pitch).

They stand in ``Annotated`` beside the type of a port, of a setting or of the return value::

    def subdivide(
        image: Mask, *, factor: Annotated[int, Ge(1)] = 2
    ) -> Annotated[Mask, Grid.like("image", finer_by="factor")]: ...

The loader checks them along the wires as far as they are known before the first frame, and
the rest on the first frame of a source.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from tactile_graph.errors import RuleError
from tactile_graph.wires.image import Image, Mask


@dataclass(frozen=True, slots=True)
class Quantity:
    """What an image's values mean.

    On a port: the quantities it takes. On a return value: the one it gives; of a source whose
    setting ``of`` names it, what is told there. On a setting: what the port ``of`` must carry
    whenever the setting is given.
    """

    names: tuple[str, ...] = ()
    port: str = ""

    def __init__(self, *names: str, of: str = "") -> None:
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "port", of)

    @classmethod
    def like(cls, port: str) -> Quantity:
        """On a return value: the same quantity as came in at ``port``."""
        return cls(of=port)


@dataclass(frozen=True, slots=True)
class Grid:
    """Shape and pitch of an image.

    On a port: ``Grid.like("other")`` demands the same grid as another port's; ``Grid(rows=16)``,
    ``Grid(pitch_cm=1.3)`` and ``Grid(min_rows=3)`` demand numbers, ``Grid(square_to=0.03)`` cells
    whose sides differ by that share of the longer at most: a frame of others is refused, unless
    something asked for does without the step, which therefore says `require_square` itself. On a
    return value: ``Grid.like("image", finer_by="factor")`` says that each cell became factor x
    factor cells, where ``finer_by`` is a number or the name of a setting.
    """

    rows: int | None = None
    columns: int | None = None
    pitch_cm: float | None = None
    min_rows: int = 1
    min_columns: int = 1
    square_to: float | None = None
    port: str = ""
    finer_by: str | int = 1

    @classmethod
    def like(cls, port: str, finer_by: str | int = 1) -> Grid:
        """Return the rule "as at ``port``", each cell cut into ``finer_by`` a side."""
        return cls(port=port, finer_by=finer_by)


@dataclass(frozen=True, slots=True)
class GridFact:
    """What the loader knows of a grid: which original grid, and how much finer per side."""

    origin: str
    finer: Fraction = Fraction(1)
    rows: int | None = None
    columns: int | None = None
    pitch_cm: tuple[float, float] | None = None

    def refined(self, factor: int) -> GridFact:
        """Return the fact for each cell cut into ``factor`` a side."""
        pitch = self.pitch_cm
        return GridFact(
            self.origin,
            self.finer * factor,
            None if self.rows is None else self.rows * factor,
            None if self.columns is None else self.columns * factor,
            None if pitch is None else (pitch[0] / factor, pitch[1] / factor),
        )


ROUNDING = 1e-9
"""Of a cell's longer side, by which numbers may have been rounded."""


def square_wanted(image: Image | Mask, to: float) -> str:
    """Return the words for cells that are square to a share of the longer side; none if they are.

    See `Grid`; a share of 0 allows for rounding alone.
    """
    across, down = image.pitch_cm
    if abs(across - down) <= (to + ROUNDING) * max(across, down):
        return ""
    return f"cells that are square to {to:.0%}" if to else "square cells"


def require_square(image: Image | Mask, to: float = 0.0) -> None:
    """Refuse an image whose cells are not square to a share of the longer side.

    Raises
    ------
    RuleError
        With the pitch.
    """
    if wanted := square_wanted(image, to):
        across, down = image.pitch_cm
        raise RuleError(f"needs {wanted}, got a pitch of {across:g} by {down:g} cm")


def require_same_shape(**images: Image | Mask) -> None:
    """Refuse images of different shapes, named as given: for what only a frame can tell.

    Raises
    ------
    RuleError
        With the names and shapes.
    """
    shapes = [image.shape for image in images.values()]
    if any(shape != shapes[0] for shape in shapes):
        names, got = " and ".join(images), " and ".join(map(str, shapes))
        raise RuleError(f"{names} must have the same shape, got {got}")
