"""Live scenes that are watched: views and previews come while changes go on."""
import copy
import threading
import time
from types import SimpleNamespace

import pytest

import echopath as ep
from echopath.live.changes import Changes
from echopath.live.kept_signal import KeptSignal
from echopath.live.watch import FEWEST_PREVIEW_RAYS, Watch
from support.live import difference, fresh_view, make_live

pytestmark = pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")  # of the coarse street
ROUNDING = 1e-12   # of the largest sample: signals are added and taken away
LONG = 60.0        # s, that a thread may take on a busy machine


class Shown(list):
    """Views in the order in which they were shown."""

    def __call__(self, view: ep.LiveView) -> None:
        self.append(view)


def test_a_watch_shows_the_latest_change_last(live):
    shown = Shown()
    with live.watch(shown) as watch:
        assert watch.wait(LONG) and repr(watch) == "Watch(running, change 0 shown in full)"
        for _ in range(20):
            live.change(lambda scene: setattr(scene["sign_30"], "position", scene["sign_30"].position + (0.02, 0.0, 0.0)))
        assert watch.wait(LONG)
    assert repr(watch) == "Watch(stopped, change 20 shown in full)"
    assert [view.number for view in shown] == sorted(view.number for view in shown)
    assert shown[-1].number == 20 and not shown[-1].is_preview
    assert difference(shown[-1], fresh_view(live)) < ROUNDING


def test_a_watch_that_its_view_leaves_is_told(live):
    def leave(view):
        raise SystemExit("closed")

    watch = live.watch(leave)
    with pytest.raises(SystemExit, match="closed"):
        watch.wait(LONG)
    with pytest.raises(SystemExit, match="closed"):
        watch.stop()
    assert repr(watch) == "Watch(ended by SystemExit('closed'), nothing shown in full)"


def test_what_shows_a_view_cannot_wait_for_it(live):
    """It would wait for itself."""
    made = threading.Event()

    def show(view):
        made.wait(LONG)
        watch.wait(LONG)

    watch = live.watch(show)
    made.set()
    with pytest.raises(RuntimeError, match="^wait: must not be called by what shows"):
        watch.wait(LONG)
    with pytest.raises(RuntimeError, match="^wait: must not be called by what shows"):
        watch.stop()


def test_a_watch_shows_what_is_edited_directly(live):
    shown = Shown()
    with live.watch(shown) as watch:
        assert watch.wait(LONG)
        live.scene["sign_30"].position += (0.1, 0.0, 0.0)
        assert live.number == 1 and watch.wait(LONG)
        live.scene.remove("pole_20")
        live.scene.add(ep.actors.pole(), name="pole", material="concrete", position=(12.0, 2.0, 0.0))
        assert live.number == 3 and watch.wait(LONG)
        live.scene.weather = ep.Weather(fog_g_per_m3=1.0)
        assert watch.wait(LONG)
    assert shown[-1].number == live.number == 4
    assert difference(shown[-1], fresh_view(live)) < ROUNDING


def test_edits_within_a_change_are_one_and_those_before_an_error_count():
    live = make_live()

    def breaks(scene):
        scene["sign_30"].visible = False
        raise KeyError("broken")

    with live.changing() as scene:
        for step in (0.1, 0.2):
            scene["sign_30"].position += (step, 0.0, 0.0)
    assert live.number == 1
    with pytest.raises(KeyError, match="broken"):
        live.change(breaks)
    assert live.number == 2 and not live.scene["sign_30"].visible
    with pytest.raises(KeyError, match="nobody"):
        live.change(lambda scene: scene.remove("nobody"))
    assert live.number == 2


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda scene: scene.copy(), ep.Scene])
def test_copies_of_its_scene_are_plain_and_count_nothing(copied):
    live = make_live()
    other = copied(live.scene)
    other["sign_30"].visible = False
    assert type(other) is ep.Scene and live.number == 0 and live.scene["sign_30"].visible


