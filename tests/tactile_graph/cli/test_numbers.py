"""Options that take a number take a finite one; messages say which option, what and what for."""

from __future__ import annotations

from collections.abc import Iterator

import click
import pytest
from click.testing import CliRunner

from tactile_graph.cli.app import cli
from tactile_graph.cli.numbers import Finite


@click.command()
@click.option("--price", type=Finite(min=0.0, min_open=True))
@click.option("--margin", type=Finite(min=0.0), default=0.0)
@click.option("--scale", type=Finite())
@click.option("--share", type=Finite(0.0, 1.0))
def command(price: float | None, margin: float, scale: float | None, share: float | None) -> None:
    """Take numbers."""
    click.echo(f"{price} {margin} {scale} {share}")


OUT = "; for no limit leave the option out"


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (("--price", "nan"), "'--price': must be a finite number in the range x>0.0, got nan\n"),
        (("--price", "inf"), f"a finite number in the range x>0.0, got inf{OUT}\n"),
        (("--price", "1e999"), f"a finite number in the range x>0.0, got 1e999{OUT}\n"),
        (("--margin", "inf"), "a finite number in the range x>=0.0, got inf\n"),
        (("--scale", "-inf"), "'--scale': must be a finite number, got -inf\n"),
        (("--share", "nan"), "a finite number in the range 0.0<=x<=1.0, got nan\n"),
        (("--price", "0"), "'--price': 0.0 is not in the range x>0.0.\n"),
        (("--price", "a"), "'--price': 'a' is not a valid float"),
    ],
)
def test_what_is_no_finite_number_is_refused(args: tuple[str, ...], message: str) -> None:
    got = CliRunner().invoke(command, args)
    assert got.exit_code == 2
    assert message in got.stderr


def test_numbers_are_taken_and_a_range_without_ends_is_not_described() -> None:
    given = ["--price", "1e3", "--margin", "0", "--scale", "-2.5", "--share", "1"]
    assert CliRunner().invoke(command, given).stdout == "1000.0 0.0 -2.5 1.0\n"
    shown = CliRunner().invoke(command, ["--help"]).stdout
    assert "x>0" in shown
    assert "None" not in shown


def _commands(group: click.Group) -> Iterator[tuple[str, click.Command]]:
    ctx = click.Context(group)
    for name in group.list_commands(ctx):
        found = group.get_command(ctx, name)
        assert found is not None
        yield name, found


@pytest.mark.slow
def test_no_command_takes_a_number_that_is_not_finite() -> None:
    loose = [
        f"{name} {param.opts[0]}"
        for name, found in _commands(cli)
        for param in found.params
        if isinstance(param.type, click.types.FloatParamType) and not isinstance(param.type, Finite)
    ]
    assert loose == []
