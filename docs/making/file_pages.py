"""A page for each kind of file beside pipelines: every key, from the records that read them."""

from __future__ import annotations

from pathlib import Path

from making.markdown import fence, toctree, write
from tactile_graph.cli.file_kinds import file_kind
from tactile_graph.cli.pages.key_tables import Key, KeyTable, key_tables
from tactile_graph.plugins.registry import Registry
from tactile_graph.record_schema import record_schema

KINDS = {
    "calibration": "Grams behind readings, as `calibrate` writes them, for `force` "
    "([what for](../../pad.md#calibrating-a-pad)).",
    "pad": "A pad's physics, for `simulate`, the likelihood ([what for](../../pad.md)).",
    "preset": "How a kit on a serial port is read ([what for](../../devices.md)).",
    "scene": "What lies on a simulated pad: `--source simulate --with scene=my-scene.yaml`.",
}


def write_files(registry: Registry, into: Path) -> int:
    """Write a page a kind of file into a folder, and return how many kinds there are."""
    for name in KINDS:
        write(into / "files" / f"{name}.md", page(registry, name))
    head = "# Every key of pad, preset, scene and calibration files"
    about = "[What such files are for](../../files.md)."
    text = "\n\n".join([head, about, toctree(KINDS)])
    write(into / "files" / "index.md", text)
    return len(KINDS)


def page(registry: Registry, kind: str) -> str:
    """Return the page of a kind as Markdown: its keys, and those that are installed."""
    parts = [f"# Keys of a {kind} file\n\n{KINDS[kind]}\n"]
    schema = record_schema(file_kind(registry, kind), kind)
    parts += [_section(table) for table in key_tables(schema)]
    names = registry.names(file_kind(registry, kind).offers)
    if not names:  # none is offered by name
        return "\n".join(parts)
    parts.append(f"## Installed\n\nTo start from, `tactile-graph {kind}s NAME > my-{kind}.yaml`.\n")
    for name in names:
        text = registry.path(f"{kind}s", name).read_text("utf-8")
        parts.append(f"### {name}\n\n{fence('yaml', text)}")
    return "\n".join(parts)


def _section(table: KeyTable) -> str:
    head = f"## `{table.place}`\n\n{table.about}\n\n" if table.place else ""
    rows = ["| key | holds | default | |", "|---|---|---|---|", *map(_row, table.keys)]
    return head + "\n".join(rows) + "\n"


def _row(key: Key) -> str:
    default = key.default if key.default in ("", "required") else f"`{key.default}`"
    return f"| `{key.name}` | {key.allowed} | {default} | {key.meaning} |".replace("|  |", "| |")
