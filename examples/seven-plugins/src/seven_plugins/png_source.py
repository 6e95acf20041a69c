"""Source ``png``: frames from grey-scale PNG files, a file each.

Run by:
    tactile-graph run contacts --source png shot-*.png --with pitch_cm=0.5
"""

import hashlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
from annotated_types import Gt

from tactile_graph import Frame, hookimpl
from tactile_graph.errors import DataError
from tactile_graph.steps import Report


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the source."""
    return {"png": f"{__name__}:png"}


@hookimpl
def tactile_graph_readers() -> Mapping[str, str]:
    """Let command lines give it files, with ``--source png``."""
    return {"png": "path"}


def png(
    *,
    path: Path | list[Path],
    pitch_cm: Annotated[float, Gt(0)] = 1.0,
    report: Report,
) -> Iterator[Frame]:
    """Yield the files' pixels as readings, in the order of the files.

    Parameters
    ----------
    path : Path or list of Path
        Grey images of 8 or 16 bits.
    pitch_cm : float
        Distance of neighbouring cells.
    """
    import PIL.Image  # only a pipeline that reads such files pays for it

    paths = path if isinstance(path, list) else [path]
    report.expect(len(paths))
    for index, file in enumerate(paths):
        try:
            report.digest(str(file), hashlib.sha256(file.read_bytes()).hexdigest())
            values = np.asarray(PIL.Image.open(file), dtype=float)
        except OSError as error:
            raise DataError(str(file), f"cannot be read as an image: {error}") from error
        if values.ndim != 2:
            raise DataError(str(file), f"is no grey image: it has {values.shape[-1]} channels")
        yield Frame.of(values, pitch_cm, quantity="raw", index=index, label=file.name)
