"""JSON Schema (draft 2020-12) of pipeline files, made from what the installed plugins offer.

A schema knows one file and no graph: names of steps, their settings and ports, and the shape of
everything. Whether a wire leads anywhere, types and quantities are `tactile-graph check`'s work.
One that is made for a file completes the names in it, and lets others pass: it may be older than
the node that was just written.
"""

from __future__ import annotations

import json
from typing import Any

from tactile_graph.docstring import parameters
from tactile_graph.errors import TactileGraphError
from tactile_graph.pipeline.completions import Nameable
from tactile_graph.pipeline.declaration import RESERVED
from tactile_graph.pipeline.plain import as_given
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.inner import written_type
from tactile_graph.steps.settings import adapter
from tactile_graph.steps.signature import Kind, Port, Setting, Signature, type_name

DRAFT = "https://json-schema.org/draft/2020-12/schema"
NAME = "[A-Za-z_][A-Za-z0-9_]*"
REF = f"^{NAME}(\\.{NAME})*$"

Schema = dict[str, Any]


def pipeline_schema(registry: Registry, names: Nameable | None = None) -> tuple[Schema, list[str]]:
    """Return the schema, and the steps that had to be left open because they cannot be imported.

    Parameters
    ----------
    registry : Registry
    names : Nameable, optional
        What the file may name that the schema is for; that of no file in particular otherwise.
    """
    signatures: dict[str, Signature | None] = {}
    troubles: list[str] = []
    for name in registry.names("steps"):
        try:
            signatures[name] = registry.step(name)
        except TactileGraphError as error:
            signatures[name] = None
            troubles.append(str(error))
    return _Maker(registry, signatures, names).schema(), troubles


