"""Every filter as the engine sees it."""

import subprocess
import sys

import pytest

from tactile_graph.steps.signature import Kind, read_signature
from tactile_graph_filters import tactile_graph_steps

STEPS = tactile_graph_steps()
STATEFUL = {"tare", "find_bad"}


def resolved(name):
    module, _, attribute = STEPS[name].partition(":")
    return getattr(__import__(module, fromlist=[attribute]), attribute)


@pytest.mark.parametrize("name", STEPS)
def test_a_step_lives_in_a_file_of_its_name_and_its_signature_can_be_read(name):
    module = STEPS[name].partition(":")[0].split(".")
    assert (module[0], module[-1]) == ("tactile_graph_filters", name)
    signature = read_signature(name, resolved(name))
    assert signature.ports
    assert signature.summary.endswith(".")
    assert (signature.kind is Kind.CLASS and signature.stateful) == (name in STATEFUL)


@pytest.mark.slow
def test_importing_all_filters_imports_nothing_heavy():
    modules = sorted({home.partition(":")[0] for home in STEPS.values()})
    code = f"import sys\nfor m in {modules}: __import__(m)\n" + (
        "print([m for m in ('numba', 'skimage', 'scipy.ndimage', 'scipy.sparse', 'matplotlib')"
        " if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
