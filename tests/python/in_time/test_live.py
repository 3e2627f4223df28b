"""Live scenes: the view after any change is that of a fresh one, and only what a change touches is done again."""
import copy
import pickle

import numpy as np
import pytest

import echopath as ep
from echopath.bench.live.random_edits import KINDS, RandomEdits
from echopath.live import kept_signal
from echopath.live.kept_signal import KeptSignal
from echopath.transmit.signals import synthesize_slots
from support.live import RAYS, coarse_street, difference, fresh_view, make_live

pytestmark = pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")  # of the coarse street
ROUNDING = 1e-12   # of the largest sample: signals are added and taken away


def test_a_moved_object_shoots_few_rays_and_gives_the_view_of_a_fresh_scene(live):
    for _ in range(3):
        live.scene["sign_30"].position += (0.1, 0.0, 0.0)
        view = live.update()
        assert 0 < view.num_rays_shot < 0.3 * view.num_rays
        assert difference(view, fresh_view(live)) < ROUNDING
    assert not np.array_equal(view.cube, make_live().update().cube)


def test_the_record_is_that_of_a_fresh_scene(live):
    live.scene["sign_30"].position += (0.1, 0.0, 0.0)
    live.update()
    other = make_live()
    other.scene["sign_30"].position += (0.1, 0.0, 0.0)
    other.update()
    mine, fresh = live.paths(), other.paths()
    for column in ("mesh_id", "triangle_id", "u", "v", "offsets", "num_bounces", "diffuse", "weight", "stratum", "flags"):
        assert np.array_equal(getattr(mine, column), getattr(fresh, column)), column


def small_street(num_rays: int = 300) -> ep.Live:
    """A ground, a wall and three bodies, one of them smooth."""
    scene = ep.Scene()
    scene.add(ep.actors.ground((40.0, 16.0)), name="ground", material=ep.materials["asphalt"].replace(mirror=True),
              position=(15.0, 0.0, 0.0))
    scene.add(ep.actors.wall(30.0, 4.0), name="wall", material="concrete", position=(15.0, 6.0, 0.0), yaw=-np.pi / 2)
    scene.add(ep.actors.box((1.5, 1.0, 1.2)), name="box", material="concrete", position=(9.0, 1.0, 0.6))
    scene.add(ep.actors.trihedral(0.5), name="corner", material=ep.Material.metal(), position=(14.0, -2.0, 0.8), yaw=np.pi)
    scene.add(ep.actors.sphere(0.5, edge=0.06), name="ball", material=ep.Material.metal(), position=(11.0, 3.0, 0.8),
              smooth=True)
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=5e8, num_samples=64, sampling_rate=10e6, num_chirps=8,
                                chirp_interval=3e-5)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.0, 0.7))], receivers=[ep.Antenna((0.0, 0.01, 0.7))])
    return ep.Live(scene, radar, num_rays=num_rays)


@pytest.mark.parametrize("seed", [1, 2])
def test_edits_of_every_kind_end_in_the_view_of_a_fresh_scene(seed):
    edits = RandomEdits(small_street(), ["box", "corner", "ball"], ["ground", "wall"], seed)
    made = set()
    for _ in range(2 * len(KINDS)):
        made.add(edits.make())
        view, fresh = edits.live.update(), edits.fresh_view()
        assert difference(view, fresh) < ROUNDING, made
        assert np.allclose(view.map.values, fresh.map.values, rtol=0.0, atol=ROUNDING * np.abs(fresh.map.values).max())
    assert made == set(KINDS)


@pytest.mark.parametrize("change", [
    lambda live: setattr(live.scene["ground"], "position", (0.0, 0.0, -0.1)),
    lambda live: setattr(live, "radar", live.radar.replace(position=(0.5, 0.0, 0.1)))])
def test_what_concerns_all_rays_shoots_all(live, change):
    change(live)
    view = live.update()
    assert view.num_rays_shot == view.num_rays
    assert difference(view, fresh_view(live)) == 0.0


def test_an_object_that_comes_goes_or_begins_to_move_leaves_most_others_their_rays(live):
    live.update()
    for change in (lambda scene: setattr(scene["sign_30"], "visible", False),
                   lambda scene: setattr(scene["sign_30"], "visible", True),
                   lambda scene: setattr(scene["pole_20"], "motion", ep.LinearMotion(velocity=(0.0, 1.0, 0.0))),
                   lambda scene: setattr(scene["pole_20"], "motion", None),
                   lambda scene: scene.remove("sign_30"),
                   lambda scene: scene.add(ep.actors.pole(), name="guest", material="concrete", position=(18.0, 4.0, 0.0))):
        live.change(change)
        view = live.update()
        assert 0 < view.num_rays_shot < 0.5 * view.num_rays
        assert difference(view, fresh_view(live)) < ROUNDING


