"""Numbers in YAML as YAML 1.2 reads them; PyYAML is of 1.1.

To 1.1 ``010`` is eight, ``08`` a text and ``1:30`` ninety. Here the first two are ten and eight and
the last is a text, as to the editors and libraries that know 1.2; ``0o10``, ``0x10``, ``0b1``,
``+010``, ``-.5`` and ``1_000`` are numbers, too.
"""

from __future__ import annotations

import re
from typing import Any

import yaml

_INT, _FLOAT = "tag:yaml.org,2002:int", "tag:yaml.org,2002:float"
WHOLE = re.compile(r"(?:[-+]?(?:0b[01_]+|0x[0-9a-fA-F_]+|[0-9][0-9_]*)|0o[0-7]+)$")
BROKEN = re.compile(
    r"(?:[-+]?[0-9][0-9_]*\.[0-9_]*(?:[eE][-+][0-9]+)?|[-+]?\.[0-9][0-9_]*(?:[eE][-+][0-9]+)?"
    r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))$"
)
_ELSEWHERE = {
    "tag:yaml.org,2002:bool": (re.compile("[yYnN]$"), "yYnN"),
    _INT: (re.compile("0o[0-7]+$"), "0"),
    _FLOAT: (
        re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+\.?[0-9]*)(?:[eE][-+]?[0-9]+)?$"),
        "-+.0123456789",
    ),
}
"""What PyYAML takes for texts, and other readers of 1.1 or 1.2 do not."""
_BASES = {"0b": 2, "0o": 8, "0x": 16}


class Loader(yaml.SafeLoader):
    """PyYAML's safe loader, but for numbers."""


class Constructor(yaml.constructor.SafeConstructor):
    """PyYAML's safe constructor, but for whole numbers."""

    def whole(self, node: yaml.ScalarNode) -> int:
        """Return the value of a whole number.

        Raises
        ------
        ValueError
            If it is none, as a tag can call any word one.
        """
        text = str(self.construct_scalar(node)).replace("_", "").lower()
        digits = text.removeprefix("-").removeprefix("+")
        value = int(digits, _BASES.get(digits[:2], 10))
        return -value if text.startswith("-") else value


class _Dumper(yaml.SafeDumper):
    """PyYAML's safe dumper, which puts a text in quotes that would be a number here, too."""


_whole: Any = Constructor.whole  # PyYAML's types know no constructor of one's own
Constructor.add_constructor(_INT, _whole)
Loader.yaml_implicit_resolvers = {
    first: [(tag, words) for tag, words in resolvers if tag not in (_INT, _FLOAT)]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
for _kind in (Loader, _Dumper):
    _kind.add_implicit_resolver(_FLOAT, BROKEN, list("-+0123456789."))
    _kind.add_implicit_resolver(_INT, WHOLE, list("-+0123456789"))


def quote_for_all(dumper: Any) -> None:
    """Have one of PyYAML's dumpers put in quotes what any reader takes for other than a text."""
    for tag, (words, first) in _ELSEWHERE.items():
        dumper.add_implicit_resolver(tag, words, list(first))


quote_for_all(_Dumper)


def in_yaml(value: Any, **options: Any) -> str:
    """Return plain data as YAML that is read as the same data by 1.1 and by 1.2.

    Parameters
    ----------
    value : plain data
    **options
        As of ``yaml.safe_dump``.
    """
    return str(yaml.dump(value, Dumper=_Dumper, **options))


def on_one_line(value: Any) -> str:
    """Return plain data as YAML on one line, as it may stand within a list or mapping, too."""
    asked: dict[str, Any] = {"default_flow_style": True, "width": 10**9, "allow_unicode": True}
    text = in_yaml([value], **asked)
    if "\n" in text.strip():  # within quotes of the other kind
        text = in_yaml([value], default_style='"', **asked)
    return text.strip()[1:-1]


def is_plain(text: str) -> bool:
    """Return whether a text is to YAML what it is: 2024-03-01 is a date, and *.npy no text."""
    return in_yaml(text, width=10**9, allow_unicode=True).removesuffix("\n...\n") == text
