"""Step ``skeleton``: the one-cell-wide stick figure of a mask."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask


def skeleton(
    mask: Mask, *, method: Literal["zhang", "lee"] = "zhang"
) -> Annotated[Mask, Grid.like("mask")]:
    """Return the mask thinned to lines one cell wide, in as many pieces as it had.

    Parameters
    ----------
    mask : Mask
    method : str
        ``zhang`` (Zhang and Suen 1984, 10.1145/357994.358023) or ``lee`` (Lee, Kashyap and Chu
        1994, 10.1006/cgip.1994.1042).

    Returns
    -------
    Mask

    Notes
    -----
    Thesis section 3.1.3 names skeletons as the third morphological operation (Pratt 1991); the
    thinning is scikit-image's.
    """
    from skimage.morphology import skeletonize

    writable = mask.values.copy()  # the compiled thinning refuses read-only memory
    thin = skeletonize(writable, method=method)  # type: ignore[no-untyped-call]
    return mask.with_values(np.asarray(thin, np.bool_))