def test_the_farthest_object_that_moves_leaves_most_others_their_rays():
    live = small_street()
    live.scene.add(ep.actors.box(1.0), name="far", material="concrete", position=(50.0, 0.0, 0.5))
    live.update()
    live.scene["far"].position += (1.0, 0.0, 0.0)
    view = live.update()
    assert 0 < view.num_rays_shot < 0.4 * view.num_rays
    assert difference(view, fresh_view(live)) < ROUNDING


def behind_a_screen(screen_at: float) -> ep.Live:
    """A rough row of houses, seen straight and over a flagged wall, a part of which a screen at that x (m) hides."""
    scene, rough = ep.Scene(), ep.Material(permittivity=4.0, scattering=0.7)
    mirror = ep.materials["concrete"].replace(mirror=True, scattering=0.0)
    scene.add(ep.actors.wall(8.0, 8.0), name="wall", material=mirror, position=(6.0, -6.0, 0.0), yaw=np.pi)
    scene.add(ep.actors.box((30.0, 1.0, 5.0)), name="row", material=rough, position=(18.0, 9.0, 2.5))
    scene.add(ep.actors.box((4.0, 0.3, 9.0)), name="screen", material="metal", position=(screen_at, -3.0, 4.01))
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=3e8, num_samples=128, sampling_rate=1e7, num_chirps=4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
    return ep.Live(scene, radar, num_rays=3000, max_bounces=2)


def test_what_a_moved_screen_no_longer_hides_is_lit_over_a_wall_again():
    """Rays straight at the row stay, but for the ways over the part of the wall that the screen had hidden."""
    live = behind_a_screen(4.0)
    live.update()
    live.scene["screen"].position += (0.5, 0.0, 0.0)
    view, fresh = live.update(), behind_a_screen(4.5).update()
    assert view.num_rays_shot < view.num_rays
    assert difference(view, fresh) < ROUNDING


def test_rays_are_about_as_many_as_asked_for_and_find_the_power_of_the_radar_equation():
    """Of a metal ball, by geometrical optics: pi r^2, where waves spread from half a radius behind its front."""
    scene, radar = ep.Scene(), small_street().radar.replace(transmit_power=1.0)
    scene.add(ep.actors.sphere(0.5, edge=0.02), name="ball", material=ep.Material.metal(), position=(10.0, 0.0, 0.7), smooth=True)
    live = ep.Live(scene, radar, num_rays=20_000)
    view = live.update()
    assert 0.8 < view.num_rays / 20_000 < 1.2
    wavelength, front, centre = 299792458.0 / 77e9, 9.5, 10.0
    expected = wavelength ** 2 * np.pi * 0.25 / ((4.0 * np.pi) ** 3 * (front * centre) ** 2)
    assert 10.0 * abs(np.log10(np.mean(np.abs(view.cube) ** 2) / expected)) < 0.15  # dB


def test_what_rays_do_not_see_shoots_none(live):
    before = live.update()
    live.radar = live.radar.replace(transmit_power=2.0 * live.radar.transmit_power)
    louder = live.update()
    assert louder.num_rays_shot == 0
    assert np.allclose(louder.cube, np.sqrt(2.0) * before.cube, rtol=0.0, atol=ROUNDING * np.abs(louder.cube).max())
    live.set_map(window="hamming", zero_pad=2)
    padded = live.update()
    assert padded.num_rays_shot == 0 and padded.num_paths_changed == 0 and padded.cube is louder.cube
    assert padded.map.values.shape[-1] == 2 * louder.map.values.shape[-1]


def test_another_array_of_the_same_middle_shoots_none_and_is_right(live):
    receiver = live.radar.receivers[0]
    pair = [receiver.replace(position=np.add(receiver.position, (0.0, y, 0.0))) for y in (-0.001, 0.001)]
    live.radar = live.radar.replace(receivers=pair)
    view = live.update()
    assert view.cube.shape[1] == 2
    assert difference(view, fresh_view(live)) < ROUNDING


