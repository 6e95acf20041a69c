"""What plugins test themselves with: steps against their promises, scenes with their truth."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tactile_graph.testing.cases import Case as Case
    from tactile_graph.testing.cases import all_cases as all_cases
    from tactile_graph.testing.check import BrokenPromises as BrokenPromises
    from tactile_graph.testing.check import check_step as check_step
    from tactile_graph.testing.check import examine_step as examine_step
    from tactile_graph.testing.here import StepReport as StepReport
    from tactile_graph.testing.registries import isolated as isolated
    from tactile_graph.testing.running import run_pipeline as run_pipeline
    from tactile_graph.testing.running import run_step as run_step
    from tactile_graph.testing.scenes import scene as scene

# Name -> module. Loaded on first use: pytest imports this package wherever it is installed.
_HOMES = {
    "BrokenPromises": "check",
    "Case": "cases",
    "StepReport": "here",
    "all_cases": "cases",
    "check_step": "check",
    "examine_step": "check",
    "isolated": "registries",
    "run_pipeline": "running",
    "run_step": "running",
    "scene": "scenes",
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tactile_graph.testing' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"tactile_graph.testing.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