def test_previews_of_threads_beside_each_other_have_the_rays_that_each_asked_for(monkeypatch):
    """While the record of one is made, the other asks for one of its own."""
    live, views, both = make_live(), {}, threading.Barrier(2)

    class Slow(KeptSignal):
        def __init__(self, *arguments):
            super().__init__(*arguments)
            try:
                both.wait(0.3)
            except threading.BrokenBarrierError:
                pass

    monkeypatch.setattr("echopath.live.live.KeptSignal", Slow)
    threads = [threading.Thread(target=lambda rays=rays: views.update({rays: live.preview(num_rays=rays)}))
               for rays in (300, 900)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    monkeypatch.undo()
    for rays, view in views.items():
        assert difference(view, fresh_view(live, num_rays=rays)) == 0.0


def test_a_watch_shows_a_preview_first_where_a_view_takes_longer_than_its_budget():
    live, shown = make_live(num_rays=20_000), Shown()
    with live.watch(shown, budget=1e-4) as watch:
        watch.wait(LONG)
        live.change(lambda scene: scene.remove("sign_30"))
        watch.wait(LONG)
    assert [view.is_preview for view in shown] == [False, True, False]
    assert shown[1].num_rays < 0.5 * shown[2].num_rays and abs(shown[2].num_rays - 20_000) < 4_000


def test_a_watch_shows_previews_while_changes_come_quicker_than_views(live, monkeypatch):
    """Also where the view before them took less than its budget: that of another object may take far longer."""
    update, shown = live.update, Shown()

    def slow(progress):
        for _ in range(300):
            progress("rays", 0.5)
            time.sleep(0.01)
        return update(progress=progress)

    with live.watch(shown, budget=LONG) as watch:
        assert watch.wait(LONG)
        with monkeypatch.context() as patch:
            patch.setattr(live, "update", slow)
            end = time.monotonic() + LONG
            while not (len(shown) > 3 or time.monotonic() > end):
                live.change(lambda scene: setattr(scene["sign_30"], "position", scene["sign_30"].position + (1e-3, 0.0, 0.0)))
                time.sleep(0.02)
        assert all(view.is_preview for view in shown[1:]) and len(shown) > 3
        assert watch.wait(LONG)
    assert not shown[-1].is_preview


def test_threads_that_change_beside_each_other_lose_no_change(live):
    def push():
        for _ in range(25):
            live.change(lambda scene: setattr(scene["sign_30"], "position", scene["sign_30"].position + (0.001, 0.0, 0.0)))

    start = live.scene["sign_30"].position[0]
    with live.watch(Shown()) as watch:
        threads = [threading.Thread(target=push) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert watch.wait(LONG)
    assert live.number == 100
    assert live.scene["sign_30"].position[0] == pytest.approx(start + 0.1, abs=1e-12)
    assert difference(live.update(), fresh_view(live)) < ROUNDING


def test_what_a_watch_cannot_show_is_raised_by_wait_and_stop(live):
    told = []
    watch = live.watch(Shown(), failed=told.append)
    watch.wait(LONG)
    live.change(lambda scene: setattr(scene["sign_30"], "position", (1e30, 0.0, 0.0)))
    with pytest.raises(ValueError, match="sign_30"):
        watch.wait(LONG)
    with pytest.raises(ValueError, match="sign_30") as raised:
        watch.stop()
    assert told == [raised.value]


def test_a_stopped_watch_ends_soon():
    live = make_live(num_rays=1_000_000)
    watch = live.watch(Shown())
    time.sleep(0.3)
    watch.stop()
    assert not watch.wait(0.1)


class Paced:
    """Stands for a Live of 100 000 rays, all of which are shot for each view and take as long as they are told to."""

    num_rays = 100_000

    def __init__(self, seconds_of_ray: float):
        self.changes, self._pace = Changes(), seconds_of_ray

    def preview(self, *, num_rays: int, progress):
        return self._view(num_rays, is_preview=True)

    def update(self, *, progress):
        return self._view(self.num_rays, is_preview=False)

    def _view(self, num_rays: int, is_preview: bool):
        return SimpleNamespace(number=self.changes.number, num_rays=num_rays, num_rays_shot=num_rays, is_preview=is_preview,
                               seconds=num_rays * self._pace)


def previews_of(live: Paced, budget: float, count: int) -> list:
    shown = Shown()
    with Watch(live, live.changes, shown, budget, None) as watch:
        for _ in range(count):
            assert watch.wait(LONG)
            with live.changes.one():
                pass
        assert watch.wait(LONG)
    return [view for view in shown if view.is_preview]


def test_the_first_preview_keeps_within_the_budget_by_the_time_of_the_full_view():
    for view in previews_of(Paced(25e-6), 0.05, 3):
        assert 0.02 < view.seconds <= 0.05


def test_previews_of_which_even_the_fewest_take_longer_have_the_fewest_rays():
    assert {view.num_rays for view in previews_of(Paced(1e-3), 0.05, 2)} == {FEWEST_PREVIEW_RAYS}