@pytest.mark.parametrize("keywords", [{"scatterers": "surface"}, {"polarization": "jones"}, {"method": "recurrence"},
                                      {"edges": True}])
def test_settings_are_kept_through_changes(keywords):
    live = make_live(**keywords)
    live.update()
    live.scene["car_smooth_15"].position += (0.1, 0.05, 0.0)
    assert difference(live.update(), fresh_view(live, **keywords)) < ROUNDING


def test_edges_of_faces_that_come_apart_are_those_of_a_fresh_scene():
    """Two faces of two meshes have one edge where they touch; behind it are the neighbours that did not change."""
    scene, radar = coarse_street()
    metal = ep.Material.metal()
    for name, yaw, place in (("front", 0.0, (9.0, 1.0, 1.0)), ("side", np.pi / 2, (9.2, 1.2, 1.0))):
        scene.add(ep.actors.plate(0.4, 0.4), name=name, material=metal, position=place, yaw=yaw)
    live = ep.Live(scene, radar, num_rays=RAYS, edges=True)
    live.update()
    for step in ((0.05, 0.02, 0.0), (-0.05, -0.02, 0.0)):  # apart, and together again
        live.scene["side"].position += step
        assert difference(live.update(), fresh_view(live, edges=True)) < ROUNDING


def test_rays_that_meet_no_sheet_stay_as_they_are_where_the_first_one_comes_and_the_last_one_goes():
    """Rays that rough things scatter took other random numbers in scenes with sheets: 7e-4."""
    scene = ep.Scene()
    rough = ep.Material(permittivity=5.0, scattering=0.5)
    scene.add(ep.actors.ground((20.0, 12.0)), name="ground", material="asphalt", position=(8.0, 0.0, -0.01))
    scene.add(ep.actors.wall(6.0, 3.0), name="wall", material=rough, position=(7.0, 1.6, 0.0))
    for k in range(4):
        scene.add(ep.actors.box((0.6, 0.6, 1.2)), name=f"box_{k}", material=rough, position=(4.0 + 0.9 * k, 0.5 * (-1) ** k, 0.6),
                  yaw=0.3 * k)
    live = ep.Live(scene, small_street().radar, num_rays=RAYS)
    live.update()
    for change in (lambda scene: scene.add(ep.actors.plate(0.5, 0.5), name="pane", material="glass_pane", yaw=0.3,
                                           position=(3.0, -3.0, 1.0)),
                   lambda scene: scene.remove("pane")):
        live.change(change)
        view = live.update()
        assert view.num_rays_shot < view.num_rays
        assert difference(view, fresh_view(live)) < ROUNDING


def test_weather_that_comes_weakens_echoes_by_the_length_of_their_way():
    """A plate at 40 m: 80 m of fog, as dense as may be."""
    _, radar = coarse_street()
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material=ep.Material.metal(), position=(40.0, 0.0, 0.5), yaw=np.pi)
    live = ep.Live(scene, radar, num_rays=500)
    clear = np.abs(live.update().map.values).max()
    live.scene.weather = ep.Weather(fog_g_per_m3=10.0)
    loss = sum(live.scene.weather.attenuation_db_per_km(radar).values()) * 0.08
    assert 20.0 * np.log10(clear / np.abs(live.update().map.values).max()) == pytest.approx(loss, rel=0.03)


def test_cubes_of_parts_follow_changes_and_add_up():
    parts = {"ball": "T 'ball' R", "ground": "T .* 'ground' .* R"}
    small = small_street()
    live = ep.Live(small.scene, small.radar, num_rays=300, parts=parts)
    live.update()
    for change in (lambda scene: setattr(scene["ball"], "position", (11.0, 3.1, 0.8)),
                   lambda scene: setattr(scene["box"], "position", (9.5, 1.5, 0.6)),
                   lambda scene: setattr(scene["ball"], "visible", False),
                   lambda scene: setattr(scene["ball"], "visible", True)):
        live.change(change)
        view = live.update()
        assert list(view.parts) == ["ball", "ground", "other"] and view.num_rays_shot < view.num_rays
        largest = np.abs(view.cube).max()
        assert np.abs(sum(view.parts.values()) - view.cube).max() < ROUNDING * largest
        fresh = ep.decompose(live.paths(), live.radar, parts, method="nufft")
        for name, cube in fresh.items():
            assert np.abs(view.parts[name] - cube).max() < ROUNDING * largest, name
        assert (np.abs(view.parts["ball"]).max() > 0.0) == live.scene["ball"].visible
    live.scene.remove("ball")
    with pytest.raises(ValueError, match="parts.ball: .*ball"):
        live.update()
    live.scene.add(ep.actors.plate(0.5, 0.5), name="ball", material="concrete", position=(12.0, -2.0, 0.8), yaw=np.pi)
    assert difference(live.update(), ep.Live(live.scene, live.radar, num_rays=300).update()) < ROUNDING


