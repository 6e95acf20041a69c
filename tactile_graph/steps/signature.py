"""Read what a step needs and gives from its signature."""

from __future__ import annotations

import inspect
import types
import typing
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import (
    Annotated,
    Any,
    NotRequired,
    Required,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np

from tactile_graph.errors import PluginError, shown
from tactile_graph.steps.injected import Report, is_time_gap
from tactile_graph.steps.own import bound, own
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.steps.spread import Record, Spread, spread

REQUIRED: Any = inspect.Parameter.empty


class Kind(Enum):
    """How a step is called."""

    FUNCTION = "function"
    CLASS = "class"
    SOURCE = "source"


@dataclass(frozen=True)
class Port:
    """One input of a step: a positional parameter."""

    name: str
    type: Any
    default: Any = REQUIRED
    quantity: Quantity | None = None
    grid: Grid | None = None

    @property
    def required(self) -> bool:
        """Whether the node is skipped when this port is."""
        return self.default is REQUIRED

    @property
    def item(self) -> Any:
        """The item type of a list port; None for any other port."""
        return list_item(self.type)


@dataclass(frozen=True)
class Setting:
    """One setting of a step: a keyword-only parameter, or one of a class's ``__init__``.

    ``record`` is set where it is a field of a parameter that is spread.
    """

    name: str
    annotation: Any
    default: Any = REQUIRED
    quantity: Quantity | None = None
    record: Record | None = field(default=None, compare=False)

    @property
    def required(self) -> bool:
        """Whether a pipeline must give it."""
        return self.default is REQUIRED

    @property
    def meaning(self) -> str:
        """What the docstring of the dataclass it is a field of says of it, else empty."""
        return self.record.meaning(self.name) if self.record else ""


@dataclass(frozen=True)
class Signature:
    """Ports, settings and output of a step.

    ``identity`` tells it from steps of the same name that other plugins offer.
    """

    name: str
    target: Callable[..., Any]
    kind: Kind
    ports: tuple[Port, ...]
    settings: tuple[Setting, ...]
    output: Any
    output_quantity: Quantity | None = None
    output_grid: Grid | None = None
    rng: str = ""
    rng_at_init: bool = False
    report: str = ""
    gap: str = ""
    stateful: bool = False
    identity: str = ""

    @property
    def is_own(self) -> bool:
        """Whether it is the project's own, whose identity names no plugin."""
        return bool(self.identity) and "." not in self.identity

    @cached_property
    def doc(self) -> str:
        """The step's whole docstring, dedented."""
        return inspect.getdoc(self.target) or ""

    @property
    def summary(self) -> str:
        """First sentence of the docstring."""
        return self.doc.partition("\n\n")[0].replace("\n", " ").strip()

    def port(self, name: str) -> Port | None:
        """Return the port of that name, or None."""
        return next((p for p in self.ports if p.name == name), None)

    def arguments(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return settings as the target takes them: those that are spread in their dataclass.

        They are the caller's own: whoever changes a list among them changes nobody else's.
        """
        values = {name: own(value) for name, value in values.items()}
        records = {s.name: s.record for s in self.settings if s.record is not None}
        if not records:
            return values
        out = {n: v for n, v in values.items() if n not in records}
        for record in {r.parameter: r for r in records.values()}.values():
            its = {n: v for n, v in values.items() if n in records and records[n] is record}
            out[record.parameter] = record.made(its)
        return out

    def form(
        self, name: str, settings: Mapping[str, Any], made: Callable[[], Any]
    ) -> Callable[..., Any]:
        """Return another form that the target offers by an attribute, its settings taken.

        Parameters
        ----------
        name : str
            Of the attribute: a function's takes the settings beside, a class's is a method.
        settings : mapping
            Every setting of the step.
        made : callable
            Gives the step with its settings, where it is a class.
        """
        if self.kind is Kind.CLASS:
            return getattr(made(), name)  # type: ignore[no-any-return]
        return bound(getattr(self.target, name), self.arguments(settings))

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the outputs of a NamedTuple return, else empty."""
        return tuple(getattr(self.output, "_fields", ()))


def strip(annotation: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return the bare type and the ``Annotated`` metadata, of a typed dict's field too."""
    origin = get_origin(annotation)
    if origin is Annotated:
        bare, *metadata = get_args(annotation)
        bare, inner = strip(bare)
        return bare, (*inner, *metadata)
    if origin in (Required, NotRequired):
        return strip(get_args(annotation)[0])
    return annotation, ()


def list_item(kind: Any) -> Any:
    """Return X for ``list[X]``, ``tuple[X, ...]`` or ``Sequence[X]``, else None, as for a set."""
    origin = get_origin(kind)
    if origin in (Union, types.UnionType):
        inner = [list_item(a) for a in get_args(kind) if a is not type(None)]
        return inner[0] if len(inner) == 1 else None
    args = get_args(kind)
    if origin is tuple:
        return args[0] if len(args) == 2 and args[1] is Ellipsis else None
    is_list = isinstance(origin, type) and issubclass(origin, Iterable) and len(args) == 1
    return args[0] if is_list and not issubclass(origin, AbstractSet) else None


def _pick(annotation: Any, kind: type) -> Any:
    """Return the rule of that kind in an annotation, also in ``Annotated[Image, …] | None``."""
    bare, metadata = strip(annotation)
    found = next((m for m in metadata if isinstance(m, kind)), None)
    if found is None and get_origin(bare) in (Union, types.UnionType):
        found = next((f for a in get_args(bare) if (f := _pick(a, kind)) is not None), None)
    return found


def _parameters(name: str, target: Callable[..., Any]) -> list[inspect.Parameter]:
    try:
        return list(inspect.signature(target).parameters.values())
    except ValueError as error:
        raise PluginError(f"step {name!r}: its signature cannot be read: {error}") from error


def _of_method(name: str, target: type, method: str) -> list[inspect.Parameter]:
    """Return the parameters of a class's method, without the instance, whatever that is called."""
    parameters = _parameters(name, getattr(target, method))
    static = isinstance(inspect.getattr_static(target, method), staticmethod)
    return parameters if static else parameters[1:]


def _hints(name: str, target: Callable[..., Any]) -> dict[str, Any]:
    try:
        return get_type_hints(target, include_extras=True)
    except Exception as error:
        raise PluginError(f"step {name!r}: its annotations cannot be read: {error}") from error


def _annotation(name: str, hints: dict[str, Any], p: inspect.Parameter) -> Any:
    if p.kind in (p.VAR_POSITIONAL, p.VAR_KEYWORD):
        raise PluginError(f"step {name!r}: *args and **kwargs cannot be wired; name each parameter")
    if p.kind is p.POSITIONAL_ONLY:
        raise PluginError(f"step {name!r}: {p.name!r} is wired by name; take the '/' away")
    if p.name not in hints:
        raise PluginError(f"step {name!r}: parameter {p.name!r} has no annotation")
    return hints[p.name]


def _port(name: str, hints: dict[str, Any], p: inspect.Parameter) -> Port:
    annotation = _annotation(name, hints, p)
    rules = _pick(annotation, Quantity), _pick(annotation, Grid)
    return Port(p.name, strip(annotation)[0], p.default, *rules)


def _setting(p: inspect.Parameter, annotation: Any) -> Setting:
    return Setting(p.name, annotation, p.default, _pick(annotation, Quantity))


def read_signature(name: str, target: Callable[..., Any]) -> Signature:
    """Return what ``target`` needs and gives.

    Raises
    ------
    PluginError
        If the target is no step: not callable, unannotated, or with ``*args``.
    """
    if inspect.isclass(target):
        return _read_class(name, target)
    if not inspect.isroutine(target):  # a partial, an instance with __call__, a number
        what = f"{shown(target)} is not a function or class"
        raise PluginError(f"step {name!r}: {what}: write one around it")
    if inspect.iscoroutinefunction(target) or inspect.isasyncgenfunction(target):
        raise PluginError(f"step {name!r}: an 'async' function cannot be a step")
    hints = _hints(name, target)
    parameters = _parameters(name, target)
    positional = [p for p in parameters if p.kind is not p.KEYWORD_ONLY]
    injected, settings = _split(name, hints, [p for p in parameters if p.kind is p.KEYWORD_ONLY])
    source = inspect.isgeneratorfunction(target)
    if source and positional:
        raise PluginError(
            f"step {name!r}: a source takes no ports, but {positional[0].name!r} is positional"
        )
    if injected["gap"]:
        raise PluginError(f"step {name!r}: only a class's __call__ can take a TimeGap")
    output, quantity, grid = _output(name, hints, source)
    return Signature(
        name,
        target,
        Kind.SOURCE if source else Kind.FUNCTION,
        tuple(_port(name, hints, p) for p in positional),
        settings,
        output,
        quantity,
        grid,
        rng=injected["rng"],
        report=injected["report"],
    )


def _split(
    name: str, hints: dict[str, Any], parameters: list[inspect.Parameter]
) -> tuple[dict[str, str], tuple[Setting, ...]]:
    """Tell the engine's own parameters (generator, report, gap) from settings."""
    injected = {"rng": "", "report": "", "gap": ""}
    settings: list[Setting] = []
    for p in parameters:
        annotation = _annotation(name, hints, p)
        bare, metadata = strip(annotation)
        if bare is np.random.Generator:
            injected["rng"] = p.name
        elif bare is Report:
            injected["report"] = p.name
        elif is_time_gap(metadata):
            injected["gap"] = p.name
        elif (marker := next((m for m in metadata if isinstance(m, Spread)), None)) is not None:
            record, found = spread(name, p, bare, marker)
            settings += [Setting(n, a, d, _pick(a, Quantity), record) for n, a, d in found]
        else:
            settings.append(_setting(p, annotation))
    names = [s.name for s in settings]
    if twice := [n for n in names if names.count(n) > 1]:
        raise PluginError(f"step {name!r}: it has two settings named {twice[0]!r}")
    return injected, tuple(settings)


def _output(
    name: str, hints: dict[str, Any], source: bool
) -> tuple[Any, Quantity | None, Grid | None]:
    if "return" not in hints:
        raise PluginError(f"step {name!r}: it has no return annotation")
    annotation = hints["return"]
    quantity, grid = _pick(annotation, Quantity), _pick(annotation, Grid)
    bare = strip(annotation)[0]
    if source:
        if get_origin(bare) not in (Iterator, Iterable, Generator):
            raise PluginError(f"step {name!r}: a source returns Iterator[Frame]")
        annotation = get_args(bare)[0]
        bare = strip(annotation)[0]
        quantity, grid = quantity or _pick(annotation, Quantity), grid or _pick(annotation, Grid)
    return bare, quantity, grid


def _read_class(name: str, target: type) -> Signature:
    call = target.__call__ if "__call__" in dir(target) else None
    if call is None or not inspect.isfunction(call):
        raise PluginError(f"step {name!r}: class {target.__name__} has no __call__ for its ports")
    init = inspect.getattr_static(target, "__init__")
    has_init = inspect.isfunction(init)
    init_hints = _hints(name, init) if has_init else {}
    init_parameters = _of_method(name, target, "__init__") if has_init else []
    from_init, settings = _split(name, init_hints, init_parameters)
    hints = _hints(name, call)
    parameters = _of_method(name, target, "__call__")
    positional = [p for p in parameters if p.kind is not p.KEYWORD_ONLY]
    injected, extra = _split(name, hints, [p for p in parameters if p.kind is p.KEYWORD_ONLY])
    if extra:
        raise PluginError(
            f"step {name!r}: setting {extra[0].name!r} belongs into __init__, not __call__"
        )
    if from_init["gap"] or from_init["report"] or injected["report"]:
        raise PluginError(f"step {name!r}: a TimeGap goes to __call__, a Report only to a source")
    output, quantity, grid = _output(name, hints, source=False)
    return Signature(
        name,
        target,
        Kind.CLASS,
        tuple(_port(name, hints, p) for p in positional),
        settings,
        output,
        quantity,
        grid,
        rng=from_init["rng"] or injected["rng"],
        rng_at_init=bool(from_init["rng"]),
        gap=injected["gap"],
        # Knowing when it last ran, or drawing on from frame to frame, is a state too.
        stateful=not getattr(target, "stateless", False)
        or bool(injected["gap"] or from_init["rng"]),
    )


def type_name(kind: Any) -> str:
    """Return a type as a person would write it: ``list[Circle]``, ``Image | Mask``."""
    bare, _ = strip(kind)
    if bare is type(None):
        return "None"
    origin = get_origin(bare)
    if origin in (Union, types.UnionType):
        return " | ".join(type_name(a) for a in get_args(bare))
    if origin is typing.Literal:
        return " | ".join(repr(a) for a in get_args(bare))
    if origin is not None:
        inner = ", ".join("..." if a is Ellipsis else type_name(a) for a in get_args(bare))
        return f"{getattr(origin, '__name__', origin)}[{inner}]"
    return str(getattr(bare, "__name__", bare))
