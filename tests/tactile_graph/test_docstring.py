"""numpydoc docstrings are read section by section."""

from tactile_graph.docstring import parameters, sections

DOC = """Return a thing.

It is good.

Parameters
----------
a, b : float
    Both
    of them.
*rest
    Others.
c : {"x", "y"}

Raises
------
ValueError
    If not.
"""


def test_sections_and_the_prose_before_them():
    got = sections(DOC)
    assert got[""] == "Return a thing.\n\nIt is good."
    assert got["Raises"] == "ValueError\n    If not."
    assert list(got) == ["", "Parameters", "Raises"]


def test_parameters_share_and_join_their_lines():
    assert parameters(DOC) == {
        "a": "Both of them.",
        "b": "Both of them.",
        "rest": "Others.",
        "c": "",
    }


def test_a_docstring_without_sections_is_all_prose():
    assert sections("Only words.") == {"": "Only words."}
    assert parameters("Only words.") == parameters("") == {}