class _Maker:
    def __init__(
        self,
        registry: Registry,
        signatures: dict[str, Signature | None],
        names: Nameable | None,
    ) -> None:
        self.registry = registry
        self.names = names or Nameable((), ())
        self.steps = {n: s for n, s in signatures.items() if s is None or s.kind is not Kind.SOURCE}
        self.sources = {n: s for n, s in signatures.items() if s is None or s.kind is Kind.SOURCE}
        self.defs: Schema = {
            "ref": {
                **_completed({"type": "string", "pattern": REF}, self.names.wires),
                "title": "A node, node.field, or frame (what the source gives)",
            },
            "condition": {
                **_completed({"type": ["string", "number", "boolean", "null"]},
                             self.names.conditions),
                "description": "The condition under which it runs, like contacts.count > 0 and "
                "not saturated.",
            },
            "refs": {"type": "array", "items": {"$ref": "#/$defs/ref"}, "minItems": 1},
            "wire": {"anyOf": [{"$ref": "#/$defs/ref"}, {"$ref": "#/$defs/refs"}]},
        }  # fmt: skip

    def schema(self) -> Schema:
        pipelines = self.registry.names("pipelines")
        self.defs["node"] = self._node(pipelines)
        self.defs["source"] = self._source()
        text = {"type": ["string", "number", "null"]}
        expression = {"type": ["string", "number", "boolean"]}
        return {
            "$schema": DRAFT,
            "title": "tactile-graph pipeline",
            "type": "object",
            "additionalProperties": False,
            "required": ["pipeline", "nodes", "outputs"],
            "properties": {
                "pipeline": {"type": ["string", "number"], "description": "Its name."},
                "about": {**text, "description": "What it is for, in a line."},
                "evolves": {
                    **text, "examples": pipelines,
                    "description": "The pipeline it was made from, by name or file.",
                },
                "source": {"oneOf": [{"$ref": "#/$defs/source"}, {"type": "null"}],
                           "description": "Where frames come from unless the run says otherwise."},
                "deadline_us": {
                    "type": ["number", "null"], "exclusiveMinimum": 0,
                    "description": "Microseconds from a frame's arrival within which a live run "
                    "wants its result: what would not be done in time is skipped.",
                },
                "isolated": {
                    "type": ["array", "null"], "items": {"type": "string", "minLength": 1},
                    "description": "Steps that run in a process apart, which is ended and started "
                    "anew where they hang or crash; plugin.* for all of a plugin's.",
                },
                "conditions": {
                    "type": ["object", "null"],
                    "propertyNames": _names(),
                    "additionalProperties": expression,
                    "description": "Named conditions, for use in 'when'.",
                },
                "nodes": {
                    "type": "object", "minProperties": 1,
                    "propertyNames": _names(),
                    "additionalProperties": {"$ref": "#/$defs/node"},
                    "description": "The graph: each node by its name.",
                },
                "outputs": {
                    "anyOf": [{"$ref": "#/$defs/ref"},
                              {"$ref": "#/$defs/refs", "uniqueItems": True}],
                    "description": "What a run asks for: nodes or node.field.",
                },
            },
            "$defs": self.defs,
        }  # fmt: skip

    def _node(self, pipelines: list[str]) -> Schema:
        return {
            "type": "object",
            "additionalProperties": False,
            "properties": {
                "step": self._choice(self.steps, "The step it runs"),
                "use": {"type": "string", "examples": pipelines,
                        "description": "A pipeline put in as a node, by name or file."},
                "first_of": {"$ref": "#/$defs/refs",
                             "description": "The first of these that has a value; those after it "
                             "are not computed."},
                "in": {
                    "anyOf": [{"$ref": "#/$defs/wire"}, {"type": "null"},
                              {"type": "object",
                               "additionalProperties": {"$ref": "#/$defs/wire"}}],
                    "title": "What it reads: a node, a list, or a map of ports",
                },
                "with": {"type": ["object", "null"], "title": "Settings"},
                "free": {"type": ["object", "null"],
                         "additionalProperties": {"type": "array", "minItems": 1},
                         "description": "Settings that 'tune' may choose: lists of values."},
                "when": {"$ref": "#/$defs/condition"},
                "each": {"type": "boolean",
                         "description": "Run it once for each item of the list it reads."},
                "time_limit_s": {
                    "type": ["number", "null"], "exclusiveMinimum": 0,
                    "description": "Seconds the step may take: it runs in a process of its own, "
                    "which is ended and started anew where it takes longer.",
                },
                "isolated": {"type": ["boolean", "null"],
                             "description": "Run the step in a process of its own: where it "
                             "crashes, only its node fails. false: not, whatever its plugin says."},
                "about": {"type": ["string", "number", "null"]},
            },
            "oneOf": [{"required": [kind]} for kind in ("step", "use", "first_of")],
            "allOf": [
                {"if": {"required": ["first_of"]},
                 "then": {"properties": dict.fromkeys(("in", "with", "free", "each"), False)}},
                {"if": {"not": {"required": ["step"]}},
                 "then": {"properties": {"time_limit_s": False, "isolated": False}}},
                {"if": {"required": ["use"]},
                 "then": {"properties": {
                     "with": {"propertyNames": {"pattern": "\\."},
                              "description": "Settings of the pipeline's nodes, as node.setting."},
                     "free": {"propertyNames": {"pattern": "\\."}},
                     "in": {"description": "The pipeline's frame, or a map of frame and of nodes "
                            "of it whose place is taken."},
                 }}},
                *(self._rule(n, s) for n, s in self.steps.items() if s is not None),
            ],
        }  # fmt: skip

    def _source(self) -> Schema:
        return {
            "type": "object",
            "additionalProperties": False,
            "required": ["step"],
            "properties": {
                "step": self._choice(self.sources, "The source step"),
                "with": {"type": ["object", "null"], "title": "Settings"},
            },
            "allOf": [self._rule(n, s) for n, s in self.sources.items() if s is not None],
        }

    # -- one step ----------------------------------------------------------------------------

    def _names(self, step: str) -> list[str]:
        """Return what a step is called: its shortest name, and the one behind its plugin's."""
        return list(dict.fromkeys((step, self.registry.offer("steps", step).qualified)))

    def _choice(self, steps: dict[str, Signature | None], what: str) -> Schema:
        """Return an enumeration, plain names first; editors show the lines beside the names."""
        about = {n: "" if s is None else s.summary for n, s in steps.items()}
        about |= {self.registry.offer("steps", n).qualified: line for n, line in about.items()}
        return {
            "enum": list(about),
            "title": what,
            "markdownEnumDescriptions": list(about.values()),
        }

    def _rule(self, name: str, signature: Signature) -> Schema:
        """Return what a node of one step must be like."""
        self.defs[f"{name}.with"] = self._settings(name, signature)
        then: Schema = {"properties": {
            "step": {"description": signature.summary}, "with": {"$ref": f"#/$defs/{name}.with"}
        }}  # fmt: skip
        required = ["with"] if any(s.required for s in signature.settings) else []
        if signature.kind is not Kind.SOURCE:
            self.defs[f"{name}.in"] = _ports(signature)
            then["properties"]["in"] = {"$ref": f"#/$defs/{name}.in"}
            then["properties"]["free"] = self._free(name, signature)
            required += ["in"] if any(p.required for p in signature.ports) else []
        if required:
            then["required"] = required
        return {
            "if": {"properties": {"step": {"enum": self._names(name)}}, "required": ["step"]},
            "then": then,
        }

    def _settings(self, name: str, signature: Signature) -> Schema:
        meanings = parameters(signature.doc)
        required = [s.name for s in signature.settings if s.required]
        made: Schema = {
            "type": "object" if required else ["object", "null"],
            "description": f"Settings of {name}: {signature.summary}",
            "additionalProperties": False,
            "properties": {
                s.name: self._setting(name, s, meanings.get(s.name, s.meaning))
                for s in signature.settings
            },
        }
        return {**made, "required": required} if required else made

    def _free(self, name: str, signature: Signature) -> Schema:
        """Return what a node of a step may leave to ``tune``: values its settings take."""
        at = f"#/$defs/{name}.with/properties/"
        return {
            "additionalProperties": False,
            "properties": {
                s.name: {"items": {"$ref": at + s.name}} for s in signature.settings
            },
        }  # fmt: skip

    def _setting(self, step: str, setting: Setting, meaning: str) -> Schema:
        prefix = f"#/$defs/{step}.{setting.name}."
        try:
            made = adapter(setting).json_schema(ref_template=prefix + "{model}")
        except Exception:  # a type of a plugin's own that JSON Schema has no words for
            made = {}
        for model, inner in made.pop("$defs", {}).items():
            self.defs[f"{step}.{setting.name}.{model}"] = inner
        words = f"{meaning} ({written_type(setting.annotation)})".strip()
        made = {**made, "description": words}
        default = as_given(setting.default) if not setting.required else None
        if default is not None and _is_json(default):
            made["default"] = default
        return made


