"""The command, its server and its bench, as processes of their own."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import pytest

from helpers_cli import call
from helpers_live import COUNTS, PIPELINE, Command, Page, Sending, running, words_of
from helpers_serial import KITS, FakePad, Kit

for part in ("starlette", "uvicorn", "websockets"):
    pytest.importorskip(part, reason="the live extra is not installed")

pytestmark = pytest.mark.slow


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "mine.yaml").write_text(PIPELINE)
    return tmp_path


@pytest.fixture
def command(folder: Path) -> Iterator[Command]:
    with running(folder, "mine.yaml", "--rate", "40") as found:
        yield found


@pytest.fixture(scope="module")
def shared_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shared")
    (folder / "mine.yaml").write_text(PIPELINE)
    return folder


@pytest.fixture(scope="module")
def shared(shared_folder: Path) -> Iterator[Command]:
    """Return a command for tests that leave it as they found it."""
    with running(shared_folder, "mine.yaml", "--rate", "40") as found:
        yield found


def fetched(address: str, **headers: str) -> tuple[int, dict[str, str], bytes]:
    """Return status, headers and body of an answer."""
    names = {k.replace("_", "-"): v for k, v in headers.items()}
    request = urllib.request.Request(address, headers=names)
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.status, dict(answer.headers), answer.read()
    except urllib.error.HTTPError as error:
        return error.code, dict(error.headers), error.read()


def test_a_page_is_told_all_it_shows(command: Command, folder: Path) -> None:
    with Page(command) as page:
        hello = page.until("hello")
        assert (hello["pipeline"], hello["source"], hello["live"]) == ("mine", "sample", False)
        assert hello["file"] == "mine.yaml"
        graph = page.until("graph")
        assert graph["yaml"] == PIPELINE
        assert [n["name"] for n in graph["nodes"]] == ["footprint", "boundary", "circle"]
        page.ask("show", nodes=["footprint"])
        frame = page.until("frame")
        while not frame["pictures"] or frame["nodes"]["circle"]["outcome"] != "ran":
            frame = page.until("frame")
        assert set(frame["pictures"]) == {"footprint"}
        assert frame["nodes"]["circle"]["us"] > 0
        assert {s["role"] for s in frame["drawing"]} == {"found", "true"}
        (row,) = frame["rows"]
        assert row["output"] == "circle"
        assert frame["errors"]["circle.centre_error_cm"] == row["centre_error_cm"]
        pulse = page.until("pulse", viewers=1)
        assert pulse["shed"] == 0
        while page.until("pulse")["page_latency_us"]["median"] is None:
            pass


def test_the_file_saved_runs_at_once_and_a_wrong_one_is_told(
    command: Command, folder: Path
) -> None:
    path = folder / "mine.yaml"
    with Page(command) as page:
        page.until("graph")
        page.until("frame", version=1)
        path.write_text(PIPELINE.replace("0.01", "0.02"))
        graph = page.until("graph")
        assert "0.02" in graph["yaml"]
        page.until("frame", version=graph["version"])
        path.write_text(PIPELINE.replace("threshold", "treshold"))
        (fault,) = page.until("trouble")["errors"]
        assert (fault["line"], fault["column"]) == (4, 21)
        assert "did you mean 'threshold'" in fault["text"]
        page.until("frame", version=graph["version"])
        path.write_text(PIPELINE)
        assert page.until("graph")["version"] > graph["version"]
        assert page.until("trouble")["errors"] == []


def test_two_hundred_wrong_saves_leave_the_old_graph_running(
    command: Command, folder: Path
) -> None:
    path = folder / "mine.yaml"
    with Page(command) as page:
        page.until("frame")
        for i in range(200):
            wrong = PIPELINE[: i * len(PIPELINE) // 200] + ("[" if i % 2 else "\n  : }")
            path.write_text(wrong)
            if i % 20 == 19:
                assert page.until("trouble")["errors"]
                page.until("frame", version=1)
        page.until("frame", version=1)
        path.write_text(PIPELINE.replace("0.01", "0.03"))
        page.until("frame", version=page.until("graph")["version"])


def test_settings_are_set_taken_back_and_saved(shared: Command, shared_folder: Path) -> None:
    with Page(shared) as page:
        page.until("graph")
        page.ask("set", node="footprint", setting="level_v", value=0.05)
        graph = page.until("graph")
        (setting,) = [s for s in graph["nodes"][0]["settings"] if s["name"] == "level_v"]
        assert (setting["value"], setting["changed"], setting["kind"]) == (0.05, True, "number")
        assert "level_v: 0.05" in graph["yaml"]
        page.ask("set", node="footprint", setting="level_v", value="high")
        assert "must be a number" in page.told("level_v")["text"]
        page.ask("save", name="better")
        page.told("wrote")
        assert (shared_folder / "better.yaml").read_text() == graph["yaml"]
        page.ask("save", name="../better")
        assert page.told("a name is of letters")["level"] == "error"
        assert graph["file_yaml"] == PIPELINE
        page.ask("unset", node="footprint", setting="level_v")
        assert page.until("graph")["yaml"] == PIPELINE
        page.ask("set", node="footprint", setting="level_v", value=0.05)
        page.until("graph")
        page.ask("unset")
        assert page.until("graph")["yaml"] == PIPELINE


def test_pause_step_scrub_and_back(shared: Command) -> None:
    with Page(shared) as page:
        for _ in range(30):
            page.until("frame")
        page.ask("pause")
        page.until("pulse", paused=True)
        time.sleep(0.3)
        page.ask("scrub", back_s=0.4)
        back = page.until("frame")
        while back["back_s"] < 0.3:
            back = page.until("frame")
        page.ask("step")
        assert page.until("frame")["index"] == back["index"] + 1
        page.ask("set", node="footprint", setting="level_v", value=0.5)
        again = page.until("frame", version=page.until("graph")["version"])
        assert again["index"] == back["index"] + 1
        page.ask("live")
        page.until("pulse", paused=False)
        assert page.until("frame", back_s=0.0)["index"] > back["index"]
        page.ask("unset")
        assert page.until("graph")["yaml"] == PIPELINE


def test_what_is_played_waits_and_is_stepped_through(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "200") as command, Page(command) as page:
        page.until("frame")
        page.ask("pause")
        page.until("pulse", paused=True)
        counts = [-1] * 6
        while len(set(counts[-6:])) > 1 or counts[-1] < 1:  # it stands still
            counts.append(page.until("pulse")["kept_frames"])
        n = counts[-1]
        page.ask("scrub", back_s=0.0)
        page.until("frame", index=n - 1)  # kept are those too that were shed
        page.ask("step")
        page.until("frame", index=n)
        while page.until("pulse")["kept_frames"] != n + 1:
            pass


def test_a_pause_ends_when_whoever_asked_for_it_has_left(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "100") as command, Page(command) as stays:
        with Page(command) as page:
            page.ask("pause")
            stays.until("pulse", paused=True)
        stays.told("has left: it goes on")
        n = stays.until("pulse", paused=False)["frames"]
        while stays.until("pulse")["frames"] < n + 20:
            pass


def test_a_recording_holds_every_frame_with_its_label(shared: Command, shared_folder: Path) -> None:
    pytest.importorskip("zarr", reason="the zarr extra is not installed")
    before = {*shared_folder.glob("*.zarr")}
    with Page(shared) as page:
        page.until("frame")
        page.ask("record", on=True, label="cup")
        page.told("recording to")
        while page.until("pulse")["recording"]["frames"] < 30:
            pass
        page.ask("record", on=True, label="plate")
        time.sleep(0.5)
        page.ask("record", on=False)
        page.told("recorded")
    (store,) = {*shared_folder.glob("*.zarr")} - before
    import tactile_graph as tg
    from tactile_graph.steps import Report

    recorded = tg.loads(PIPELINE).with_source("recording", path=str(store))
    frames = list(recorded.frames(report=Report()))  # times begin anew where the scene does
    numbers = [f.index for f in frames]
    assert len(frames) >= 30
    assert numbers == list(range(len(numbers)))
    assert {f.label for f in frames} == {"cup", "plate"}
    assert frames[0].truth is not None


def test_a_source_that_has_ended_is_not_started_over_into_a_recording(folder: Path) -> None:
    with running(folder, "mine.yaml", "--once", "--rate", "2000") as command, Page(command) as page:
        page.until("pulse", state="ended")
        page.ask("record", on=True, label="")
        page.told("recording to")
        page.ask("set", node="footprint", setting="level_v", value=0.5)
        (fault,) = page.until("trouble")["errors"]
        assert "end that, then change again" in fault["text"]
        page.ask("record", on=False)
        page.told("recorded no frame")
        page.ask("set", node="footprint", setting="level_v", value=0.5)
        page.until("frame", version=3)


def test_a_recording_begins_with_its_key_press(command: Command) -> None:
    """To make the first store of a session takes longer than this recording lasts."""
    pytest.importorskip("zarr", reason="the zarr extra is not installed")
    with Page(command) as page:
        page.until("frame")
        page.ask("record", on=True)
        first = page.until("frame")["index"]
        while page.until("frame")["index"] < first + 8:
            pass
        page.ask("record", on=False)
        told = page.told("recorded")["text"]
    assert int(told.replace("no frame", "0").split()[1]) >= 4


def test_a_recording_that_is_ended_before_it_has_begun_ends(
    shared: Command, shared_folder: Path
) -> None:
    pytest.importorskip("zarr", reason="the zarr extra is not installed")
    with Page(shared) as page:
        page.until("frame")
        for on in (True, False, True, True, False):
            page.ask("record", on=on, label="cup")
        page.told("recorded")
        page.told("recorded")
        while page.until("pulse")["recording"]["on"]:
            pass
    assert not list(shared_folder.glob(".*.writer"))


def test_ctrl_c_closes_the_recording_and_leaves_no_process(command: Command, folder: Path) -> None:
    pytest.importorskip("zarr", reason="the zarr extra is not installed")
    with Page(command) as page:
        page.until("frame")
        page.ask("record", on=True)
        while page.until("pulse")["recording"]["frames"] < 10:
            pass
        bench = command.bench()
        code, out = command.end()
    assert (code, "recorded" in out) == (0, True)
    assert "Traceback" not in out
    with pytest.raises(ProcessLookupError):
        os.kill(bench, 0)
    (store,) = folder.glob("*.zarr")
    assert call("check", str(store)).exit_code == 0


@pytest.mark.parametrize("wait_s", [0.0, 0.05, 0.5])
def test_ctrl_c_while_a_recording_begins_ends_the_command(
    command: Command, folder: Path, wait_s: float
) -> None:
    pytest.importorskip("zarr", reason="the zarr extra is not installed")
    with Page(command) as page:
        page.until("frame")
        page.ask("record", on=True)
        time.sleep(wait_s)
        code, out = command.end()
    assert (code, "Traceback" in out) == (0, False)
    assert not list(folder.glob(".*.writer"))


def test_what_ends_all_processes_at_once_still_keeps_the_recording_whole(
    command: Command, folder: Path
) -> None:
    """As a service manager does, or a terminal that is closed."""
    pytest.importorskip("zarr", reason="the zarr extra is not installed")
    with Page(command) as page:
        page.until("frame")
        page.ask("record", on=True)
        while page.until("pulse")["recording"]["frames"] < 10:
            pass
        for child in command.children():
            os.kill(child, signal.SIGTERM)
        code, out = command.end(signal.SIGTERM)
    assert code == 143
    assert "recorded" in out
    assert "did not come in time" not in out
    assert "died" not in out
    (store,) = folder.glob("*.zarr")
    assert call("check", str(store)).exit_code == 0


def test_ctrl_c_for_all_processes_as_the_bench_starts_is_no_error(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "40", "--beside", "circle-1") as command:
        end = time.monotonic() + 3.0
        while time.monotonic() < end:  # from before it imports anything until it runs
            for child in command.children():
                with suppress(ProcessLookupError):
                    os.kill(child, signal.SIGINT)
            time.sleep(0.02)
        with Page(command) as page:
            page.until("frame")
        code, out = command.end()
    assert (code, "Traceback" in out, "died" in out) == (0, False, False)


def test_the_end_comes_to_the_bench_even_when_the_server_is_killed(command: Command) -> None:
    with Page(command) as page:
        page.until("frame")
        bench = command.bench()
    command.end(signal.SIGKILL)
    for _ in range(300):
        time.sleep(0.1)
        try:
            stat = Path(f"/proc/{bench}/stat").read_text()
        except (FileNotFoundError, ProcessLookupError):
            return
        if stat.rpartition(")")[2].split()[0] == "Z":
            return
    raise AssertionError("the bench goes on")


def test_a_bench_that_dies_is_started_anew(command: Command) -> None:
    with Page(command) as page:
        page.until("frame")
        os.kill(command.bench(), signal.SIGKILL)
        page.told("started anew")
        page.got.clear()
        page.until("frame")


def test_a_pause_outlives_the_bench(command: Command) -> None:
    with Page(command) as page:
        page.until("frame")
        page.ask("pause")
        page.until("pulse", paused=True)
        os.kill(command.bench(), signal.SIGKILL)
        page.told("started anew")
        page.until("pulse", state="waiting", kept_frames=0)
        for index in range(2):
            page.ask("step")
            page.until("frame", index=index)


def test_a_recording_and_a_tare_outlive_the_bench(folder: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    endless = ("--source", "simulate", "--with", "frames=100000", "--rate", "40")
    with running(folder, "mine.yaml", *endless) as command, Page(command) as page:
        page.ask("record", on=True, label="")
        page.ask("tare")
        page.told("tared by the median")
        page.until("pulse", tared=True)
        os.kill(command.bench(), signal.SIGKILL)
        page.told("not recorded, which leaves a gap")
        n = page.until("pulse")["recording"]["frames"]
        while (pulse := page.until("pulse"))["recording"]["frames"] < n + 10:
            pass
        assert pulse["tared"]
        page.ask("record", on=False)
        assert "process died" in page.told("recorded")["text"]
    (store,) = folder.glob("*.zarr")
    import tactile_graph as tg
    from tactile_graph.steps import Report

    recorded = tg.loads(PIPELINE).with_source("recording", path=str(store))
    frames = list(recorded.frames(report=Report()))  # times begin anew where the scene does
    assert sum(f.gap for f in frames) == 1


def test_a_tare_that_is_under_way_outlives_the_bench(command: Command) -> None:
    with Page(command) as page:
        page.until("frame")
        page.ask("tare")
        time.sleep(0.1)  # thirty frames take 0.75 s
        os.kill(command.bench(), signal.SIGKILL)
        page.told("tared by the median")


def test_tare_takes_off_what_lies_there(shared: Command) -> None:
    with Page(shared) as page:
        page.until("frame")
        page.ask("tare")
        page.told("tared by the median")
        page.until("pulse", tared=True)
        page.ask("untare")
        page.until("pulse", tared=False)


def test_what_is_held_is_shown_again_as_the_tare_has_it(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "200") as command, Page(command) as page:
        page.until("frame")
        page.ask("tare")
        page.until("pulse", tared=True)
        page.ask("pause")
        page.until("pulse", paused=True)
        page.ask("scrub", back_s=0.0)
        tared = page.until("frame", latency_us=None)
        page.ask("untare")
        read = page.until("frame", index=tared["index"], latency_us=None)
        assert read["pad"]["readings"] != tared["pad"]["readings"]


def test_a_tare_while_what_is_played_is_held_says_what_it_waits_for(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "200") as command, Page(command) as page:
        page.until("frame")
        page.ask("pause")
        page.until("pulse", paused=True)
        page.ask("tare")
        page.told("what is played is held")
        page.ask("live")
        page.told("tared by the median")


def test_programs_take_every_result_in_order(shared: Command) -> None:
    with Page(shared, "results") as program:
        rows = [program.next() for _ in range(60)]
    numbers = [r["frame"] for r in rows if r["type"] == "result"]
    assert numbers == sorted(set(numbers))  # on a busy machine some are shed
    found = [r for row in rows for r in row.get("rows", ()) if r["outcome"] == "ok"]
    assert {"output", "x_cm", "radius_cm", "centre_error_cm"} <= set(found[0])


def test_results_go_out_as_osc(folder: Path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(30)
        target = f"127.0.0.1:{receiver.getsockname()[1]}"
        with running(folder, "mine.yaml", "--osc", target):
            got = [receiver.recv(2000) for _ in range(10)]
    assert all(g.startswith(b"#bundle\0") for g in got)
    assert any(b"/circle/0/radius_cm\0" in g for g in got)


def test_one_that_reads_nothing_is_dropped_and_harms_nobody(shared: Command) -> None:
    with socket.create_connection(("127.0.0.1", shared.port)) as deaf, Page(shared) as page:
        deaf.sendall(
            f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{shared.port}\r\nUpgrade: websocket\r\n"
            "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
        )
        page.until("pulse", viewers=2)
        page.until("pulse", viewers=1)
        page.until("frame")


@pytest.mark.parametrize(
    "sent", ["no json", "[]", "[" * 5000, '{"type": "nope"}', '{"type": "set", "node": 1}', "{}"]
)
def test_nonsense_from_a_page_stops_nothing(shared: Command, sent: str) -> None:
    with Page(shared) as page, Page(shared) as other:
        page.until("frame")
        page.socket.send(sent)
        other.until("frame")
        other.until("frame")


# -- who may ask ---------------------------------------------------------------------------------


def test_the_page_is_served_with_its_policy(shared: Command) -> None:
    status, headers, body = fetched(shared.address)
    assert (status, b"<!doctype html>" in body.lower()) == (200, True)
    assert headers["content-security-policy"].startswith("default-src 'none'")
    assert fetched(f"{shared.address}index.html")[0] == 200


@pytest.mark.parametrize(
    "path", ["../pyproject.toml", "%2e%2e/commands/live.py", "..%2f..%2f__init__.py", "mine.yaml",
             "page/index.html", "__init__.py", "index.html%00.js", "/etc/passwd"]
)  # fmt: skip
def test_nothing_else_is_served(shared: Command, path: str) -> None:
    assert fetched(f"{shared.address}{path}")[0] in (403, 404)


def test_other_sites_and_rebound_names_are_refused(shared: Command) -> None:
    from websockets.exceptions import InvalidStatus

    assert fetched(shared.address, Host="evil.example")[0] == 403
    assert fetched(shared.address, Origin="http://evil.example")[0] == 403
    for path in ("live", "results"):
        with pytest.raises(InvalidStatus):
            Page(shared, path, {"Origin": "http://evil.example"})
    Page(shared, headers={"Origin": f"http://127.0.0.1:{shared.port}"}).close()


def test_an_address_that_others_reach_wants_the_token_that_is_printed(folder: Path) -> None:
    from websockets.exceptions import InvalidStatus

    with running(folder, "mine.yaml", "--host", "0.0.0.0") as command:
        address, _, query = command.address.partition("?")
        here = address.replace("0.0.0.0", "127.0.0.1")
        token = query.removeprefix("token=")
        assert len(token) >= 20
        assert fetched(here)[0] == 403
        assert fetched(f"{here}?token=wrong")[0] == 403
        status, headers, _ = fetched(f"{here}?{query}")
        assert status == 200
        cookie = headers["set-cookie"].partition(";")[0]
        assert fetched(f"{here}index.html", Cookie=cookie)[0] == 200
        with pytest.raises(InvalidStatus):
            Page(Command(command.process, here))
        with Page(Command(command.process, here), headers={"Cookie": cookie}) as page:
            page.until("frame")


def test_hostile_names_stay_text(folder: Path) -> None:
    name = "<script>alert(1)</script>\u202e"
    (folder / "mine.yaml").write_text(
        PIPELINE.replace("pipeline: mine", f'pipeline: mine\nabout: "{name}"')
    )
    with running(folder, "mine.yaml") as command, Page(command) as page:
        assert page.until("hello")["about"] == "<script>alert(1)</script>\\u202e"
        page.ask("record", on=True, label="\x1b[2J<b>")
        state = page.until("pulse")
        while not state["recording"]["on"]:
            state = page.until("pulse")
        assert state["recording"]["label"] == "\\u001b[2J<b>"


# -- what goes wrong -----------------------------------------------------------------------------


def test_a_port_that_is_taken_is_said_with_one_that_is_free(folder: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = subprocess.run(
            [sys.executable, "-m", "tactile_graph", "live", "mine.yaml", "--http-port", str(port)],
            cwd=folder, capture_output=True, text=True, timeout=60,
        )  # fmt: skip
    assert done.returncode == 2
    assert f"port {port} of 127.0.0.1 is taken; --http-port {port + 1}" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--port", "/dev/nope", "--preset", "fsrray"], "'/dev/nope' cannot be opened"),
        (["--port", "/dev/nope"], "Missing option '--preset'"),
        (["--port", "/dev/nope", "--preset", "fsrray", "--source", "sample"], "not both"),
        (["nope.npz"], "there is no such file"),
        (["--deadline", "2"], "must be a time such as 2ms"),
        (["--osc", "here"], "must be HOST:PORT"),
        (["--set", "footprint.level_v=high"], "must be a number"),
        (["--host", "203.0.113.7"], "cannot serve on 203.0.113.7"),
        (["--folder", "mine.yaml/x"], "--folder"),
    ],
)
def test_what_cannot_be_shown_is_said_at_once(
    monkeypatch: pytest.MonkeyPatch, folder: Path, arguments: list[str], said: str
) -> None:
    monkeypatch.chdir(folder)
    done = call("live", "mine.yaml", "--http-port", "0", *arguments)
    assert done.exit_code == 2
    assert said in done.stderr
    assert isinstance(done.exception, SystemExit)  # no traceback


def test_without_the_extra_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    import importlib.util

    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.chdir(folder)
    done = call("live", "mine.yaml")
    assert done.exit_code == 2
    assert 'pip install "tactile-graph[live]"' in done.output


def test_every_message_is_json_without_nan(shared: Command) -> None:
    with Page(shared) as page:
        for _ in range(40):
            page.next()
        for message in page.got:
            json.dumps(message, allow_nan=False)


# -- a pad on a port -----------------------------------------------------------------------------


def test_a_pad_is_unplugged_and_plugged_in_again_and_the_page_is_told(tmp_path: Path) -> None:
    kit = next(k for k in KITS if k.preset == "fabric-16x16")
    (tmp_path / "mine.yaml").write_text(COUNTS)
    pad = FakePad(tmp_path / "tty")
    sending = Sending(pad, kit)
    with (
        sending,
        running(tmp_path, "mine.yaml", "--port", str(pad.link), "--preset", kit.preset) as command,
        Page(command) as page,
    ):
        assert page.until("hello")["live"] is True
        before = page.until("frame")
        with sending.pad_lock:
            pad.unplug()
            page.told("unplugged")
            while "unplugged" not in page.until("pulse", state="waiting")["trouble"]:
                pass
            pad.plug_in()
        page.until("pulse", trouble="")
        assert page.until("frame")["index"] > before["index"]
        while page.until("pulse")["lost"] == 0:
            pass
        page.ask("pause")
        page.until("pulse", paused=True)
        n = page.until("pulse")["frames"]
        while page.until("pulse")["frames"] < n + 20:  # it goes on though nobody looks
            pass
        assert page.until("pulse")["counters"]["good frames"] > 20


PRESET = """\
preset: mine
transport: {{baud: 115200}}
framer: {{kind: text, separator: ','}}
geometry: {{rows: {}, columns: 8, flip: {}}}
"""


@contextmanager
def pad_of_lines(folder: Path, rows: int = 8) -> Iterator[tuple[Command, Page, Sending]]:
    """Run the command and a page on a pad of 8 x 8 cells, by a preset of so many rows."""
    kit = Kit("mine", (8, 8), 900, lambda pad, _: b",".join(b"%d" % v for v in pad.flat) + b"\n")
    (folder / "mine.yaml").write_text(COUNTS)
    (folder / "kit.yaml").write_text(PRESET.format(rows, "none"))
    pad = FakePad(folder / "tty")
    options = ("mine.yaml", "--port", str(pad.link), "--preset", "kit.yaml")
    sending = Sending(pad, kit)
    with sending, running(folder, *options) as command, Page(command) as page:
        yield command, page, sending


def test_a_preset_saved_opens_the_port_again_without_the_tare_and_the_recording(
    tmp_path: Path,
) -> None:
    zarr = pytest.importorskip("zarr", reason="the zarr extra is not installed")
    with pad_of_lines(tmp_path) as (_, page, _):
        page.ask("tare")
        page.told("tared by the median")
        page.ask("record", on=True, label="")
        while (before := page.until("pulse"))["recording"]["frames"] < 10:
            pass
        assert before["tared"]
        (tmp_path / "kit.yaml").write_text(PRESET.format(8, "rows"))
        page.told("tare anew")
        page.told("the recording ends here")
        page.told("recorded")
        n = page.until("pulse", tared=False)["frames"]
        while (pulse := page.until("pulse"))["frames"] < n + 20:
            assert pulse["state"] != "ended"
        assert not pulse["recording"]["on"]
    (store,) = tmp_path.glob("*.zarr")
    kept = zarr.open_group(store, mode="r").attrs
    assert (kept["port"], kept["preset"]) == (str(tmp_path / "tty"), "kit.yaml")


def test_the_terminal_is_not_told_at_each_try_what_a_page_may_not_save(command: Command) -> None:
    with Page(command) as page:
        for _ in range(5):
            page.ask("save", name="../mine")
            page.told("../mine")
    _, out = command.end()
    assert out.count("../mine") == 1


@pytest.mark.parametrize("by", ["preset", "bench"])
def test_a_source_that_begins_anew_waits_for_a_pad_that_is_unplugged(
    tmp_path: Path, by: str
) -> None:
    with pad_of_lines(tmp_path) as (command, page, sending):
        page.until("frame")
        with sending.unplugged():
            page.told("lost")
            if by == "preset":
                (tmp_path / "kit.yaml").write_text(PRESET.format(8, "rows"))
            else:
                os.kill(command.bench(), signal.SIGKILL)
            page.told("could not open port")
            page.until("pulse", state="waiting")
        page.told("back")
        page.until("pulse", trouble="", state="running")
        _, out = command.end()
        assert re.search(r"^\d\d:\d\d:\d\d  warning: \S+tty: lost ", out, re.M)


def test_a_page_that_comes_late_is_told_why_nothing_comes_until_the_preset_is_right(
    tmp_path: Path,
) -> None:
    with pad_of_lines(tmp_path, rows=9) as (command, page, _):
        page.told("stalled")
        with Page(command) as late:
            while "the size 9 x 8" not in late.until("pulse")["trouble"]:
                pass
            (tmp_path / "kit.yaml").write_text(PRESET.format(8, "none"))
            late.until("frame")  # although the port was held by one that waited
            late.until("pulse", state="running", trouble="")


# -- on time, and beside -------------------------------------------------------------------------


def test_a_deadline_skips_what_does_not_fit_and_names_it(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "40", "--deadline", "1us") as command:
        with Page(command) as page:
            assert page.until("hello")["deadline_us"] == 1.0
            frame = page.until("frame")
            while not frame["decisions"]:
                frame = page.until("frame")
            skipped = frame["nodes"][frame["decisions"][0]]
            assert (skipped["outcome"], skipped["reason"]) == ("skipped", "deadline")
            while page.until("pulse")["missed"] == 0:
                pass
        with Page(command, "results") as program:
            while not program.next()["deadline"]:
                pass


def test_a_variant_runs_beside_and_what_it_came_to_is_kept(folder: Path) -> None:
    (folder / "other.yaml").write_text(PIPELINE.replace("0.01", "0.5").replace("mine", "other"))
    with running(
        folder, "mine.yaml", "--rate", "40", "--beside", "other.yaml", "--folder", "kept"
    ) as command:
        with Page(command) as page:
            beside = page.until("pulse")["beside"]
            while not beside or beside["frames"] < 10:
                beside = page.until("pulse")["beside"]
            assert beside["variant"] == "other"
            assert beside["trouble"] == ""
        code, out = command.end()
    assert code == 0
    assert "other beside: " in out
    (figures,) = (folder / "kept").glob("*-beside-other.json")
    told = json.loads(figures.read_text())
    assert told["frames"] >= 10
    assert {"frame", "difference", "first", "beside"} == set(told["kept"][0])


def test_ten_viewers_get_the_newest_and_cost_no_frame(folder: Path) -> None:
    with running(folder, "mine.yaml", "--rate", "100") as command, ExitStack() as open_pages:
        pages = [open_pages.enter_context(Page(command)) for _ in range(10)]
        for page in pages:
            page.until("frame")
        # A busy machine sheds frames too: what counts is that it can be without.
        for _ in range(20):
            before = pages[0].until("pulse", viewers=10)
            for page in pages:
                index = [page.until("frame")["index"] for _ in range(5)]
                assert index == sorted(set(index))
            pulse = pages[0].until("pulse", viewers=10)
            if pulse["shed"] == before["shed"] and pulse["rate_hz"] > 50:
                return
        raise AssertionError(f"ten viewers cost frames: {before}, {pulse}")


def compilers(command: Command) -> list[int]:
    """Return the processes that compile for the bench."""
    task, numbers = Path(f"/proc/{command.bench()}/task"), list[str]()
    for thread in task.iterdir():
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended meanwhile
            numbers += (thread / "children").read_text().split()
    return [int(c) for c in numbers if "compiled.service" in words_of(int(c))]


@pytest.mark.parametrize("deadline", [(), ("--deadline", "1s")])
def test_on_an_empty_cache_only_what_is_timed_waits_for_the_compiler(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, deadline: tuple[str, ...]
) -> None:
    """Plain code answers meanwhile; times that a deadline is kept by are those of machine code."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "empty"))
    monkeypatch.delenv("TACTILE_GRAPH_KERNELS", raising=False)
    with running(tmp_path, "bayes-smooth", "--rate", "5", *deadline) as command:
        with Page(command, "results") as page:
            page.socket.recv(timeout=120)
            working = compilers(command)
        assert bool(working) is not bool(deadline)
        code, _ = command.end()
    assert code == 0
    for number in working:  # it would work for a minute at most, for the next start
        with suppress(ProcessLookupError):
            os.kill(number, signal.SIGTERM)
