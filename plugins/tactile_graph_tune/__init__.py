"""Guards, ladders and settings found by measurement: the command ``tune``."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from tactile_graph import hookimpl

if TYPE_CHECKING:
    from tactile_graph_tune.request import Request as Request
    from tactile_graph_tune.tuned import Tuned as Tuned
    from tactile_graph_tune.tuner import tune as tune

# Name -> module, loaded on first use: listing the plugins must stay quick.
_HOMES = {"Request": "request", "Tuned": "tuned", "tune": "tuner"}
__all__ = ["Request", "Tuned", "tune"]


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the command that finds guards, the order of a ladder, and settings."""
    return {"tune": f"{__name__}.commands.tune:tune"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
