"""A step's outline is read from its source text, never by importing it."""

from __future__ import annotations

import sys

import pytest

from tactile_graph.plugins.outline import first_sentence, outline, summary_of

MODULE = '''
"""A module that must not be imported."""
raise RuntimeError("imported")

class Out(NamedTuple):
    """Two things."""
    mask: Mask
    level: float

class Stateful:
    """Turn it on. Then off."""
    def __init__(self, *, n: int = 1) -> None: ...
    def __call__(
        self, image: Annotated[Image, Quantity("volt")], mask: "Mask", *, gap: TimeGap
    ) -> Annotated[list[Annotated[Image, X]], Y]: ...

def two(image: Image | Mask, /, other: np.ndarray) -> Out:
    """Return
    two things.

    More.
    """
    def inner():
        yield 1

def source(*, n: int) -> Iterator[Frame]:
    yield 1

class Bare:
    """No call."""

from tg_outline_other import moved as renamed
CONSTANT = 3
made: Any = functools.partial(two)
if True:
    def under_if() -> float:
        """Inside."""
try:
    import nothing
except ImportError:
    class InHandler:
        """Handled."""
        def __call__(self, image: Image) -> Mask: ...
'''


@pytest.fixture(autouse=True)
def _module(tmp_path, monkeypatch):
    from tactile_graph.plugins import outline as module

    (tmp_path / "tg_outline.py").write_text(MODULE)
    (tmp_path / "tg_outline_other.py").write_text('def moved() -> float:\n    """Elsewhere."""\n')
    (tmp_path / "tg_outline_torn.py").write_text("def (")
    (tmp_path / "tg_outline_star.py").write_text("from tg_outline_other import *\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    module._tree.cache_clear()
    yield
    assert "tg_outline" not in sys.modules


def test_a_function_with_its_ports_output_and_fields():
    got = outline("tg_outline:two")
    assert got.kind == "function"
    assert got.summary == "Return two things."
    assert got.ports == (("image", "Image | Mask"), ("other", "np.ndarray"))
    assert (got.output, got.fields) == ("Out", ("mask", "level"))
    assert got.wiring == "image: Image | Mask, other: np.ndarray → Out"


def test_a_class_is_read_from_its_call_and_annotations_lose_their_rules():
    got = outline("tg_outline:Stateful")
    assert got.kind == "class"
    assert got.summary == "Turn it on."
    assert got.wiring == "Image, Mask → list[Image]"


def test_a_generator_is_a_source():
    assert outline("tg_outline:source").wiring == "→ frames"


def test_a_name_that_is_handed_on_is_followed():
    assert outline("tg_outline:renamed").summary == "Elsewhere."


def test_what_stands_under_if_and_try_is_found():
    assert outline("tg_outline:under_if").summary == "Inside."
    assert outline("tg_outline:InHandler").wiring == "Image → Mask"


@pytest.mark.parametrize(
    ("target", "trouble"),
    [
        ("tg_outline:absent", "tg_outline has no 'absent'"),
        ("tg_outline:CONSTANT", "tg_outline makes 'CONSTANT' when it is imported"),
        ("tg_outline:made", "tg_outline makes 'made' when it is imported; nothing to read here"),
        ("tg_outline_star:x", "tg_outline_star defines no 'x'; an 'import *' may bring it"),
        ("tg_outline.two", "'tg_outline.two' is no import string 'module:name'"),
        ("tg_outline:Bare", "it is no function and has no __call__"),
        ("tg_no_such:x", "there is no module tg_no_such"),
        ("tg_no_such.inner:x", "cannot import tg_no_such.inner: No module named 'tg_no_such'"),
        (
            "tg_outline_torn:x",
            "cannot read tg_outline_torn: invalid syntax (tg_outline_torn.py, line 1)",
        ),
        (3, "its source cannot be read"),
    ],
)
def test_what_cannot_be_read_says_why(target, trouble):
    got = outline(target)
    assert trouble in got.trouble
    assert got.wiring == ""
    assert summary_of("tg_no_such:x") == ""


def test_a_summary_is_read_without_parsing_and_by_parsing_where_code_tells_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    target = "tactile_graph.cli.commands.run:run"
    quick = summary_of(target)
    assert quick == "Run PIPELINE, a name or a YAML file, over recordings or another source."
    assert summary_of("tg_outline:renamed") == "Elsewhere.", "handed on from module to module"
    assert summary_of("tactile_graph.cli.group:Group").startswith("Commands by name;"), "a class"
    monkeypatch.setattr("tactile_graph.plugins.outline._compiled_doc", lambda target: "")
    assert summary_of(target) == quick


@pytest.mark.parametrize(
    ("doc", "sentence"),
    [
        ("One. Two.", "One."), ("Kåsa's circle, e.g. of points.\n\nMore.",
                                "Kåsa's circle, e.g. of points."),
        ("Over\n  lines. `Next`", "Over lines."), ("", ""),
    ],
)  # fmt: skip
def test_first_sentence(doc, sentence):
    assert first_sentence(doc) == sentence


@pytest.mark.slow
def test_every_installed_step_has_an_outline_that_agrees_with_its_signature():
    from tactile_graph.plugins.registry import installed
    from tactile_graph.steps.signature import Kind

    registry = installed()
    for name in registry.names("steps"):
        got, signature = outline(registry.offer("steps", name).target), registry.step(name)
        assert got.trouble == "", name
        assert [p[0] for p in got.ports] == [p.name for p in signature.ports], name
        assert (got.kind == "source") == (signature.kind is Kind.SOURCE), name
        assert got.summary, name
