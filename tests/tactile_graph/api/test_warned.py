"""What a source reports to who gives no report: as warnings, each once, and in the results."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from tactile_graph import SourceWarning, load
from tactile_graph.steps import Report

pytestmark = pytest.mark.slow
MATRIX = ["0"] * 35


@pytest.fixture
def damaged(tmp_path):
    path = tmp_path / "damaged.csv"
    head = ",".join(f"r{i}c{j}" for i in range(5) for j in range(7))
    lines = [",".join(MATRIX[: -1 if k in (2, 5) else None]) for k in range(9)]
    path.write_text("\n".join([head, *lines, ""]))
    return load("contacts").with_source("recording", path=str(path))


def told(found):
    assert all(w.category is SourceWarning for w in found)
    assert {w.filename for w in found} == {__file__}
    return [str(w.message) for w in found]


@pytest.mark.parametrize("ask", ["stream", "frames"])
def test_what_a_source_leaves_out_and_assumes_is_warned_of_once(damaged, ask):
    with pytest.warns(SourceWarning) as found:
        frames = list(getattr(damaged, ask)())
    assert len(frames) == 7
    path = damaged.source.settings["path"]
    assert told(found) == [
        "source 'recording': recordings whose pitch is assumed to be 1 cm",
        f"source 'recording': {path}:4: 34 values, not 35",
        f"source 'recording': {path}:7: 34 values, not 35",
        "source 'recording': damaged records skipped: 2, troubles: 2",
    ]


def test_the_results_have_the_report_and_one_that_is_given_takes_the_place_of_warnings(damaged):
    results = damaged.stream()
    with pytest.warns(SourceWarning):
        list(results)
    assert results.report.counts["damaged records skipped"] == 2
    report = Report()
    results = damaged.stream(report=report)
    assert len(list(results)) == len(list(damaged.frames(0, Report()))) == 7
    assert results.report is report
    assert report.counts == {**report.counts, "damaged records skipped": 2, "frames": 7}
    assert [*report.assumed] == ["recordings whose pitch is assumed to be 1 cm"]


def test_nothing_is_warned_of_where_a_source_says_all(tmp_path):
    pipeline = load("contacts").with_source("simulate", scene="disc-1", frames=3)
    path = tmp_path / "whole.npz"
    values = np.arange(60.0).reshape(3, 4, 5)
    np.savez(path, values=values, quantity="counts", pitch_cm=(1.0, 1.0), valid=values > 3.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(list(pipeline.stream())) == len(list(pipeline.frames())) == 3
        list(load("contacts").with_source("recording", path=str(path)).stream())
        list(load("contacts").stream([np.zeros((4, 4))]))


def test_a_stream_left_early_closes_its_source(damaged):
    with pytest.warns(SourceWarning), damaged.stream() as results:
        next(results)
    with pytest.raises(StopIteration):
        next(results)
