"""``Trust``: whether units are where they seem to be, by what vouched for them one by one."""

from __future__ import annotations

from enum import Enum, auto

ALONE_FOR = 8
"""Units without a rival after which a doubt is over: flips may hide a header now and then."""
HELD_FOR = 8
"""Units in a row that must hold against rivals to end a doubt that came with a loss: of very many
that do not, one may seem to by chance."""
EARNED_AFTER = 8
"""Units without a doubt after which a header that comes to stand among the values is trusted to
have come with the scene."""


class Verdict(Enum):
    """What rivals mean for a phase."""

    ALONE = auto()  # there is none
    HOLDS = auto()
    NEW = auto()  # a header that comes to stand among the values
    EITHER = auto()  # the same is seen from each, and nothing else tells
    LOST = auto()


SURE = (Verdict.ALONE, Verdict.HOLDS)


class Trust:
    """Turns verdicts on one unit after the other into doubt, and says which may be learned.

    A doubt that comes with a header in a run of units without a loss is over as soon as units
    hold: that a cut of just the length from header to header came with it is unlikelier than any
    scene. One that comes with a loss stays until many hold, or until there is no rival.
    """

    def __init__(self) -> None:
        self.doubt = False
        self._owed = 1  # units in a row that must hold to end the doubt
        self._held = self._alone = self._clear = 0

    @property
    def strict(self) -> bool:
        """Whether a loss may have led astray: places may agree by chance, nothing is learned."""
        return self.doubt and self._owed > 1

    def lock(self, doubtful: bool, wary: bool) -> None:
        """Begin a run of units, after a loss or at first."""
        self._owed = HELD_FOR if doubtful or self.strict else 1
        self.doubt = doubtful or wary or self.doubt
        self._held = self._alone = self._clear = 0

    def pass_clear(self, n: int) -> None:
        """Take note of ``n`` units without a rival."""
        self._clear += n

    def weigh(self, verdict: Verdict, rivals_about: bool, wary: bool) -> None:
        """Take the verdict on the next unit; ``wary`` where headers stood among the values."""
        self._alone = 0 if rivals_about else self._alone + 1
        self._held = self._held + 1 if verdict is Verdict.HOLDS else 0
        self._clear += not self.doubt
        if verdict is Verdict.HOLDS:
            self.doubt = self.doubt and self._held < self._owed
        elif verdict is Verdict.ALONE:
            # Where one stood so far and is not seen, that may be a flip's doing.
            self._owed = self._owed if self.doubt else 1
            self.doubt = (self.doubt or wary) and self._alone < ALONE_FOR
        elif not self.doubt:
            self.doubt = True
            earned = verdict is Verdict.NEW and self._clear >= EARNED_AFTER
            self._owed = 1 if earned else HELD_FOR
