"""Step ``running_background``: what is new on the pad; a step that warms up skips meanwhile.

Run by:
    tactile-graph run background-demo --frames 8
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le

from tactile_graph import Degenerate, Image, Skip, hookimpl
from tactile_graph.steps import Grid, Quantity


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the step."""
    return {"running_background": f"{__name__}:RunningBackground"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    return {"background-demo": Path(__file__).parent / "pipelines" / "background-demo.yaml"}


class RunningBackground:
    """Return what the image has more than the mean of those before it.

    Parameters
    ----------
    warm_up : int
        Frames that only teach the background; they are skipped.
    follow : float
        Share of each later frame that goes into the background.
    """

    def __init__(
        self, *, warm_up: Annotated[int, Ge(1)] = 3, follow: Annotated[float, Gt(0), Le(1)] = 0.02
    ) -> None:
        self._warm_up, self._follow, self._seen = warm_up, follow, 0
        self._background = np.zeros((0, 0))

    def __call__(
        self, image: Image
    ) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
        """Return the image less the background, 0 where it sank below."""
        if not np.isfinite(image.filled()).all():
            raise Degenerate("a valid cell holds no finite number")
        if self._background.shape != image.shape:  # the first frame, or another pad
            self._background, self._seen = np.zeros(image.shape), 0
        self._seen += 1
        added = image.filled() - self._background
        self._background = self._background + max(1.0 / self._seen, self._follow) * added
        if self._seen <= self._warm_up:
            raise Skip(f"warming up: frame {self._seen} of {self._warm_up}")
        return image.with_values(np.maximum(added, 0.0))
