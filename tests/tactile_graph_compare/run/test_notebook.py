"""What notebooks show of a comparison, and what is left of it as text."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import pytest

from tactile_graph_compare import Comparison, compare
from tactile_graph_compare.output.tables import heading, tables

pytestmark = pytest.mark.usefixtures("hand_made")


def test_a_comparison_shows_its_tables_and_says_itself_in_a_line() -> None:
    found = compare(["discs", "next.yaml"], n_frames=6)
    assert isinstance(found, Comparison)
    assert repr(found) == f"<Comparison of discs, next: {heading(found)}>"
    page = ET.fromstring(found._repr_html_())
    shown = [[cell.text or "" for cell in row] for row in page.iter("tr")]
    wanted = []
    for table in tables(found):
        wanted.append(list(table.columns))
        before = ""
        for row in table.rows:
            again = table.columns[0] == "quantity" and row[0] == before
            wanted.append(["" if again else row[0], *row[1:]])
            before = row[0]
    assert shown == wanted
    assert heading(found) in "".join(page.itertext())