def test_a_scene_in_motion_is_followed(live):
    live.scene["car_smooth_15"].motion = ep.LinearMotion(velocity=(12.0, 0.0, 0.0))
    view = live.update()
    assert difference(view, fresh_view(live)) < ROUNDING
    at_rest = make_live().update()
    assert difference(view, at_rest) > 1e-3


@pytest.mark.parametrize("parts", [None, {"near": ep.hits("near"), "far": ep.hits("far_*")}])
def test_what_is_left_when_the_strongest_echo_goes_is_that_of_a_fresh_scene(parts):
    """A ball 1 m away is 70 dB above small ones at 30 m: the rounding of its samples is not left among theirs."""
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=2e8, num_samples=64, sampling_rate=10e6, num_chirps=8,
                              chirp_interval=30e-6)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0.0, 0.002, 0.0))])
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="near", material="metal", smooth=True, position=(1.0, 0.0, 0.0))
    for index, angle in enumerate(np.arange(40) * 0.15 + 0.5):
        scene.add(ep.actors.sphere(0.005), name=f"far_{index}", material="metal", smooth=True,
                  position=(30.0 * np.cos(angle), 30.0 * np.sin(angle), 0.0))
    live = ep.Live(scene, radar, num_rays=4000, parts=parts)
    before = np.abs(live.update().cube).max()
    live.scene["near"].visible = False
    view = live.update()
    expected = ep.Live(live.scene, radar, num_rays=4000, parts=parts).update()
    assert before > 3e3 * np.abs(expected.cube).max() and view.num_rays_shot < view.num_rays
    assert difference(view, expected) < ROUNDING
    if parts:
        assert not view.parts["near"].any()


def test_the_scene_that_was_given_stays_as_it_was():
    scene, radar = coarse_street()
    live = ep.Live(scene, radar, num_rays=RAYS)
    live.scene["sign_30"].position = (1.0, 2.0, 3.0)
    assert not np.allclose(scene["sign_30"].position, (1.0, 2.0, 3.0))


def test_views_cannot_be_written_to_and_stay_what_they_were(live):
    view = live.update()
    kept = view.cube.copy()
    with pytest.raises(ValueError):
        view.cube[0] = 0.0
    live.scene["sign_30"].position += (0.3, 0.0, 0.0)
    live.update()
    assert np.array_equal(view.cube, kept)


class Stop(Exception):
    pass


@pytest.mark.parametrize("stage", ["trace", "synthesize"])
def test_an_ended_update_is_made_up_for(live, stage):
    def end(now, fraction):
        if now == stage:
            raise Stop

    live.scene["sign_30"].position += (0.1, 0.0, 0.0)
    with pytest.raises(Stop):
        live.update(progress=end)
    live.scene["pole_20"].position += (0.1, 0.0, 0.0)
    assert difference(live.update(), fresh_view(live)) < ROUNDING


@pytest.mark.parametrize("step", ["_note", "_set_cubes"])
def test_an_update_that_ctrl_c_ends_between_two_steps_is_made_up_for(live, monkeypatch, step):
    """Ctrl-C is heard where a call returns: once the record is new and the cube does not know it, or has it already."""
    make = getattr(KeptSignal, step)

    def end(kept, *args):
        if step == "_set_cubes":
            make(kept, *args)
        raise KeyboardInterrupt

    live.scene["sign_30"].position += (0.1, 0.0, 0.0)
    with monkeypatch.context() as heard:
        heard.setattr(KeptSignal, step, end)
        with pytest.raises(KeyboardInterrupt):
            live.update()
    live.scene["pole_20"].position += (0.1, 0.0, 0.0)
    assert difference(live.update(), fresh_view(live)) < ROUNDING


def test_a_bad_change_is_refused_and_nothing_is_lost(live):
    where = np.array(live.scene["sign_30"].position)
    live.scene["sign_30"].position = (1e30, 0.0, 0.0)
    with pytest.raises(ValueError, match="sign_30"):
        live.update()
    live.scene["sign_30"].position = where
    assert difference(live.update(), make_live().update()) < ROUNDING


