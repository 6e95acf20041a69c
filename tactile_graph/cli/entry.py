"""Where the command begins; all else is imported within reach of Ctrl-C."""

from __future__ import annotations

import gc
import sys

NEW_OBJECTS = 100_000
"""Until garbage is searched for among them: imports make as many that stay."""


def main() -> None:
    """Run the command line and exit."""
    gc.set_threshold(NEW_OBJECTS, *gc.get_threshold()[1:])
    try:
        from tactile_graph.cli.app import cli
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        sys.exit(130)
    cli.main()
