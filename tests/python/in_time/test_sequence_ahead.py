"""The next frame is traced while this one is used: bits, order, exceptions, early leaving, Ctrl-C, memory."""
import functools
import gc
import itertools
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import pytest

import echopath as ep
from echopath.frame import run
from echopath.guard.check import Check, warn_of
from echopath.sequence import ahead, sequence, unused_memory
from echopath.sequence.ahead import one_ahead
from support.background import heed_ctrl_c
from support.frames_in_time import INTERVAL, SETTINGS, make_radar, make_scene, make_sequence, signal_of

WAIT = 30.0            # s, for a thread on a busy machine
SOAK, SETTLED = 30, 5  # frames of a soak, and those after which memory is to be flat
GROWTH = 1.05          # of the resident memory


@pytest.fixture(autouse=True)
def two_threads():
    """Also on one processor, where else nothing would be done ahead."""
    ep.set_num_threads(2)
    yield
    ep.set_num_threads(0)


def ahead_threads() -> list:
    return [one for one in threading.enumerate() if one.name == "echopath-ahead"]


def street_of_movers() -> ep.Sequence:
    """A wall at rest, a car and two plates that move, before a radar that drives: labels look at the geometry of each frame."""
    scene = make_scene()
    scene.add(ep.actors.car(speed=7.0), name="car", position=(8.0, -2.0, 0.0))
    scene.add(ep.actors.plate(1.0, 1.0), name="screen", material="metal", position=(6.0, 1.0, 0.5),
              motion=ep.LinearMotion((0.0, -1.0, 0.0)))
    scene.add(ep.actors.wall(30.0, 4.0), name="wall", material="concrete", position=(10.0, 4.0, 0.0))
    radar = make_radar(motion=ep.LinearMotion((2.0, 0.0, 0.0)))
    return ep.Sequence(scene, radar, frames=4, interval=INTERVAL, **SETTINGS | {"num_rays": 3000, "parts": None})


def everything_of(frame) -> tuple:
    labels = frame.labels["parts"]
    return (signal_of(frame), [repr(one) for one in labels.objects], [repr(one) for one in labels.ghosts],
            frame.truth.to_records().tobytes())


def test_frames_of_what_moves_are_the_same_alone_in_order_and_in_reverse():
    made = street_of_movers()
    in_order = [everything_of(frame) for frame in made]
    assert [everything_of(frame) for frame in reversed(street_of_movers())] == in_order[::-1]
    assert [everything_of(street_of_movers()[place]) for place in (3, 1)] == [in_order[3], in_order[1]]
    assert [everything_of(made[place]) for place in (0, 2)] == [in_order[0], in_order[2]]


def test_frames_asked_for_in_the_middle_of_a_loop_do_not_disturb_it():
    made = street_of_movers()
    expected = [everything_of(made[place]) for place in range(4)]
    for place, frame in enumerate(made):
        assert everything_of(made[(place + 2) % 4]) == expected[(place + 2) % 4]
        assert everything_of(frame) == expected[place]


def test_one_thread_for_all_loops_is_one_thread(monkeypatch):
    expected = [signal_of(frame) for frame in make_sequence()]
    monkeypatch.setattr(ahead, "_Ahead", None)  # which would have a thread
    threads = ep.num_threads()
    ep.set_num_threads(1)
    try:
        assert [signal_of(frame) for frame in make_sequence()] == expected
    finally:
        ep.set_num_threads(threads)


def test_the_next_work_runs_while_a_result_is_used():
    """The first result is used until the second work says that it has begun: alone in one thread that would never be."""
    begun = threading.Event()
    results = one_ahead([lambda _: "first", lambda _: begun.set() or "second"])
    assert next(results) == "first" and begun.wait(WAIT)
    assert list(results) == ["second"] and ahead_threads() == []


def test_no_more_than_one_work_is_ahead():
    taken = []
    works = (functools.partial(lambda number, _: number, taken.append(number) or number) for number in itertools.count())
    for number in itertools.islice(one_ahead(works), 5):
        assert taken == list(range(number + 2))


