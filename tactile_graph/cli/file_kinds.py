"""Which kind of file a name or path means: a pipeline, or what a plugin reads (pad, preset, …)."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.plugins.file_kind import FileKind
from tactile_graph.plugins.registry import Registry

PIPELINE = "pipeline"
PIPELINE_REQUIRED = ("pipeline", "nodes", "outputs")
YAML = (".yaml", ".yml")


class Keys(NamedTuple):
    """The keys at the top of a kind of file."""

    allowed: frozenset[str]
    required: frozenset[str]


def kind_names(found: Registry) -> list[str]:
    """Return the kinds of files there are, pipelines first."""
    return [PIPELINE, *found.names("file_kinds")]


def file_kind(found: Registry, name: str) -> FileKind:
    """Return a kind that a plugin offers.

    Raises
    ------
    UsageError
        If there is none of that name.
    PluginError
        If what the plugin offers is no `FileKind`, or of files that no hook names.
    """
    if not found.has("file_kinds", name):
        names = kind_names(found)
        hint = did_you_mean(name, names) or f"; there are: {one_of(names)}"
        raise UsageError(f"no kind of file named {name!r}{hint}")
    kind: FileKind = found.load("file_kinds", name)
    return kind


def kind_of(found: Registry, name: str) -> str:
    """Return the kind of file that a name or path means.

    A file is told by the keys at its top, a name by who offers it; a pipeline where nothing tells.

    Raises
    ------
    UsageError
        If a name, or the keys of a file, may mean several kinds.
    """
    path = Path(name)
    if path.suffix in YAML or "/" in name:
        return _by_keys(found, path)
    if found.has("pipelines", name):
        return PIPELINE
    holders = [k for k in found.names("file_kinds") if found.has(file_kind(found, k).offers, name)]
    if len(holders) > 1:
        raise UsageError(f"{name!r} is {_either(holders)}; say which by --as")
    return holders[0] if holders else PIPELINE


def _by_keys(found: Registry, path: Path) -> str:
    from tactile_graph.pipeline.declaration import TOP_KEYS
    from tactile_graph.pipeline.document import read_document, text_of_file

    if not _is_file(path):
        return PIPELINE
    try:
        data = read_document(text_of_file(path), str(path)).data
    except (OSError, UnicodeDecodeError):
        return PIPELINE
    keys = set(data) if isinstance(data, dict) else set()
    known = {PIPELINE: Keys(frozenset(TOP_KEYS), frozenset(PIPELINE_REQUIRED))}
    known |= {name: _keys_of(found, name) for name in found.names("file_kinds")}
    shared = {name: len(keys & own.allowed) for name, own in known.items()}
    most = max(shared.values())
    best = [name for name, n in shared.items() if n == most]
    best = [name for name in best if known[name].required <= keys] or best
    if most == 0 or len(best) == 1:
        return best[0]
    raise UsageError(f"'{path}' may be {_either(best)} by its keys; say which by --as")


def _keys_of(found: Registry, name: str) -> Keys:
    from tactile_graph.record_schema import record_schema

    kind = file_kind(found, name)
    made = record_schema(kind, name)
    whole = made.get("else", made)
    return Keys(frozenset(whole["properties"]), frozenset(whole.get("required", ())))


def _is_file(path: Path) -> bool:
    """Return whether it can be read twice: a pipe cannot."""
    try:
        return path.is_file()
    except OSError:
        return False


def _either(kinds: list[str]) -> str:
    """Return the kinds as a choice: ``"a pad, preset or scene"``."""
    return f"a {', '.join(kinds[:-1])} or {kinds[-1]}"
