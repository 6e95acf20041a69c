"""What a pipeline is made of and what a frame came to in it, for plugins that look inside.

A plugin's steps need none of this. What compares, audits, tunes or explains pipelines finds here:

- the graph: `Graph`, `Node`, `NodeKind`, `Guard`, `Ref`, `Source`, and the frame's own name in it
  (`FRAME`); types along its wires (`arms`, `field_type`, `public_fields`); settings as plain data
  (`plain`), digests of it (`node_key`) and what of them changes nothing (`idle_settings`);
  a condition's text without line ends and comments (`one_line`);
- the plan of a demand (`make_plan`, `Plan`), what it needs of a frame (`check_frame`), and its
  `Runner`;
- outcomes: `Skipped`, `Failed`, `Done`, `NO_VALUE`, `NOT_ASKED`, the items of a
  list that have none (`gaps`) or one (`with_value`); errors of steps that run in a process apart
  and ended it or took too long (`CrashedError`, `OverrunError`); values as numbers (`scalars`) and
  as plain data (`as_data`, `without_nan`); which shape a type is (`shape_kind`) and what of
  it is held against the truth (`measures_of`);
- its rows for tables, one for each object where there are several (`make_table`, `Table`);
- `Replay`: what a plan alone would have come to, from a run that settled more;
- for what writes pipelines: a file's text for another folder (`moved`), and how a file there names
  the pipelines that this one does (`named_from`).
"""

from tactile_graph.engine.calls.isolated import CrashedError, OverrunError
from tactile_graph.engine.outcomes.outcome import (
    NO_VALUE,
    NOT_ASKED,
    Done,
    Failed,
    Skipped,
    gaps,
    with_value,
)
from tactile_graph.engine.plan import Plan, make_plan
from tactile_graph.engine.replay import Replay
from tactile_graph.engine.runner import Runner, check_frame
from tactile_graph.engine.tables.rows import as_data, scalars, without_nan
from tactile_graph.engine.tables.table import Table, make_table
from tactile_graph.engine.tables.truth import measures_of, shape_kind
from tactile_graph.pipeline.conditions.conditions import Guard, one_line
from tactile_graph.pipeline.graph import FRAME, Graph, Node, NodeKind, Source, node_key
from tactile_graph.pipeline.idle import idle_settings
from tactile_graph.pipeline.named_files.moved import moved, named_from
from tactile_graph.pipeline.plain import plain
from tactile_graph.pipeline.wiring import Ref, arms, field_type, public_fields

__all__ = [
    "FRAME",
    "NOT_ASKED",
    "NO_VALUE",
    "CrashedError",
    "Done",
    "Failed",
    "Graph",
    "Guard",
    "Node",
    "NodeKind",
    "OverrunError",
    "Plan",
    "Ref",
    "Replay",
    "Runner",
    "Skipped",
    "Source",
    "Table",
    "arms",
    "as_data",
    "check_frame",
    "field_type",
    "gaps",
    "idle_settings",
    "make_plan",
    "make_table",
    "measures_of",
    "moved",
    "named_from",
    "node_key",
    "one_line",
    "plain",
    "public_fields",
    "scalars",
    "shape_kind",
    "with_value",
    "without_nan",
]
