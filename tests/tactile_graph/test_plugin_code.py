"""What an output hangs on of a plugin: all that it installed, and nothing that is made of it."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from helpers_graphs import STEPS, registry
from tactile_graph import loads
from tactile_graph.plugin_code import digests_of
from tactile_graph.provenance import code_digest


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path
    for name in [n for n in sys.modules if n.partition(".")[0] in ("padsofmine", "helpofmine")]:
        del sys.modules[name]


def write(folder: Path, texts: Mapping[str, str]) -> None:
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def install(folder: Path, *, edited: bool, top: str = "", record: tuple[str, ...] = ()) -> None:
    about = "mine_pads-1.0.dist-info"
    url = {"url": folder.as_uri(), "dir_info": {"editable": edited}}
    write(folder, {
        f"{about}/METADATA": "Metadata-Version: 2.1\nName: mine-pads\nVersion: 1.0\n",
        f"{about}/direct_url.json": json.dumps(url),
        f"{about}/top_level.txt": top,
        f"{about}/RECORD": "".join(f"{name},,\n" for name in (*record, f"{about}/METADATA")),
    })  # fmt: skip


def changes(folder: Path, name: str, module: str, text: str = "N = 2\n") -> bool:
    """Return whether another text in a file gives other digests."""
    before = digests_of("mine-pads", [module])
    assert before
    write(folder, {name: text})
    return digests_of("mine-pads", [module]) != before


@pytest.mark.parametrize(
    "name",
    ["padsofmine/pads/steps.py", "padsofmine/pads/data/table.csv", "padsofmine/other/fast.so"],
)
def test_of_a_namespace_all_portions_of_the_package_count(folder: Path, name: str) -> None:
    install(folder, edited=True)
    files = ("pads/__init__.py", "pads/steps.py", "pads/data/table.csv", "other/fast.so")
    write(folder, {f"padsofmine/{file}": "N = 1\n" for file in files})
    assert changes(folder, name, "padsofmine.pads.steps")


@pytest.mark.parametrize("edited", [True, False])
def test_a_module_beside_the_one_of_the_step_counts(folder: Path, edited: bool) -> None:
    files = ("padsofmine.py", "helpofmine.py")
    install(folder, edited=edited, top="padsofmine\nhelpofmine\n", record=() if edited else files)
    write(folder, dict.fromkeys(files, "N = 1\n"))
    assert changes(folder, "helpofmine.py", "padsofmine")


@pytest.mark.parametrize("edited", [True, False])
@pytest.mark.parametrize(
    ("name", "counts"),
    [
        ("padsofmine/table.csv", True),
        ("padsofmine/fast.so", True),
        ("padsofmine/__pycache__/steps.cpython-311.pyc", False),
        ("otherofmine/steps.py", False),
    ],
)
def test_data_and_machine_code_count_and_caches_do_not(
    folder: Path, edited: bool, name: str, counts: bool
) -> None:
    files = ("padsofmine/__init__.py", "padsofmine/table.csv", "padsofmine/fast.so")
    cache = "padsofmine/__pycache__/steps.cpython-311.pyc"
    install(folder, edited=edited, record=() if edited else (*files, cache))
    write(folder, dict.fromkeys((*files, cache, "otherofmine/steps.py"), "N = 1\n"))
    assert changes(folder, name, "padsofmine") == counts


def test_weights_in_a_package_count_and_so_does_what_a_link_in_it_leads_to(folder: Path) -> None:
    install(folder, edited=True)
    files = ("padsofmine/__init__.py", "padsofmine/model.pth", "weights/old.json")
    write(folder, dict.fromkeys(files, "N = 1\n"))
    (folder / "padsofmine" / "data").symlink_to(folder / "weights")
    (folder / "padsofmine" / "back").symlink_to(folder / "padsofmine")
    assert changes(folder, "padsofmine/model.pth", "padsofmine")
    assert changes(folder, "weights/old.json", "padsofmine")


def test_another_package_on_the_path_of_an_edited_one_counts(folder: Path) -> None:
    install(folder, edited=True, record=("_mine_pads.pth",))
    files = ("src/padsofmine/__init__.py", "src/helpofmine/__init__.py", "src/tests/__init__.py")
    write(folder, dict.fromkeys(files, "N = 1\n") | {"_mine_pads.pth": f"{folder / 'src'}\n"})
    sys.path.insert(0, str(folder / "src"))
    try:
        assert changes(folder, "src/helpofmine/__init__.py", "padsofmine")
        assert not changes(folder, "src/tests/__init__.py", "padsofmine")
    finally:
        sys.path.remove(str(folder / "src"))


def test_what_is_written_beside_an_installed_package_later_does_not_count(folder: Path) -> None:
    install(folder, edited=False, record=("padsofmine/__init__.py",))
    write(folder, {"padsofmine/__init__.py": "N = 1\n"})
    assert not changes(folder, "padsofmine/log.txt", "padsofmine")


def test_steps_that_no_package_installed_are_told_by_their_modules() -> None:
    text = "pipeline: p\nnodes:\n  a: {step: s, in: frame}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry({"s": STEPS["read"]}))
    assert code_digest([pipeline]) == code_digest([pipeline]) != code_digest([])
    assert digests_of("no-such-package", ["typed_nowhere"]) == []