def test_a_failure_comes_in_its_turn_and_ends_the_loop(monkeypatch):
    real, seen = sequence.record_of, []

    def record_of(*values, start_time, **keywords):
        if start_time == 2 * INTERVAL:
            raise RuntimeError("no third frame")
        return real(*values, start_time=start_time, **keywords)

    monkeypatch.setattr(sequence, "record_of", record_of)
    with pytest.raises(RuntimeError, match="^no third frame$"):
        for frame in make_sequence():
            seen.append(signal_of(frame))
    assert len(seen) == 2 and ahead_threads() == []
    monkeypatch.undo()
    assert [signal_of(frame) for frame in make_sequence()][:2] == seen


def endless(begun, ended):
    """A work that goes on until it is stopped."""
    def work(progress):
        begun.set()
        try:
            while True:
                progress("trace", 0.5)
                time.sleep(0.001)
        finally:
            ended.set()
    return work


def test_who_leaves_early_stops_the_work_ahead():
    begun, ended = threading.Event(), threading.Event()
    for result in one_ahead([lambda _: "first", endless(begun, ended)]):
        assert result == "first" and begun.wait(WAIT)
        break
    gc.collect()
    assert ended.is_set() and ahead_threads() == []


def test_an_exception_of_the_caller_stops_the_work_ahead():
    begun, ended = threading.Event(), threading.Event()
    with pytest.raises(KeyError):
        for _ in one_ahead([lambda _: "first", endless(begun, ended)]):
            raise KeyError
    gc.collect()
    assert ended.is_set() and ahead_threads() == []


def test_an_exception_of_progress_stops_the_work_that_is_waited_for():
    begun, ended = threading.Event(), threading.Event()

    def progress(stage, fraction):
        assert threading.current_thread() is threading.main_thread()
        raise InterruptedError(stage)

    with pytest.raises(InterruptedError, match="^trace$"):
        next(one_ahead([endless(begun, ended)], progress))
    assert ended.is_set() and ahead_threads() == []


def test_leaving_a_loop_stops_the_record_of_the_next_frame(monkeypatch):
    """That record never ends by itself."""
    real, begun, ended = sequence.record_of, threading.Event(), threading.Event()

    def record_of(*values, start_time, progress, **keywords):
        if start_time == 0.0:
            return real(*values, start_time=start_time, progress=progress, **keywords)
        return endless(begun, ended)(progress)

    monkeypatch.setattr(sequence, "record_of", record_of)
    made = iter(make_sequence(frames=2))
    assert next(made).paths.num_paths > 0 and begun.wait(WAIT)
    made.close()
    assert ended.is_set() and ahead_threads() == []


