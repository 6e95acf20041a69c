"""What workers are forked from: to import this is to have imported what they need before long.

No other module imports it. The process that does runs no threads, and no plugin but the project's
own.
"""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from importlib.metadata import entry_points

from tactile_graph.out_of_reach import end_safe_path

GROUP = "tactile_graph"
OWN = "tactile-graph"
WANTED = (
    "tactile_graph.cli.many.job",
    "numba",
    "tactile_graph.plugins.core",
    "tactile_graph.engine.runner",
    "tactile_graph.engine.tables.table",
    "tactile_graph.compiled.machine_code",
    "tactile_graph.compiled.whole",
    "tactile_graph.engine.outcomes.promises",
    "tactile_graph.steps.checks",
    "tactile_graph.cli.output.writers",
)


def _import_all() -> None:
    own = [e.module for e in entry_points(group=GROUP) if e.dist and e.dist.name == OWN]
    for name in (*WANTED, *sorted(own)):
        with suppress(Exception):  # told by the worker that needs it
            import_module(name)


end_safe_path()  # a user's own processes are forked from here, too
_import_all()
