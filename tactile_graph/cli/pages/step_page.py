"""One step in full: ports, settings with ranges and defaults, outputs, notes, and its use."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, get_args

from tactile_graph.docstring import parameters, sections
from tactile_graph.pipeline.plain import as_given
from tactile_graph.pipeline.wiring import assignable, public_fields
from tactile_graph.pipeline.yaml_numbers import in_yaml as dumped
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.inner import written_type
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.steps.signature import Kind, Port, Setting, Signature, strip, type_name
from tactile_graph.text_files import decoded
from tactile_graph.wires import Frame, Image

if TYPE_CHECKING:
    from rich.console import RenderableType

Row = tuple[str, ...]
SIGNS = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "multiple_of": "multiple of"}
SHOWN_SECTIONS = ("Raises", "Notes")


def step_page(registry: Registry, name: str) -> Iterator[RenderableType]:
    """Yield what there is to print about a step."""
    from rich.padding import Padding
    from rich.text import Text

    signature = registry.step(name)
    plugin = registry.offer("steps", name).plugin
    doc = sections(signature.doc)
    meanings = parameters(signature.doc)
    yield Text.assemble((name, "bold"), f"  {_kind(signature)} of plugin ", (plugin.name, "cyan"),
                        f" ({plugin.package} {plugin.version})")  # fmt: skip
    yield Padding(_reflowed(doc[""]), (1, 0, 1, 2))
    rows: list[Row]
    if signature.ports:
        rows = [(p.name, type_name(p.type), _port_notes(p), meanings.get(p.name, ""))
                for p in signature.ports]  # fmt: skip
        yield from _table("ports", ("", "type", "rule", ""), rows)
    if signature.settings:
        rows = [
            (s.name, written_type(s.annotation), _default(s), ", ".join(ranges(s.annotation)),
             meanings.get(s.name, s.meaning))
            for s in signature.settings
        ]  # fmt: skip
        yield from _table("settings", ("", "type", "default", "allowed", ""), rows)
    yield from _table("gives", ("", "type", "rule", ""), _outputs(signature))
    for title in SHOWN_SECTIONS:
        if title in doc:
            yield Text(title.lower(), style="bold")
            yield Padding(_reflowed(doc[title]), (0, 0, 1, 2))
    shipped = _shipped_use(registry, name)
    yield Text("in a pipeline" + (f", as {shipped[0]} has it" if shipped else ""), style="bold")
    yield Padding(Text(shipped[1] if shipped else made_up_use(signature)), (0, 0, 0, 2))


def _kind(signature: Signature) -> str:
    if signature.kind is Kind.SOURCE:
        return "source"
    return "step that keeps state" if signature.stateful else "step"


def _table(title: str, heads: tuple[str, ...], rows: list[Row]) -> Iterator[RenderableType]:
    """Yield a table, without the columns that would stay empty."""
    from rich import box
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    yield Text(title, style="bold")
    kept = [i for i in range(len(heads)) if any(row[i] for row in rows)]
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_header=any(heads[i] for i in kept))
    for i in kept:
        table.add_column(heads[i], style="cyan" if i == 0 else "", no_wrap=i == 0, overflow="fold")
    for row in rows:
        table.add_row(*(Text(row[i]) for i in kept))
    yield Padding(table, (0, 0, 0, 2))


def _port_notes(port: Port) -> str:
    notes = [] if port.required else ["optional"]
    return ", ".join(notes + _rules(port.quantity, port.grid))


def _rules(quantity: Quantity | None, grid: Grid | None) -> list[str]:
    rules = []
    if quantity is not None:
        rules.append(" or ".join(quantity.names) or f"quantity of {quantity.port}")
    if grid is not None:
        finer = f", cells cut in {grid.finer_by}" if grid.finer_by != 1 else ""
        rules.append(f"grid of {grid.port}{finer}" if grid.port else _grid(grid))
    return rules


def _grid(grid: Grid) -> str:
    parts = []
    if grid.rows or grid.columns:
        parts.append(f"{grid.rows or 'any'} x {grid.columns or 'any'} cells")
    if grid.pitch_cm:
        parts.append(f"pitch {grid.pitch_cm:g} cm")
    if grid.min_rows > 1 or grid.min_columns > 1:
        parts.append(f"at least {grid.min_rows} x {grid.min_columns} cells")
    if grid.square_to is not None:
        parts.append(f"cells square to {grid.square_to:.0%}" if grid.square_to else "square cells")
    return ", ".join(parts)


def _default(setting: Setting) -> str:
    return "(required)" if setting.required else in_yaml(setting.default)


def in_yaml(value: Any) -> str:
    """Return a value as YAML has it in one line."""
    text = dumped(as_given(value), default_flow_style=True, width=10_000, allow_unicode=True)
    return text.removesuffix("\n...\n").strip()


def ranges(annotation: Any) -> list[str]:
    """Return the ranges and rules an annotation declares, in words."""
    bare, metadata = strip(annotation)
    found: list[str] = []
    for rule in metadata:
        if isinstance(rule, Quantity):
            found.append(f"{rule.port or 'image'} must be {' or '.join(rule.names)}")
            continue
        if callable(getattr(rule, "choices", None)):
            found.append(", ".join(rule.choices()))
        found += [f"{sign} {value:g}" for name, sign in SIGNS.items()
                  if isinstance(value := getattr(rule, name, None), int | float)]  # fmt: skip
        least, most = getattr(rule, "min_length", 0), getattr(rule, "max_length", None)
        if least or most is not None:
            found.append(f"length {least}" + (f" to {most}" if most is not None else " or more"))
    inner = [a for a in get_args(bare) if a is not type(None)]
    return list(dict.fromkeys(found + [text for a in inner for text in ranges(a)]))


def _outputs(signature: Signature) -> list[Row]:
    rules = ", ".join(_rules(signature.output_quantity, signature.output_grid))
    if signature.kind is Kind.SOURCE:
        return [("frames", "Frame", rules, "")]
    if signature.output in (None, type(None)):
        return [("nothing", "", "", "a sink: it writes, shows or sends")]
    rows: list[Row] = [(type_name(signature.output), "", rules, "")]
    types = public_fields(signature.output)
    names = signature.fields or tuple(getattr(signature.output, "columns_shown", ()))
    return rows + [(f"  .{n}", type_name(types.get(n, Any)), "", "") for n in names]


def _reflowed(text: str) -> Any:
    """Return prose with its paragraphs filled anew; indented lines stay as they are."""
    from rich.text import Text

    paragraphs = []
    for part in text.split("\n\n"):
        lines = part.splitlines()
        plain_lines = not any(line[:1].isspace() for line in lines)
        paragraphs.append(" ".join(lines) if plain_lines else part)
    return Text("\n\n".join(paragraphs))


# -- its use -------------------------------------------------------------------------------------


def _shipped_use(registry: Registry, step: str) -> tuple[str, str] | None:
    """Return a pipeline that uses the step and the line it does so in."""
    from tactile_graph.pipeline.document import read_document

    for name in registry.names("pipelines"):
        try:
            text = decoded(registry.path("pipelines", name).read_bytes())
        except (OSError, UnicodeDecodeError):
            continue
        data = read_document(text, name).data
        if not isinstance(data, dict):
            continue
        source = data.get("source")
        if isinstance(source, dict) and source.get("step") == step:
            return name, f"source: {in_yaml(source)}"
        nodes = data.get("nodes")
        for node, body in nodes.items() if isinstance(nodes, dict) else ():
            if isinstance(body, dict) and body.get("step") == step:
                return name, f"{node}: {_flow(body)}"
    return None


def made_up_use(signature: Signature) -> str:
    """Return a line of YAML that uses the step, its required settings filled in."""
    given = {s.name: _example(s) for s in signature.settings if s.required}
    body: dict[str, Any] = {"step": signature.name}
    ports = [p for p in signature.ports if p.required] or list(signature.ports)
    if len(ports) == 1:
        body["in"] = _wire(ports[0])
    elif ports:
        body["in"] = {p.name: _wire(p) for p in ports}
    if given:
        body["with"] = given
    head = "source" if signature.kind is Kind.SOURCE else f"my_{signature.name}"
    return f"{head}: {_flow(body)}"


def _flow(body: dict[str, Any]) -> str:
    text = dumped(body, default_flow_style=True, width=10_000, sort_keys=False,
                  allow_unicode=True)  # fmt: skip
    return text.strip()


def _wire(port: Port) -> str:
    takes_frame = assignable(Frame, port.type) or assignable(Image, port.type)
    return "frame" if takes_frame and port.type is not Any else port.name


def _example(setting: Setting) -> Any:
    words = type_name(setting.annotation)
    bare = strip(setting.annotation)[0]
    literal = get_args(bare)[0] if "'" in words and get_args(bare) else None
    if isinstance(literal, str):
        return literal
    for kind, example in (("int", 2), ("float", 1.0), ("bool", True), ("list", [1, 2])):
        if words.startswith(kind):
            return example
    return "recording.csv" if "Path" in words else "…"