def test_ctrl_c_while_the_thread_begins_stops_it(monkeypatch):
    begun, ended = threading.Event(), threading.Event()
    start = threading.Thread.start

    def interrupted(thread):
        start(thread)
        if thread.name == "echopath-ahead":
            assert begun.wait(WAIT)
            raise KeyboardInterrupt

    monkeypatch.setattr(threading.Thread, "start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        next(one_ahead([endless(begun, ended)]))
    assert ended.is_set() and ahead_threads() == []


def test_ctrl_c_between_the_making_of_the_thread_and_its_first_step_stops_it(monkeypatch):
    begun, ended = threading.Event(), threading.Event()
    wait = threading.Event.wait

    def interrupted(event, timeout=None):
        if timeout is None:  # as Thread.start waits for what it has made
            raise KeyboardInterrupt
        return wait(event, timeout)

    monkeypatch.setattr(threading.Event, "wait", interrupted)
    with pytest.raises(KeyboardInterrupt):
        next(one_ahead([endless(begun, ended)]))
    assert ended.is_set() == begun.is_set() and ahead_threads() == []


class CtrlCAtStep:
    """Raises KeyboardInterrupt at one instruction of the loop's own code, counted over all of them; at the latest where the loop
    waits for its second result. Once the loop ends its thread, nothing is raised any more."""

    def __init__(self, step: int):
        self.steps_left, self.results, self.is_over = step, 0, False

    def __call__(self, frame, event, _):
        code = frame.f_code
        if self.is_over or code.co_filename != ahead.__file__:
            return None
        frame.f_trace_opcodes = True
        self.results += event == "call" and code.co_name == "_result_of_work"
        self.is_over = event == "call" and code.co_name == "stop" or self.results == 2
        self.steps_left -= event == "opcode"
        if self.results == 2 or self.steps_left < 0:
            self.is_over = True
            raise KeyboardInterrupt
        return self


def test_ctrl_c_at_any_step_of_the_loop_leaves_no_thread():
    for step in itertools.count():
        ctrl_c = CtrlCAtStep(step)
        sys.settrace(ctrl_c)
        try:
            with pytest.raises(KeyboardInterrupt):
                for _ in one_ahead([lambda _: "first", endless(threading.Event(), threading.Event())]):
                    pass
        finally:
            sys.settrace(None)
        assert ahead_threads() == [], step
        if ctrl_c.results == 2:
            break
    assert step > 50


SCRIPT = """
import sys, threading, time
import echopath as ep
from echopath.sequence import ahead
from support.frames_in_time import make_sequence
try:
    print("begun", flush=True)
    for frame in make_sequence(frames=100_000):
        pass
except KeyboardInterrupt:
    left = [one.name for one in threading.enumerate() if one is not threading.main_thread()]
    print("left", left, flush=True)
"""


def test_ctrl_c_ends_the_loop_and_its_thread():
    process = subprocess.Popen([sys.executable, "-c", SCRIPT], cwd=Path(__file__).parents[2], stdout=subprocess.PIPE, text=True,
                               preexec_fn=heed_ctrl_c)
    assert process.stdout.readline() == "begun\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=WAIT)[0] == "left []\n" and process.returncode == 0


def test_python_may_end_with_a_loop_that_nobody_ended():
    script = ("from support.frames_in_time import make_sequence\n"
              "kept = iter(make_sequence(frames=9, num_rays=2_000_000))\nnext(kept)\n")
    done = subprocess.run([sys.executable, "-c", script], cwd=Path(__file__).parents[2], timeout=2 * WAIT, capture_output=True)
    assert done.returncode == 0 and done.stderr == b""


def test_warnings_name_the_line_of_the_loop(monkeypatch):
    wrong = Check("look", error=2.0, promise=1.0, unit="dB", count=3)
    monkeypatch.setattr(run, "warn_of", lambda checks, advised: warn_of([wrong]))
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        for _ in make_sequence(frames=2):
            pass
    assert {one.filename for one in seen} == {__file__} and len(seen) == 2


def resident() -> int:
    """Bytes of this process."""
    return next(int(line.split()[1]) for line in open("/proc/self/status", encoding="ascii") if line.startswith("VmRSS:")) << 10


def test_memory_is_flat_over_a_soak():
    sizes = [resident() for frame in make_sequence(frames=SOAK, num_rays=2000) if frame is not None]
    assert max(sizes[SETTLED:]) < GROWTH * sizes[SETTLED - 1]


def test_a_process_that_grows_beyond_its_first_frames_gives_unused_memory_back(monkeypatch):
    given_back, resident = [], [100]
    monkeypatch.setattr(unused_memory, "resident_memory", lambda: resident[0])
    monkeypatch.setattr(unused_memory, "give_back_memory", lambda: given_back.append(resident[0]))
    memory = unused_memory.MemoryOfFrames()
    for now in (60, 110, 100, 90, 116, 117, 200):  # the first three settle it
        resident[0] = now
        memory.end_frame()
    assert given_back == [117, 200], "more than 1.06 times what the first frames took"
    monkeypatch.setattr(unused_memory, "resident_memory", lambda: None)
    memory.end_frame()
    assert len(given_back) == 3, "each time where the system does not tell"


def test_each_frame_that_is_handed_over_has_been_looked_at_and_the_end_of_a_loop_gives_memory_back(monkeypatch):
    ended, given_back = [], []
    monkeypatch.setattr(unused_memory.MemoryOfFrames, "end_frame", lambda self: ended.append(True))
    monkeypatch.setattr(sequence, "give_back_memory", lambda: given_back.append(True))
    assert [len(ended) for frame in make_sequence(frames=3) if frame is not None] == [1, 2, 3] and len(given_back) == 1
    ended.clear()
    given_back.clear()
    assert make_sequence(frames=3)[1] is not None and (len(ended), len(given_back)) == (0, 1), "alone"


def test_memory_of_a_frame_that_nobody_takes_goes_back_when_a_loop_is_left(monkeypatch):
    working = []
    monkeypatch.setattr(sequence, "give_back_memory", lambda: working.append(len(ahead_threads())))
    for _ in make_sequence(frames=3):
        break
    assert len(working) == 1 and working[-1] == 0, "when the thread that made it has ended"
