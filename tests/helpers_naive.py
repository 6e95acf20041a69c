"""A second engine, as plain as can be: it follows the meaning of a pipeline by recursion alone.

It plans nothing, hoists nothing and knows no slots. Whatever a node needs is evaluated when it is
needed, in the order the meaning gives: the guard before all else, then the ports in their order
up to one that is skipped (unless by its own step, or one that failed), the choices of ``first_of``
up to one with a value.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from tactile_graph.errors import Skip

_REF = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
_WORDS = {"and", "or", "not"}


@dataclass(frozen=True)
class Outcome:
    """What a node came to: ``state`` is value, skipped or failed."""

    state: str
    value: Any = None
    origin: str = ""
    unforeseen: bool = field(default=False, compare=False)

    @property
    def has_value(self) -> bool:
        return self.state == "value"


@dataclass(frozen=True)
class NaiveStep:
    """A step as the naive evaluator sees it."""

    ports: tuple[str, ...]
    function: Callable[..., Any]
    optional: Mapping[str, Any] = field(default_factory=dict)
    stateful: bool = False


def value(v: Any) -> Outcome:
    return Outcome("value", v)


class Naive:
    """Evaluates a parsed pipeline file, frame by frame, keeping the state of stateful steps."""

    def __init__(
        self, document: dict[str, Any], library: Mapping[str, Any], steps: Mapping[str, NaiveStep]
    ) -> None:
        self.document = document
        self.library = library
        self.steps = steps
        self.states: dict[str, Any] = {}
        self.hoisted: dict[str, Outcome] = {}

    def run(self, frame: Any, asked: list[str]) -> dict[str, Outcome]:
        """Return the outcome of what is asked for; `ran` then tells what had to run."""
        self.frame = frame
        self.settled: dict[str, Outcome] = {}
        self.ran: Counter[str] = Counter()
        return {name: self.ref(name, self.document, "") for name in asked}

    # -- wires -------------------------------------------------------------------------------

    def ref(self, text: str, document: Any, prefix: str) -> Outcome:
        root, *fields = text.split(".")
        if root == "frame":
            found = value(self.frame)
        elif "use" in document["nodes"][root]:
            return self.used(root, text, document, prefix)
        else:
            found = self.node(root, document, prefix)
        for name in fields:
            if not found.has_value:
                return found
            found = value(getattr(found.value, name))
        if found.has_value and found.value is None:
            return Outcome("skipped", origin=prefix + text)
        return found

    def used(self, root: str, text: str, document: Any, prefix: str) -> Outcome:
        body = document["nodes"][root]
        inner = self.library[body["use"]]
        outputs = {o.replace(".", "_"): o for o in inner["outputs"]}
        at = f"{prefix}{text}"
        if at not in self.settled:
            name = next(iter(outputs.values())) if "." not in text else outputs[text.split(".")[1]]
            guard = self.guard(body, document, prefix, at)
            self.settled[at] = guard or self.ref(name, inner, f"{prefix}{root}/")
        return self.settled[at]

    def whole(self, items: tuple[Any, ...]) -> Outcome:
        """Return a list as a step takes it that knows of no empty place."""
        empty = [v for v in items if isinstance(v, Outcome)]
        kept = tuple(v for v in items if not isinstance(v, Outcome))
        failed = next((o for o in empty if o.state == "failed"), None)
        if failed is not None or (empty and not kept):
            return failed or empty[0]
        return value(kept)

    # -- nodes -------------------------------------------------------------------------------

    def node(self, name: str, document: Any, prefix: str) -> Outcome:
        at = prefix + name
        if at in self.hoisted:
            return self.hoisted[at]
        if at not in self.settled:
            body = document["nodes"][name]
            found = self.guard(body, document, prefix, at) or self.body(body, document, prefix, at)
            self.settled[at] = found
            if self.constant(name, document):
                self.hoisted[at] = found
        return self.settled[at]

    def guard(self, body: Any, document: Any, prefix: str, at: str) -> Outcome | None:
        """Return what the node comes to because of its guard; None where the guard lets it run."""
        if "when" not in body:
            return None
        text = self.spelled(body["when"], document)
        refs = list(dict.fromkeys(r for r in _REF.findall(text) if r not in _WORDS))
        read = {r: self.ref(r, document, prefix) for r in refs}
        lacking = next((o for o in read.values() if not o.has_value), None)
        if lacking is not None:
            return lacking
        try:
            holds = eval(_REF.sub(lambda m: self.word(m.group(), read), text), {})
        except Exception:
            return Outcome("failed", origin=at)
        return None if holds else Outcome("skipped", origin=at)

    def spelled(self, text: str, document: Any) -> str:
        named = document.get("conditions", {})
        return _REF.sub(
            lambda m: f"({named[m.group()]})" if m.group() in named else m.group(), text
        )

    def word(self, word: str, read: dict[str, Outcome]) -> str:
        return word if word in _WORDS else repr(read[word].value)

    def body(self, body: Any, document: Any, prefix: str, at: str) -> Outcome:
        if "first_of" in body:
            return self.choice([(c, document, prefix) for c in body["first_of"]])
        step = self.steps[body["step"]]
        arguments: dict[str, Any] = {}
        lacking: Outcome | None = None
        for port, wired in self.wired(step, body).items():
            found = self.port(wired, document, prefix)
            if found.has_value and isinstance(found.value, tuple) and not body.get("each"):
                found = self.whole(found.value)
                if not found.has_value:
                    return found
            if found.has_value:
                arguments[port] = found.value
            elif found.state == "failed":
                lacking = lacking or found
            elif port in step.optional:
                arguments[port] = step.optional[port]
            else:
                lacking = lacking or found
                if not found.unforeseen:
                    break
        if lacking is not None:
            return lacking
        arguments = {**step.optional, **arguments}
        return (
            self.each(step, body, arguments, at)
            if body.get("each")
            else (self.call(step, body, arguments, at))
        )

    def wired(self, step: NaiveStep, body: Any) -> dict[str, Any]:
        wires = body.get("in")
        if wires is None:
            return {}
        if isinstance(wires, dict):
            return {p: wires[p] for p in step.ports if p in wires}
        if isinstance(wires, str):
            return {step.ports[0]: wires}
        if step.ports == ("items",):
            return {"items": wires}
        return dict(zip(step.ports, wires, strict=False))

    def port(self, wired: Any, document: Any, prefix: str) -> Outcome:
        if isinstance(wired, str):
            return self.ref(wired, document, prefix)
        found = [self.ref(w, document, prefix) for w in wired]
        failed = next((o for o in found if o.state == "failed"), None)
        if failed is not None:
            return failed
        kept = tuple(o.value for o in found if o.has_value)
        return (
            value(kept) if kept else replace(found[0], unforeseen=all(o.unforeseen for o in found))
        )

    def choice(self, choices: list[tuple[str, Any, str]]) -> Outcome:
        found = []
        for choice in choices:
            found.append(self.ref(*choice))
            if found[-1].has_value:
                return found[-1]
        last = replace(found[-1], unforeseen=any(o.unforeseen for o in found))
        return next((o for o in found if o.state == "failed"), last)

    def call(self, step: NaiveStep, body: Any, arguments: dict[str, Any], at: str) -> Outcome:
        settings = dict(body.get("with", {}))
        self.ran[settings.pop("tag")] += 1
        if step.stateful:
            arguments = {
                "state": self.states.setdefault(at, {}),
                "now": self.frame.time_s,
                **arguments,
            }
        try:
            return value(step.function(**arguments, **settings))
        except Skip:
            return Outcome("skipped", origin=at, unforeseen=True)
        except Exception:
            return Outcome("failed", origin=at)

    def each(self, step: NaiveStep, body: Any, arguments: dict[str, Any], at: str) -> Outcome:
        lists = {p: v for p, v in arguments.items() if isinstance(v, tuple)}
        items = []
        for i in range(len(next(iter(lists.values())))):
            item = {p: v[i] for p, v in lists.items()}
            lacking = next((v for v in item.values() if isinstance(v, Outcome)), None)
            items.append(lacking or self.call(step, body, {**arguments, **item}, at))
        if any(o.has_value for o in items):
            return value(tuple(o.value if o.has_value else o for o in items))
        failed = next((o for o in items if o.state == "failed"), None)
        return failed or Outcome("skipped", origin=at)

    # -- what depends on no frame --------------------------------------------------------------

    def constant(self, text: str, document: Any) -> bool:
        """Return whether what is referred to depends on no frame."""
        root, *fields = text.split(".")
        if root == "frame":
            return False
        body = document["nodes"][root]
        if "use" in body:
            inner = self.library[body["use"]]
            outputs = {o.replace(".", "_"): o for o in inner["outputs"]}
            name = outputs[fields[0]] if fields else next(iter(outputs.values()))
            guard = set(_REF.findall(self.spelled(body.get("when", ""), document))) - _WORDS
            return self.constant(name, inner) and all(self.constant(r, document) for r in guard)
        if "step" in body and self.steps[body["step"]].stateful:
            return False
        texts = [self.spelled(body.get("when", ""), document), *body.get("first_of", [])]
        wires = body.get("in", [])
        for w in (
            [wires]
            if isinstance(wires, str)
            else list(wires.values() if isinstance(wires, dict) else wires)
        ):
            texts += [w] if isinstance(w, str) else w
        read = {r for t in texts for r in _REF.findall(t)} - _WORDS
        return all(self.constant(r, document) for r in read)
