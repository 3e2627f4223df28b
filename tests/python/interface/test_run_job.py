"""Long work of the core beside Python: Ctrl-C, progress, exceptions. `_wait` is such work that only sleeps."""
import os
import signal
import threading
import time

import pytest

import echopath as ep
from echopath import _core

LONG = 40.0  # s, longer than a machine with other work takes to stop; half a second is promised, which `bench hard` measures


@pytest.mark.hard
def test_ctrl_c_stops_a_job(ctrl_c_is_heard):
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        threading.Timer(0.2, interrupt).start()
        _core._wait(LONG)
    assert time.perf_counter() - sent[0] < LONG / 2


def test_exception_of_progress_stops_the_job_and_is_raised():
    def progress(stage, fraction):
        raise LookupError("enough")

    start = time.perf_counter()
    with pytest.raises(LookupError, match="enough"):
        _core._wait(LONG, progress)
    assert time.perf_counter() - start < LONG / 2


def test_progress_rises_to_one():
    seen = []
    _core._wait(0.4, lambda stage, fraction: seen.append((stage, fraction)))
    fractions = [fraction for _, fraction in seen]
    assert {stage for stage, _ in seen} == {"wait"}
    assert len(seen) >= 3
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert 0.0 < fractions[len(fractions) // 2] < 1.0


def test_progress_must_be_callable():
    with pytest.raises(TypeError, match="progress: must be None, True or a callable .* got int"):
        _core._wait(0.0, 3)


def test_true_shows_a_bar_with_the_name_of_the_stage(capsys):
    _core._wait(0.6, True)
    shown = capsys.readouterr().err
    assert "wait" in shown and "%|" in shown


def test_bars_of_true_are_those_that_tqdm_chooses_and_are_closed_after_an_error(monkeypatch):
    made = []

    class Bar:
        def __init__(self, **settings):
            self.settings, self.n, self.is_closed = settings, 0.0, False
            made.append(self)

        def update(self, step):
            self.n += step
            if self.n > 30.0:
                raise LookupError("enough")

        def close(self):
            self.is_closed = True

    monkeypatch.setattr("tqdm.auto.tqdm", Bar)
    with pytest.raises(LookupError, match="enough"):
        _core._wait(0.5, True)
    assert [bar.settings["desc"] for bar in made] == ["wait"] and made[0].is_closed


def test_false_none_and_short_work_show_nothing(capsys):
    _core._wait(0.02, True)
    _core._wait(0.1, False)
    _core._wait(0.1, None)
    assert capsys.readouterr().err == ""


def test_exception_of_the_work_is_raised_with_its_python_type():
    with pytest.raises(ValueError, match="seconds: must lie in 0 to 3600, got -1"):
        _core._wait(-1.0)


def test_other_python_threads_go_on_while_a_job_runs():
    counts = [0]
    stop = threading.Event()

    def count():
        while not stop.wait(0.005):
            counts[0] += 1

    counter = threading.Thread(target=count)
    counter.start()
    _core._wait(0.3)
    stop.set()
    counter.join()
    assert counts[0] >= 10  # of 60; a held lock gives 0


def test_jobs_run_off_the_main_thread():
    done = []
    worker = threading.Thread(target=lambda: done.append(_core._wait(0.1)))
    worker.start()
    worker.join(5.0)
    assert done == [None]


@pytest.mark.parametrize(("name", "base"), [("FileError", OSError), ("DeviceError", RuntimeError)])
def test_errors_of_the_core_have_builtin_bases(name, base):
    error = getattr(ep, name)
    assert issubclass(error, base)
    assert f"{error.__module__}.{error.__qualname__}" == f"echopath.{name}"


def test_a_missing_file_is_an_os_error(tmp_path):
    with pytest.raises(ep.FileError, match="nothing.obj"):
        ep.load_mesh(str(tmp_path / "nothing.obj"))


def test_number_of_threads_is_what_was_set():
    before = ep.num_threads()
    try:
        ep.set_num_threads(3)
        assert ep.num_threads() == 3
        with pytest.raises(ValueError, match="num_threads: must be a whole number from 0 to 2147483647, got -1"):
            ep.set_num_threads(-1)
    finally:
        ep.set_num_threads(0)
    assert ep.num_threads() == before