def _ports(signature: Signature) -> Schema:
    """Return what a step's ``in`` may be; ports are named in the order a list fills them."""
    ports = signature.ports
    if not ports:
        return {"anyOf": [{"type": "null"}, {"type": "array", "maxItems": 0},
                          {"type": "object", "maxProperties": 0}]}  # fmt: skip
    needed = [p.name for p in ports if p.required]
    as_map: Schema = {
        "type": "object",
        "additionalProperties": False,
        "properties": {p.name: _port(p) for p in ports},
        "required": needed,
    }
    arms: list[Schema] = [as_map]
    if len(needed) <= 1:
        arms.append({"$ref": "#/$defs/ref"})
    if not needed:
        arms.append({"type": "null"})
    as_list: Schema = {"$ref": "#/$defs/refs"}
    if ports[0].item is None:
        as_list = {**as_list, "minItems": max(1, len(needed)), "maxItems": len(ports)}
    names = ", ".join(f"{p.name} ({type_name(p.type)})" for p in ports)
    return {"anyOf": [*arms, as_list], "description": f"Ports of {signature.name}: {names}."}


def _port(port: Port) -> Schema:
    wire = "#/$defs/wire" if port.item is not None else "#/$defs/ref"
    optional = "" if port.required else ", optional"
    return {"$ref": wire, "description": f"{type_name(port.type)}{optional}"}


def _completed(schema: Schema, names: tuple[str, ...]) -> Schema:
    """Return a schema of which editors offer the names, and that lets others pass."""
    return {"anyOf": [{"enum": list(names)}, schema]} if names else schema


def _names() -> Schema:
    return {"pattern": f"^{NAME}$", "not": {"enum": list(RESERVED)}}


def _is_json(value: Any) -> bool:
    try:
        json.dumps(value, allow_nan=False)
    except (TypeError, ValueError):
        return False
    return True
