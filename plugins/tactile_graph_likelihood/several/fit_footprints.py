"""``fit_footprints``: several outlines at once, and how many of them there are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

from annotated_types import Ge, Le, MinLen
from pydantic import AllowInfNan

from tactile_graph.steps import Spread
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE, REGULAR
from tactile_graph_likelihood.settings import ON_PAD, FootprintSettings, Load
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem
from tactile_graph_likelihood.several.pad import Expected, OnPad, likeliest
from tactile_graph_likelihood.several.posteriors import posteriors
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_likelihood.single.posterior import UNLIKELY
from tactile_graph_likelihood.single.readings import readings_of

KINDS = {
    "disc": (DISC, 0),
    "ellipse": (ELLIPSE, 0),
    "rectangle": (RECTANGLE, 0),
    "triangle": (REGULAR, 3),
    "pentagon": (REGULAR, 5),
    "hexagon": (REGULAR, 6),
}
Kind = Literal["disc", "ellipse", "rectangle", "triangle", "pentagon", "hexagon"]


class Footprints(NamedTuple):
    """The outlines on a pad."""

    shapes: tuple[Likely, ...]
    """Each with its posterior given the others."""
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody asks a record for
    count_probability: float
    """Probability of this number among all that the search came upon."""
    log_evidence: float
    """Of the frame, over that of a bare pad."""
    surprise: float
    """Of the whole frame, as in `fit_footprint`."""
    fits: bool
    """Whether the frame looks like the model's."""


@dataclass(frozen=True)
class SeveralSettings(FootprintSettings):
    """The settings of several outlines.

    Parameters
    ----------
    on_pad : "whole", "mostly" or "partly"
        Whether all outlines lie wholly on the pad, or their centres only; in nine of ten cases
        the whole.
    smallest_cm, largest_cm : float, optional
        Range of radii and half sides; of a regular polygon, what its sides keep from its centre
        is no less. If not given, 0.77 pitches and 0.58 of the pad's longer side: 1 and 12 cm on
        the pad `thesis`.
    """

    on_pad: Literal["whole", "mostly", "partly"] = "whole"

    def expected(self, kinds: Sequence[Kind], most: int, more: float) -> Expected:
        """Return what is expected on a pad."""
        sizes, found = (self.smallest_cm, self.largest_cm), [KINDS[k] for k in dict.fromkeys(kinds)]
        return Expected(found, sizes, ON_PAD[self.on_pad], most, more)


SEVERAL = SeveralSettings()


class FitFootprints:
    """Return the outlines of all objects on the pad, their number and kinds by evidence.

    Loads of all objects add up on each element. The search begins with connected pieces of the
    footprint, and then parts, joins and parts anew while the evidence grows.

    Parameters
    ----------
    kinds : list of str
        What an object may be; each is as likely as any other. Polygons are regular.
    most : int
        Objects at most.
    more : float
        Log odds of a number of objects over one less, before anything is read.
    settings : SeveralSettings

    Notes
    -----
    Outlines do not overlap, but for 0.1 of an element or so. The answer is the same each time.
    """

    stateless = True

    def __init__(
        self,
        *,
        kinds: Annotated[list[Kind], MinLen(1)] = ["disc", "rectangle", "ellipse", "triangle"],  # noqa: B006 - settings are never changed
        most: Annotated[int, Ge(1), Le(12)] = 6,
        more: Annotated[float, AllowInfNan(False)] = 2.5,
        settings: Annotated[
            SeveralSettings,
            Spread(
                "pad",
                "sigma",
                "voids",
                "strays",
                "foam_cm",
                "gap_cm",
                "shows_from",
                "on_pad",
                "smallest_cm",
                "largest_cm",
            ),
        ] = SEVERAL,
    ) -> None:
        self.noise, self.gap_cm = settings.noise, settings.gap
        self.expected = settings.expected(kinds, most, more)

    def __call__(
        self, image: Load, starts: Sequence[Circle | Ellipse | Rectangle | Polygon] = ()
    ) -> Footprints:
        """Return the outlines.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.
        starts : list of Circle, Ellipse, Rectangle or Polygon
            Where the search may begin too, one for each object; those of kinds that are not
            looked for become the ellipse of the same place and area.

        Raises
        ------
        RuleError
            If the image's cells are not square.
        Degenerate
            If nothing is touched, or no such outlines explain what is.
        """
        readings = readings_of(image, self.gap_cm, self.noise.least)
        noise = self.noise.vector(float(readings.grid[2]))
        problem = self.expected.problem(readings, noise)
        begin = self.expected.outlines(starts, problem) if len(starts) else None
        return footprints(problem, likeliest(problem, self.expected, starts=begin))


def footprints(problem: JointProblem, found: OnPad) -> Footprints:
    """Return the outlines that were found on a pad with their posteriors."""
    parts, fit = posteriors(problem, found)
    return Footprints(
        tuple(likely(p) for p in parts),
        len(parts),
        found.count_probability,
        max(found.counts.values()),
        fit.surprise,
        fit.surprise > UNLIKELY and fit.neighbours < 4.0,
    )
