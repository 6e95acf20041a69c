"""Write the page of all keys of pad, preset and scene files from the records that read them.

Run with ``python docs/keys.py``; a test holds that the page is what this writes.
"""

from __future__ import annotations

from pathlib import Path

from tactile_graph.cli.file_kinds import file_kind
from tactile_graph.cli.pages.key_tables import Key, KeyTable, key_tables
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.record_schema import record_schema

PAGE = Path(__file__).parent / "files.md"
KINDS = {
    "pad": "A pad's physics, for `simulate`, calibration and the likelihood ([what for](pad.md)).",
    "preset": "How a kit on a serial port is read ([what for](devices.md)).",
    "scene": "What lies on a simulated pad: `--source simulate --with scene=my-scene.yaml`.",
}
HEAD = """\
# Pad, preset and scene files

Every key of the three kinds of YAML files beside pipelines; `python docs/keys.py` writes this page
from the records that read them. `tactile-graph pads`, `presets` and `scenes` list those that are
installed, and print one to start from:

```sh
tactile-graph pads thesis                # with > my-pad.yaml the beginning of one's own
tactile-graph check my-pad.yaml
tactile-graph schema pad -o pad.schema.json
tactile-graph schema scene --keys
```

`check` of a pipeline opens the pad, scene, preset or recording that its source names as well, and
tells what is wrong in it. It tells by a file's keys what it is; `--as scene` says so where they do
not. A key without a default and not required is left out unless it is meant. Lengths are in cm,
places (x right, y down) from the pad's top left corner.
"""


def page(found: Registry) -> str:
    """Return the page as Markdown."""
    parts = [HEAD]
    for name, about in KINDS.items():
        parts.append(f"## {name.capitalize()}\n\n{about}\n")
        schema = record_schema(file_kind(found, name), name)
        parts += [_section(table) for table in key_tables(schema)]
    return "\n".join(parts)


def _section(table: KeyTable) -> str:
    head = f"### `{table.place}`\n\n{table.about}\n\n" if table.place else ""
    rows = ["| key | holds | default | |", "|---|---|---|---|", *map(_row, table.keys)]
    return head + "\n".join(rows) + "\n"


def _row(key: Key) -> str:
    default = key.default if key.default in ("", "required") else f"`{key.default}`"
    return f"| `{key.name}` | {key.allowed} | {default} | {key.meaning} |".replace("|  |", "| |")


if __name__ == "__main__":
    PAGE.write_text(page(installed()), encoding="utf-8")
