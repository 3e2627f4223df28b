"""Ctrl-C stops whatever takes long, not only the trace: records of millions of paths, and the start of the program."""
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import echopath as ep
from support.background import heed_ctrl_c
from support.radars import build_radar
from support.shapes import lambert

PROMISE = 0.5        # s, on a machine with nothing else to do
PATIENCE = 1.5       # s, with the tests of a busy machine; tries until one keeps to it
NUM_TRIES = 4
NUM_PATHS = 1_500_000
HEAD_START = 0.05    # s, of the work before Ctrl-C
HITS_PER_PATH = 3


@pytest.fixture(scope="module")
def paths():
    """Millions of copies of the paths over a plate and a wall that both move: lengths and amplitudes take a while."""
    scene = ep.Scene()
    motion = ep.LinearMotion(velocity=(-1.0, 0.0, 0.0))
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", position=(6.0, 0.0, 0.0), motion=motion, material=lambert(0.27))
    scene.add(ep.actors.plate(9.0, 9.0), name="wall", position=(9.0, 0.0, 0.0), motion=motion, material="concrete")
    radar = build_radar(receivers=[(0, 0.01, 0)], num_chirps=8, chirp_interval=1e-4)
    traced = ep.trace(scene, radar, num_rays=3000, max_bounces=HITS_PER_PATH, polarization="scalar")
    index = np.arange(NUM_PATHS) % traced.num_paths
    names = ("num_bounces", "diffuse", "weight", "stratum", "batch", "flags")
    columns = {name: getattr(traced, name)[index] for name in names}
    hits = np.tile(traced.hits, NUM_PATHS // traced.num_paths + 1)
    offsets = traced.offsets[index] + np.arange(NUM_PATHS) // traced.num_paths * len(traced.hits)
    return ep.Paths.from_arrays(hits=hits, offsets=offsets, **columns, scene=traced.scene, radar=traced.radar,
                                frame=traced.frame)


def rcs_of_two_directions():
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=lambert(0.27))
    return ep.rcs(scene, frequency=77e9, incidence=[(1, 0, 0), (1, 1, 0)], num_rays=1 << 24)


PARTS = {f"part {count}": f"T 'plate' .{{{count}}} 'wall'? .* R" for count in range(12)}
TIMES = np.linspace(0.0, 5e-4, 12)
WORK = {
    "partition": lambda paths, folder: paths.partition(PARTS),
    "partition_groups": lambda paths, folder: ep._core.partition_groups(paths, list(PARTS.items())),
    "select": lambda paths, folder: [paths.select(text) for text in PARTS.values()],
    "amplitude": lambda paths, folder: paths.amplitude,
    "power": lambda paths, folder: paths.power,
    "amplitudes": lambda paths, folder: paths.amplitudes(TIMES),
    "lengths": lambda paths, folder: paths.lengths(TIMES),
    "points": lambda paths, folder: [paths.points(time) for time in TIMES],
    "received power": lambda paths, folder: ep.received_power(paths),
    "families": lambda paths, folder: ep.families(paths, ["plate"]),
    "visibility": lambda paths, folder: ep.visibility(paths.scene, paths.radar, num_directions=1 << 22),
    "rcs of two directions": lambda paths, folder: rcs_of_two_directions(),
    "save": lambda paths, folder: paths.save(folder / "paths.h5", min_power=1e-30),
    "load": lambda paths, folder: ep.Paths.load(saved_once(paths, folder)),
}
_saved = {}


def saved_once(paths, folder):
    if "path" not in _saved:
        paths.save(folder / "whole.h5")
        _saved["path"] = folder / "whole.h5"
    return _saved["path"]


def seconds_to_stop(work) -> float:
    """Time from Ctrl-C to the KeyboardInterrupt of `work`; 0 when it ended before it was interrupted."""
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(HEAD_START, interrupt)
    try:
        timer.start()
        work()
        timer.join()
        time.sleep(0.01)
    except KeyboardInterrupt:
        return time.perf_counter() - sent[0]
    finally:
        timer.cancel()  # an error of the work is told as it is, not as a Ctrl-C that comes later
    return 0.0


@pytest.mark.hard
@pytest.mark.parametrize("name", WORK)
def test_ctrl_c_stops_work_on_a_large_record(ctrl_c_is_heard, paths, tmp_path_factory, name):
    folder = tmp_path_factory.getbasetemp()
    if name == "load":
        saved_once(paths, folder)
    delays = []
    while not delays or (delays[-1] > PROMISE and len(delays) < NUM_TRIES):
        delays.append(seconds_to_stop(lambda: WORK[name](paths, folder)))
    assert min(delays) < PATIENCE, delays
    assert not list(folder.glob(".paths*")) and not (folder / "paths.h5").exists()


STOPPED = ["echopath: stopped; no file was left half written"]


