"""``judged``: what became of a statement of the text, by the findings of the items made."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from tactile_graph_thesis.item import Finding
from tactile_graph_thesis.making import Outcome
from tactile_graph_thesis.sections.reading import Claim

COMES_OUT = "comes out"
DOES_NOT = "does not come out"
SHOWN = "shown, not judged"
BUILT = "built in"
NOT_HERE = "cannot be measured here"
OPEN = "not measured yet"
FAILED = "could not be made"
KINDS = (COMES_OUT, DOES_NOT, SHOWN, BUILT, NOT_HERE, OPEN, FAILED)
"""Every verdict, in the order they are counted."""


class Judged(NamedTuple):
    """The verdict on a statement.

    Parameters
    ----------
    verdict : str
        One of `KINDS`.
    because : tuple of str
        What came out, or why nothing did.
    commands : tuple of str
        What shows it.
    """

    verdict: str
    because: tuple[str, ...]
    commands: tuple[str, ...]


def judged(claim: Claim, found: Mapping[str, Outcome]) -> Judged:
    """Return the verdict on a statement.

    Parameters
    ----------
    claim : Claim
    found : mapping
        Item's id -> its outcome.
    """
    for verdict, why in ((BUILT, claim.built), (NOT_HERE, claim.not_here), (OPEN, claim.open)):
        if why:
            return Judged(verdict, (why,), (claim.command,) if claim.command else ())
    commands = tuple(f"tactile-graph reproduce {name}" for name in claim.items)
    lacking = [name for name in claim.items if name not in found or found[name].made is None]
    if lacking:
        return Judged(FAILED, tuple(lacking), commands)
    if not claim.finding:
        return Judged(SHOWN, tuple(found[name].item.shows for name in claim.items), commands)
    told = [finding_of(claim, found[name]) for name in claim.items]
    lacking = [name for name, one in zip(claim.items, told, strict=True) if one is None]
    if lacking:
        return Judged(FAILED, tuple(f"{n}: no finding on it" for n in lacking), commands)
    findings = [one for one in told if one is not None]
    holds = all(one.holds != claim.against for one in findings)
    because = tuple(one.found for one in findings)
    return Judged(COMES_OUT if holds else DOES_NOT, because, commands)


def finding_of(claim: Claim, outcome: Outcome) -> Finding | None:
    """Return the one finding of an item that a statement is judged by, None if there is not one.

    It is the one that begins with the statement's words, or else holds them.

    Parameters
    ----------
    claim : Claim
    outcome : Outcome
    """
    findings = outcome.made.findings if outcome.made else ()
    told = [one for one in findings if one.thesis.startswith(claim.finding)]
    told = told or [one for one in findings if claim.finding in one.thesis]
    return told[0] if len(told) == 1 else None


def counted(judgements: Iterable[Judged]) -> dict[str, int]:
    """Return how many verdicts there are of each kind that occurs.

    Parameters
    ----------
    judgements : iterable of Judged
    """
    counts = Counter(one.verdict for one in judgements)
    return {kind: counts[kind] for kind in KINDS if counts[kind]}
