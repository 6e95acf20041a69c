"""What plugins look inside with is one module, and all it lists is there and documented."""

from __future__ import annotations

import inspect as look

import pytest

from tactile_graph import inspect


def test_it_exports_what_it_lists_and_nothing_else() -> None:
    public = {name for name in vars(inspect) if not name.startswith("_")}
    assert public == set(inspect.__all__)
    assert len(inspect.__all__) == len(public)


@pytest.mark.parametrize("name", inspect.__all__)
def test_the_page_of_the_module_tells_every_name(name: str) -> None:
    assert f"`{name}`" in (inspect.__doc__ or "")
    thing = getattr(inspect, name)
    if look.isclass(thing) or look.isfunction(thing):
        assert thing.__doc__