class Raises:
    """Asked for what it is, as an argument, it raises: as lists of NumPy's numbers do where Ctrl-C comes while they are read."""

    def __init__(self, error):
        self.error = error

    def _raise(self, *_, **__):
        raise self.error

    __float__ = __index__ = __iter__ = __len__ = __getitem__ = __array__ = _raise


class RaisesAsArray(Raises):
    """Likewise; it begins as arrays of other libraries do, by its `dtype`."""

    @property
    def dtype(self):
        raise self.error


class RaisesOfArray(Raises):
    """Likewise; it is taken for an array, which it then fails to become."""

    dtype = np.dtype(float)


READERS = {
    "array": lambda value: ep.LinearMotion(velocity=value),
    "array of numbers": lambda value: ep.LinearMotion(velocity=[value, 0.0, 0.0]),
    "number": lambda value: ep.ChirpSequence(bandwidth=value),
    "whole number": lambda value: ep.ChirpSequence(num_chirps=value),
    "seed": lambda value: ep.SignalProbe(seed=value),
    "list": lambda value: ep.Radar(ep.ChirpSequence(), transmitters=value, receivers=[]),
    "mask": lambda value: ep.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).part(value),
}


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
@pytest.mark.parametrize("kind", [Raises, RaisesAsArray, RaisesOfArray])
@pytest.mark.parametrize("reader", READERS)
def test_ctrl_c_while_an_argument_is_read_is_no_fault_of_the_argument(reader, kind, error):
    with pytest.raises(error):
        READERS[reader](kind(error))


@pytest.mark.hard
@pytest.mark.parametrize("delay", [0.08, 0.15, 0.25, 0.4])
def test_ctrl_c_while_the_program_loads_is_one_line(delay, tmp_path):
    arguments = [sys.executable, "-X", "importtime", "-m", "echopath", "demo", "--out", str(tmp_path / "out")]
    # Unbuffered, since what a buffer had taken of a line that is not read yet would be missing from what comes last.
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0, preexec_fn=heed_ctrl_c)
    for line in process.stderr:  # Python tells each module that it has loaded: the package itself has begun
        if line.rstrip().endswith(b"echopath._startup"):
            break
    process.stderr.readline()  # the next module: the package has asked for its own answer to Ctrl-C by now
    time.sleep(delay)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    said = [line for line in errors.decode().splitlines() if line and not line.startswith("import time:")]
    assert (process.returncode, said) == (130, STOPPED)


@pytest.mark.parametrize("module, lines", {
    # Python ends by the signal where it came within a text; every dataclass that a module has is made of such texts.
    "in_a_text": "exec('raise KeyboardInterrupt')",
    # pydantic-core tells it as an error of the model that it builds, a library in C as one of its own.
    "as_another_error": "try: signal.raise_signal(signal.SIGINT)\n    except KeyboardInterrupt: raise ValueError('no model')",
    "as_another_error_around_a_block": """try:
        with interrupts_are_kept(): signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt: raise ValueError('no file')""",
    "in_a_callback": "weakref.finalize(Thing(), signal.raise_signal, signal.SIGINT)",
}.items())
def test_ctrl_c_ends_a_command_wherever_it_comes(module, lines, tmp_path):
    (tmp_path / f"{module}.py").write_text(f"""
import signal, sys, weakref
from echopath.base.process.interrupts import interrupts_are_kept
from echopath.cli import commands, main
class Thing: pass
def work(options):
    {lines}
commands.info = work
sys.exit(main(["info", "scene.toml"]))
""")
    done = subprocess.run([sys.executable, "-m", module], cwd=tmp_path, preexec_fn=heed_ctrl_c, capture_output=True, text=True)
    assert (done.returncode, done.stderr.split("\n")[1:-1]) == (130, STOPPED)


@pytest.mark.parametrize("module", ["h5py", "h5py.h5f", "h5py._hl.files"])
def test_ctrl_c_while_h5py_loads_leaves_it_whole(module, tmp_path):
    """Modules made by Cython cannot be loaded twice: a notebook could read no file any more after a Ctrl-C at the first."""
    (tmp_path / "first_file.py").write_text(f"""
import signal, sys
import echopath as ep
class Interrupting:
    def find_spec(name, path, target=None):
        if name == "{module}" and Interrupting in sys.meta_path:
            sys.meta_path.remove(Interrupting)
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Interrupting)
scene = ep.Scene()
scene.add(ep.actors.plate(1.0, 1.0), name="plate", position=(6.0, 0.0, 0.0), material="metal")
radar = ep.Radar(ep.ChirpSequence(), transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
paths = ep.trace(scene, radar, num_rays=100, max_bounces=1)
try:
    paths.save("paths.h5")
except KeyboardInterrupt:
    paths.save("paths.h5")
    print(ep.Paths.load("paths.h5").num_paths == paths.num_paths)
""")
    done = subprocess.run([sys.executable, "first_file.py"], cwd=tmp_path, preexec_fn=heed_ctrl_c, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("True\n", "")
