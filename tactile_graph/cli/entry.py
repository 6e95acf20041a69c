"""Where the command begins; all else is imported within reach of Ctrl-C."""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line and exit."""
    try:
        from tactile_graph.cli.app import cli
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        sys.exit(130)
    cli.main()
