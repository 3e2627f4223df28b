"""Live scenes that several threads change and look at: edits are whole, and nobody waits for ever."""
import itertools
import sys
import threading

import numpy as np
import pytest

import echopath as ep
from echopath.bench.live.edits import STEP

HANGS = 60.0  # s, by far more than what is waited for takes
PLATE = ep.Mesh([[0, -0.1, -0.1], [0, 0.1, -0.1], [0, 0, 0.1]], [[0, 1, 2]])


def small_live() -> ep.Live:
    scene = ep.Scene()
    scene.add(PLATE, name="plate", material="metal", position=(5.0, 0.0, 1.0))
    waveform = ep.ChirpSequence(start_frequency=77e9, num_chirps=2, num_samples=64)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
    return ep.Live(scene, radar, num_rays=500)


def run_together(*work) -> None:
    """Runs functions in threads of their own and raises what one of them raised; fails where one does not end."""
    errors = []

    def run(one):
        try:
            one()
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=run, args=(one,), daemon=True) for one in work]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(HANGS)
    assert not any(thread.is_alive() for thread in threads), "a thread waits for ever"
    if errors:
        raise errors[0]


def test_objects_that_threads_add_are_whole():
    """Each part hangs on its own thread's object, though objects of others come between."""
    scene, each = small_live().scene, 60

    def add(thread):
        for number in range(each):
            scene.add([("a/b", PLATE), ("a/c", PLATE)], name=f"{thread}_{number}", material="metal")

    run_together(*(lambda thread=thread: add(thread) for thread in "xyz"))
    for thread in "xyz":
        for number in range(each):
            assert [child.name for child in scene[f"{thread}_{number}/a"].children] == [
                f"{thread}_{number}/a/{part}" for part in "bc"]


def test_settings_of_one_object_by_two_threads_are_all_kept():
    plate, each = small_live().scene["plate"], 1000

    def move():
        for number in range(each):
            plate.position = (5.0, 0.0, number)
            assert plate.position[2] == number

    def hide():
        for number in range(each):
            plate.visible = bool(number % 2)
            assert plate.visible == bool(number % 2)

    run_together(move, hide)


@pytest.mark.parametrize("step", range(12))
@pytest.mark.parametrize("read, its_own", [
    pytest.param(lambda node: node.position[0], 7.0, id="position"),
    pytest.param(lambda node: [child.name for child in node.children], ["pair/part"], id="children"),
])
def test_what_is_read_of_an_object_is_its_own_whatever_another_thread_removes(read, its_own, step):
    """What stands before the object goes between two steps of the interpreter that reads."""
    scene, steps = small_live().scene, itertools.count()
    scene.add([("part", PLATE)], name="pair", material="metal", position=(7.0, 0.0, 1.0))
    scene.add([("other", PLATE)], name="last", material="metal", position=(9.0, 0.0, 1.0))
    pair, before = scene["pair"], sys.getprofile()

    def meddle(frame, event, argument):
        if next(steps) == step:
            run_together(lambda: scene.remove("plate"))

    sys.setprofile(meddle)
    try:
        found = read(pair)
    finally:
        sys.setprofile(before)
    assert found == its_own


def test_an_edit_of_many_meshes_is_one_change():
    live = small_live()
    live.scene.add([("a", PLATE), ("b", PLATE)], name="pair", material="metal")
    before = live.number
    live.scene["pair"].material = "concrete"
    assert live.number == before + 1


@pytest.mark.parametrize("look", [ep.Live.update, lambda live: live.preview(num_rays=100)], ids=["update", "preview"])
def test_a_view_from_within_a_change_does_not_wait_for_one_from_outside(look):
    live, changes = small_live(), threading.Event()

    def change():
        for _ in range(10):
            with live.changing() as scene:
                scene["plate"].position += STEP
                changes.set()
                look(live)

    def watch():
        changes.wait(HANGS)
        for _ in range(20):
            look(live)

    run_together(change, watch)
    assert live.scene["plate"].position[0] == pytest.approx(5.0 + 10 * STEP[0])
    fresh = ep.Live(live.scene, live.radar, num_rays=500).update()
    assert fresh.cube.any() and np.abs(live.update().cube - fresh.cube).max() <= 1e-12 * np.abs(fresh.cube).max()


@pytest.mark.parametrize("ask", [ep.Live.update, ep.Live.paths, lambda live: live.preview(num_rays=200)],
                         ids=["update", "paths", "preview"])
def test_a_progress_callable_that_asks_for_another_view_is_refused(ask):
    """It would wait for the view that it is called by."""
    live = small_live()
    for make in (live.update, lambda progress: live.preview(num_rays=100, progress=progress)):

        def refused(make=make):
            with pytest.raises(RuntimeError, match="Live: must not be asked for views or paths"):
                make(progress=lambda stage, fraction: ask(live))

        run_together(refused)
        assert np.array_equal(live.update().cube, small_live().update().cube)