def test_a_scene_without_a_signal_is_refused_and_the_next_one_is_shown(live, monkeypatch):
    """Paths whose echoes are no numbers were asked for again at each update from then on."""
    def refuse_far_signs(paths, *args, **keywords):
        signs = [mesh.id for mesh in paths.scene.meshes if mesh.name.startswith("sign_30")]
        if any(paths.scene.world_vertices(sign, 0.0)[:, 0].max() > 29.4 for sign in signs):
            raise ValueError("amplitude: must be finite, got nan")
        return synthesize_slots(paths, *args, **keywords)

    monkeypatch.setattr(kept_signal, "synthesize_slots", refuse_far_signs)
    for step in (0.5, -0.5):
        live.scene["sign_30"].position += (step, 0.0, 0.0)
        if step > 0.0:
            with pytest.raises(ValueError, match="amplitude"):
                live.update()
    assert difference(live.update(), make_live().update()) < ROUNDING


def test_a_preview_has_fewer_rays_and_is_that_of_a_fresh_scene(live):
    live.scene["sign_30"].position += (0.1, 0.0, 0.0)
    preview = live.preview(num_rays=500)
    assert preview.is_preview and 400 < preview.num_rays < 600
    assert difference(preview, fresh_view(live, num_rays=500)) == 0.0
    assert not live.update().is_preview


@pytest.mark.parametrize("call, named", [
    (lambda live: ep.Live(live.scene, live.radar, num_rays=0), "num_rays"),
    (lambda live: ep.Live(live.scene, "radar"), "radar"),
    (lambda live: ep.Live(live.scene, live.radar, parts=["sign_30"]), "parts"),
    (lambda live: ep.Live(live.scene, live.radar, parts={"sign": 3}), "parts.sign"),
    (lambda live: ep.Live(live.scene, live.radar, parts={"who": ep.hits("nobody")}).update(), "parts.who"),
    (lambda live: ep.Live(live.scene, live.radar, window="square"), "window"),
    (lambda live: live.change(3), "function"), (lambda live: live.watch(None), "show"),
    (lambda live: live.watch(print, failed=3), "failed"),
    (lambda live: live.watch(print, budget=0.0), "budget"), (lambda live: live.preview(num_rays=-1), "num_rays"),
    (lambda live: setattr(live, "radar", None), "radar"), (lambda live: live.set_map(zero_pad=0), "zero_pad")])
def test_wrong_arguments_are_named(live_at_rest, call, named):
    with pytest.raises((TypeError, ValueError), match=named):
        call(live_at_rest)


def test_the_record_that_an_update_has_made_is_handed_out_and_is_that_of_the_scene_now():
    live = make_live()
    for step in (0.0, 0.1):
        live.radar = live.radar.replace(position=(0.0, step, 0.0))  # all rays are shot again
        live.update()
        handed, made = live.paths(), live.paths()
        for name in ("offsets", "num_bounces", "mesh_id", "triangle_id", "u", "v", "weight"):
            assert np.array_equal(getattr(handed, name), getattr(made, name))
        assert handed.radar.position[1] == step == made.radar.position[1]


def test_paths_come_after_the_first_update():
    with pytest.raises(ValueError, match="updated"):
        make_live().paths()


def test_chirps_that_differ_have_the_signal_of_the_record(live):
    """Before and after a change, which is added to the signal by itself."""
    waveform = live.radar.waveform.replace(frequency_steps=(0.0, 5e6), bandwidth_steps=(0.0, 2e7, 0.0))
    live.radar = live.radar.replace(waveform=waveform)
    for _ in range(2):
        view = live.update()
        expected = ep.synthesize(live.paths(), live.radar)
        assert np.abs(view.cube - expected).max() < ROUNDING * np.abs(expected).max()
        live.scene["sign_30"].position += (0.0, 0.1, 0.0)


def test_a_live_scene_says_what_travels_in_its_place(live_at_rest):
    live = live_at_rest
    for travel in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="^Live: holds locks of its threads and cannot be pickled or copied; pickle or copy "
                                            "its scene and radar"):
            travel(live)
    again = ep.Live(*pickle.loads(pickle.dumps((live.scene, live.radar))), num_rays=live.num_rays)
    assert np.array_equal(again.update().cube, ep.Live(live.scene, live.radar, num_rays=live.num_rays).update().cube)
