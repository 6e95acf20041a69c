"""Every error of the project; exceptions carry data, ``__str__`` makes the text for people."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches


class TactileGraphError(Exception):
    """Base of every error that a user can cause or meet."""


class Degenerate(TactileGraphError):  # noqa: N818 -- the name of an outcome
    """An expected numeric failure of a step: the input holds too little for an answer.

    A step raises it instead of returning NaN; the node's outcome is then ``failed`` with
    ``kind == "degenerate"``.
    """


class Skip(TactileGraphError):  # noqa: N818 -- the name of an outcome
    """A step has nothing to say for this frame, and why: warming up, nothing new.

    A step raises it instead of giving a value; the node's outcome is then ``skipped``, which is no
    failure.
    """


class DataError(TactileGraphError):
    """A recording, stream or image that does not hold what it should.

    Parameters
    ----------
    where : str
        File and line, port or image the trouble is in.
    what : str
        What is wrong, what was got and what is allowed.
    """

    def __init__(self, where: str, what: str) -> None:
        super().__init__(where, what)
        self.where = where
        self.what = what

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


class UsageError(TactileGraphError):
    """A call or a command line that asks for something that is not there."""


class FrameError(UsageError, ValueError):
    """Something handed in as a frame that makes none."""


class SourceWarning(UserWarning):
    """What a source leaves out or assumes, for who takes its frames without a report."""


class PluginError(TactileGraphError):
    """A plugin that breaks the rules of the house, named by plugin and package."""


class RuleError(TactileGraphError):
    """A frame that breaks a rule (quantity, shape, pitch) of some step of the pipeline."""


_BETWEEN = {
    ":": "a space is missing behind the colon",
    "=": "a key and its value have a colon and a space between them",
    " ": "a colon is missing",
}


@dataclass(frozen=True, slots=True)
class Mark:
    """A place in a file; lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing wrong with a pipeline file: where, what, what was got, what is allowed."""

    mark: Mark | None
    message: str
    snippet: str = ""

    def __str__(self) -> str:
        where = f"{self.mark}: " if self.mark else ""
        return f"{where}{self.message}" + (f"\n{self.snippet}" if self.snippet else "")


class PipelineError(TactileGraphError):
    """All that is wrong with a pipeline, found in one run."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__(tuple(problems))
        self.problems: tuple[Problem, ...] = tuple(problems)

    def __str__(self) -> str:
        return "\n".join(str(p) for p in self.problems)


LONGEST_NAME = 200
"""Characters; nothing is near a longer one, and looking for it takes their square."""


def did_you_mean(got: str, allowed: Iterable[str]) -> str:
    """Return ``"; did you mean 'x'?"`` for the nearest allowed name, or an empty text."""
    if len(str(got)) > LONGEST_NAME:
        return ""
    names = [str(a) for a in allowed]
    near = [name for name in names if name.casefold() == str(got).casefold()]
    near = near or get_close_matches(str(got), names, n=1, cutoff=0.6)
    return f"; did you mean {near[0]!r}?" if near else ""


def text_of(error: BaseException) -> str:
    """Return an error's text, with the file of damaged bytecode; empty if it cannot tell it."""
    try:
        text = str(error)
    except Exception:
        return ""
    damaged = _bytecode(error) if "marshal data" in text else ""
    if not damaged:
        return text
    return f"{text}: {damaged} is damaged; delete its folder, which Python makes anew"


def _bytecode(error: BaseException) -> str:
    """Return the file of compiled code that an import could not take; "" for other errors."""
    from traceback import walk_tb

    for frame, _ in walk_tb(error.__traceback__):
        if frame.f_code.co_name == "_compile_bytecode":  # of the import system
            return str(frame.f_locals.get("bytecode_path") or "")
    return ""


def without(module: str, error: ImportError, missing: str) -> str:
    """Return what is to be said where a library of an extra cannot be imported.

    Parameters
    ----------
    module : str
        What was imported.
    error : ImportError
    missing : str
        The text where the library is not there; one that is there and fails is told by its error.
    """
    head = module.partition(".")[0]
    if isinstance(error, ModuleNotFoundError) and (error.name or "").partition(".")[0] == head:
        return missing
    return f"{missing}; it is installed, but cannot be imported: {text_of(error)}"


def key_typo(got: str, allowed: Iterable[str]) -> str:
    """Return what is wrong between a key and its value, which YAML then takes for one key."""
    names = set(allowed)
    for sign, words in _BETWEEN.items():
        head, found, value = got.partition(sign)
        if found and head.strip() in names:
            return f"; {words}: {head.strip()}: {value.strip()}"
    return ""


def shown(value: object) -> str:
    """Return a value as errors show it: cut where it is long."""
    try:
        text = repr(value)
    except ValueError:  # an integer of more digits than Python prints
        return "a very long number"
    return text if len(text) <= 60 else text[:57] + "..."


def one_of(allowed: Iterable[str], most: int = 12) -> str:
    """Return the allowed names as a readable list, cut after ``most``."""
    names = sorted(str(a) for a in allowed)
    if not names:
        return "none"
    cut = names[:most]
    return ", ".join(cut) + (f", … ({len(names) - most} more)" if len(names) > most else "")
