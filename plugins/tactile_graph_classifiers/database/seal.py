"""Seals: digests of what a database says, so that what was damaged or edited is not believed."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.known import KnownObject

Part = str | int | float | NDArray[np.float64]


def seal(parts: Iterable[Part]) -> str:
    """Return a digest that no other sequence of texts, numbers and arrays has.

    Parameters
    ----------
    parts : iterable of str, int, float and ndarray
    """
    digest = hashlib.sha256()
    for part in parts:
        if isinstance(part, str):
            kind, data = "text", part.encode("utf-8", "surrogatepass")
        elif isinstance(part, int | float):
            kind, data = "number", repr(part).encode()
        else:
            kind, data = f"array {part.shape}", part.astype("<f8").tobytes()
        digest.update(f"{kind} {len(data)}\n".encode() + data)
    return digest.hexdigest()


def seal_of_object(it: KnownObject, learned_at: str) -> str:
    """Return the digest of an object with all its readings and statistics.

    Parameters
    ----------
    it : KnownObject
    learned_at : str
    """
    mean, scatter = it.statistics.mean, np.triu(it.statistics.scatter)
    return seal(
        (it.name, it.shape, learned_at, it.statistics.n, it.readings, mean, scatter, *it.sources)
    )
