"""Step ``correct_place``: contacts moved to where a learned pad says, with their deviation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame, loads
from tactile_graph.errors import RuleError, UsageError
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_filters.contacts.correct_place import CorrectPlace, PlacedContact
from tactile_graph_pads.learning.patch import N_PLACE, PatchKind
from tactile_graph_pads.learning.place import PlaceCorrection, write_place

SHAPE = (12, 16)
LEARNED = """
learned:
  {{reading: raw, rows: 12, columns: 16, pitch_cm: [0.5, 0.8], origin_cm: [1, 2], elements: t.csv,
   noise: 1.0, touched_from: 6.0, place: {place}}}
"""


@pytest.fixture
def pad(tmp_path: Path) -> str:
    """A pad that moves all by half a cell in x and a quarter in y, give or take 0.1 and 0.2."""
    kind = PatchKind(3)
    n = N_PLACE + kind.size
    weights = np.zeros((n, 2))
    weights[0] = 0.5, 0.25
    correction = PlaceCorrection(
        kind, SHAPE, np.zeros(kind.size), 1.0, weights, np.zeros((n, n)), np.array([0.1, 0.2])
    )
    write_place(tmp_path / "place.npz", correction)
    (tmp_path / "pad.yaml").write_text(LEARNED.format(place="place.npz"))
    return str(tmp_path / "pad.yaml")


def two_spots() -> Image:
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    values = sum(
        40.0 * np.exp(-((column - x) ** 2 + (row - y) ** 2) / 2.0) for x, y in ((4, 5), (11, 6))
    )
    return Image(np.asarray(values), (0.5, 0.8), (1.0, 2.0), "raw")


def test_centres_move_in_cm_and_carry_their_deviation(pad: str) -> None:
    image = two_spots()
    found = contacts(image, image.mask(image.values > 6.0)).contacts
    placed = CorrectPlace(pad=pad)(image, found)
    assert placed.count == 2
    for before, after in zip(found, placed.contacts, strict=True):
        assert isinstance(after, PlacedContact)
        assert after.x_cm - before.x_cm == pytest.approx(0.25)
        assert after.y_cm - before.y_cm == pytest.approx(0.2)
        assert (after.x_std_cm, after.y_std_cm) == pytest.approx((0.05, 0.16))
        assert (after.area_cm2, after.load, after.box) == (before.area_cm2, before.load, before.box)
        assert after.mask.count == before.mask.count


def test_no_contacts_stay_none(pad: str) -> None:
    assert CorrectPlace(pad=pad)(two_spots(), ()).count == 0


def test_a_pad_without_a_correction_or_another_image_is_refused(pad: str, tmp_path: Path) -> None:
    bare = tmp_path / "bare.yaml"
    bare.write_text(LEARNED.format(place="''"))
    with pytest.raises(UsageError, match=r"bare.yaml' has no correction of place"):
        CorrectPlace(pad=str(bare))
    step = CorrectPlace(pad=pad)
    with pytest.raises(RuleError, match="of raw on 12 x 16 elements, got raw on 4 x 4"):
        step(Image(np.zeros((4, 4)), (1.0, 1.0), (0.0, 0.0), "raw"), ())
    with pytest.raises(RuleError, match=r"at a pitch of 0.5 x 0.8 cm, got 0.8 x 0.5 cm"):
        step(Image(np.zeros(SHAPE), (0.8, 0.5), (0.0, 0.0), "raw"), ())


def test_what_takes_contacts_takes_placed_ones_and_guards_know_their_deviation(pad: str) -> None:
    pipeline = loads(f"""
pipeline: p
source: {{step: sample, with: {{name: discs}}}}
nodes:
  touched: {{step: threshold, in: frame, with: {{level: 6.0}}}}
  contacts: {{step: contacts, in: [frame, touched]}}
  placed: {{step: correct_place, in: [frame, contacts.contacts], with: {{pad: {pad}}}}}
  moved: {{step: align_contacts, in: placed.contacts, with: {{shift_cm: [1, 0]}}}}
  tracks: {{step: track, in: placed.contacts}}
outputs: [moved, tracks]
""")
    result = pipeline.run(Frame(two_spots()))
    assert result["moved"].contacts[0].x_std_cm == pytest.approx(0.05)
    assert len(result["tracks"].tracks) == 2
