"""``Settled``: what steps load at their first frames is never searched for garbage again."""

from __future__ import annotations

import gc
import sys


class Settled:
    """Call it between frames: where modules were loaded since, it collects and freezes.

    A step that compiles loads the compiler when its first frame comes, and with it some hundred
    thousand objects that stay: each full collection would go through them, for 20 to 50 ms. The
    frame that loaded them has taken longer than that already.
    """

    def __init__(self) -> None:
        self._n_modules = 0

    def __call__(self) -> None:
        """Look whether there is anything new."""
        n_modules = len(sys.modules)
        if n_modules != self._n_modules:
            self._n_modules = n_modules
            gc.collect()
            gc.freeze()
