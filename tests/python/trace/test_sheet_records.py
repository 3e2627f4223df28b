"""Records of paths through sheets: expressions, tables, files, live scenes, labels and effects."""
import pickle
import re

import numpy as np
import pytest

import echopath as ep
from support.behind_sheets import FREQUENCY, GLASS, echo_of_ball, make_radar, make_scene, over_free

# --- sides ---

@pytest.mark.parametrize("flips, above, shows_front", [
    ((1, 1, 1), (1, 1, 1), True), ((-1, -1, 1), (1, 1, 1), False),      # as it is, and turned about
    ((1, -1, 1), (1, 1, 1), True), ((-1, 1, 1), (1, 1, 1), False),      # mirrored aside, and along the line of sight
    ((1, -1, 1), (1, 1, -1), True), ((1, 1, 1), (-1, 1, 1), False)])    # by what carries it, too
def test_what_is_mirrored_keeps_the_layers_of_its_front_in_front(flips, above, shows_front):
    """Where triangles go the other way round, the last layer had come first: 9.4 dB too much of this sheet. Closed form."""
    sheet = ep.Material(layers=[ep.Layer(0.0007, 2.0), ep.Layer(0.002, 8 - 2j)])
    corners = 0.03 * np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]])
    found = []
    for material in (sheet, ep.Material.metal()):
        scene = ep.Scene()
        scene.add(None, name="body", transform=np.diag([*above, 1.0]))
        scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name="sheet", material=material, parent="body",
                  transform=np.diag([*flips, 1.0]))
        found.append(ep.rcs(scene, frequency=77e9, incidence=(1, 0, 0), observation=(1, 0, 0), num_rays=4000))
    wanted = ep.sheet_coefficients(sheet, frequency=77e9, incidence=0.0, from_behind=not shows_front).te_reflection[0]
    assert found[0] / found[1] == pytest.approx(abs(wanted) ** 2, rel=1e-6)


# --- expressions, tables, files ---

def test_expressions_see_passes_only_where_they_name_them():
    paths = ep.trace(make_scene(), make_radar(), num_rays=4000, max_bounces=2)
    everything = paths.select("T 'ball' R")
    assert everything.num_paths > 0
    for text in ("T P'pane' 'ball' P'pane' R", "T P . P R", "T 'pane' 'ball' P R", "T P S P R & T 'ball' R"):
        assert paths.select(text).num_paths == everything.num_paths, text
    assert paths.select("T P'ball' .* R").num_paths == 0
    none = paths.select("T P{0} . R")  # which names them: its one hit is a bounce, and it goes through none
    assert none.num_paths == np.count_nonzero((paths.num_bounces == 1) & (np.diff(paths.pass_offsets) == 0)) > 0
    assert none.num_paths == paths.select("T . R & ~(T .* P .* R)").num_paths
    assert paths.select("T S'ball' R & T P . P R").num_paths == everything.num_paths
    assert (everything.num_bounces == 1).all() and paths.select(ep.passes("pane") & ep.hits("ball")).num_paths > 0
    parts = paths.partition({"seen": "T P'pane' 'ball' P'pane' R"})
    assert parts["seen"].num_paths + parts["other"].num_paths == paths.num_paths


def test_passes_lie_on_the_legs_and_on_the_pane():
    paths = echo_of_ball(make_scene(), make_radar(), num_rays=500)
    assert len(paths.pass_offsets) == paths.num_paths + 1 and paths.pass_offsets[-1] == len(paths.passes)
    assert np.array_equal(paths.passes["leg"], np.tile([0, 1], paths.num_paths))
    corners = paths.scene.world_vertices(1, paths.frame.trace_time)[paths.scene.meshes[1].triangles[paths.passes["triangle_id"]]]
    u, v = paths.passes["u"][:, None], paths.passes["v"][:, None]
    met = (1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2]
    ball = np.repeat(paths.points(paths.frame.trace_time)[paths.offsets], 2, axis=0)
    antenna = np.tile([paths.frame.transmitter, paths.frame.receiver], (paths.num_paths, 1))
    across = np.cross(met - antenna, ball - antenna) / np.linalg.norm(ball - antenna, axis=1, keepdims=True)
    assert np.max(np.linalg.norm(across, axis=1)) < 1e-3


def test_records_with_passes_travel(tmp_path):
    paths = ep.trace(make_scene(yaw=0.4), make_radar(), num_rays=2000)
    paths.save(tmp_path / "frame.h5")
    for other in (ep.Paths.load(tmp_path / "frame.h5"), pickle.loads(pickle.dumps(paths))):
        assert np.array_equal(other.passes, paths.passes) and np.array_equal(other.pass_offsets, paths.pass_offsets)
        assert np.array_equal(other.amplitude, paths.amplitude)
        assert other.scene.meshes[1].material == GLASS
    loud = paths.select(paths.power >= np.median(paths.power))
    assert loud.pass_offsets[-1] == len(loud.passes) < len(paths.passes)
    assert np.array_equal(loud.amplitude, paths.amplitude[paths.power >= np.median(paths.power)])
    assert set(paths.to_dataframe()["passes"]) >= {"pane > pane", ""}


def test_the_same_bits_for_any_number_of_threads():
    signals = []
    for count in (1, 2):
        before = ep.num_threads()
        ep.set_num_threads(count)
        try:
            signals.append(ep.synthesize(ep.trace(make_scene(yaw=0.4), make_radar(), num_rays=2000), make_radar()))
        finally:
            ep.set_num_threads(before)
    assert np.array_equal(signals[0], signals[1])


def test_scene_files_have_layers(tmp_path):
    (tmp_path / "scene.toml").write_text("""
[radar]
waveform = {start_frequency = 77e9, bandwidth = 1e9, num_samples = 64, sampling_rate = 2e7, num_chirps = 4, chirp_interval = 1e-4}
transmitters = [{position = [0, 0, 1]}]
receivers = [{position = [0, 0.01, 1]}]
[[objects]]
name = "pane"
actor = "plate"
parameters = {width = 2.0, height = 2.0}
position = [3, 0, 1]
material = {layers = [{thickness = 0.004, permittivity = [6.3, 0.3]}]}
""", encoding="utf-8")
    assert ep.load_scene(tmp_path / "scene.toml").scene.meshes[0].material == GLASS


# --- around it ---

def test_live_scenes_follow_a_pane():
    live = ep.Live(make_scene(), make_radar(), num_rays=3000)
    live.update()
    live.scene["pane"].yaw = 0.5
    view = live.update()
    fresh = ep.Live(make_scene(yaw=0.5), make_radar(), num_rays=3000).update().cube
    assert np.max(np.abs(view.cube - fresh)) < 1e-12 * np.max(np.abs(fresh))
    traced = ep.synthesize(ep.trace(make_scene(yaw=0.5), make_radar(), num_rays=3000), make_radar())  # with other rays
    assert np.max(np.abs(view.cube - traced)) < 1e-4 * np.max(np.abs(traced))


def check_that_a_pane_moves_nothing_else(scene, place):
    """That a live view is the fresh one after the pane has gone to a place (m)."""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e8, num_samples=128, sampling_rate=20e6, num_chirps=16,
                                chirp_interval=1e-3)
    live = ep.Live(scene, make_radar(waveform), num_rays=2000, polarization="jones")
    live.update()
    live.scene["pane"].position = place
    view = live.update()
    fresh = ep.Live(live.scene, make_radar(waveform), num_rays=2000, polarization="jones").update().cube
    assert view.num_rays_shot < view.num_rays / 2
    assert np.max(np.abs(view.cube - fresh)) < 1e-12 * np.max(np.abs(fresh))


def radome_and_pane(height: float, pane_size: float, pane_height: float):
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.5, edge=0.1), name="radome", material=GLASS, position=(4.0, 0.0, height), smooth=True)
    scene.add(ep.actors.plate(pane_size, pane_size), name="pane", material=GLASS, position=(2.0, 5.0, pane_height), yaw=-0.4)
    return scene


def test_what_a_curved_sheet_lets_through_stays_as_it_is_where_another_sheet_moves():
    scene = radome_and_pane(0.0, 2.0, 0.0)
    for name, y in (("box", 0.2), ("another", 9.0)):
        scene.add(ep.actors.box((1.0, 0.8, 1.2)), name=name, material=ep.Material.metal(), position=(8.0, y, 0.0), yaw=0.5)
    check_that_a_pane_moves_nothing_else(scene, (2.3, 5.0, 0.0))


def test_what_a_curved_sheet_lets_through_from_afar_stays_as_it_is_where_another_sheet_moves():
    """From beyond the points to which rays would be moved up in a scene of the sheets alone, whose size the pane decides."""
    scene = radome_and_pane(0.7, 0.5, 6.0)
    for name, place in (("box", (60.0, 1.5, -3.0)), ("another", (60.0, 20.0, 0.0))):
        scene.add(ep.actors.box((4.0, 6.0, 6.0)), name=name, material=ep.Material(reflectivity=1.0, scattering=1.0),
                  position=place, yaw=0.5)
    check_that_a_pane_moves_nothing_else(scene, (2.0, 8.0, 6.0))


def test_who_stands_behind_a_pane_is_visible_and_a_wall_hides_it():
    def share(material):
        return {seen.name: seen for seen in ep.visibility(make_scene(material), make_radar())}["ball"].visible_share
    assert share(GLASS) == pytest.approx(1.0) and share(ep.Material.metal()) == pytest.approx(0.0)


def test_one_trace_serves_a_frame_behind_a_pane_at_rest():
    scene = make_scene(ball_motion=ep.LinearMotion(velocity=(-1, 0, 0)))
    paths = ep.trace(scene, make_radar(), num_rays=4000)
    assert ep.validity(paths, make_radar()).shares.new_surface < 0.01


def airy_powers(frequency, permittivity, thickness):
    """Shares of the power that a slab in air passes and reflects at normal incidence: Airy's formulas."""
    index = np.sqrt(permittivity)
    face, turn = (1.0 - index) / (1.0 + index), np.exp(-4j * np.pi * frequency / ep.speed_of_light * index * thickness)
    whole = 1.0 - face**2 * turn
    return abs((1.0 - face**2) / whole) ** 2 * abs(turn), abs(face * (1.0 - turn) / whole) ** 2


def effects_of_sheet(layer):
    """What ep.effects tells of a sheet in a band of 4 GHz from 78 GHz on."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="sheet", material=ep.Material(layers=[layer]))
    waveform = ep.ChirpSequence(start_frequency=78e9, bandwidth=4e9)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((3, 0, 0))], receivers=[ep.Antenna((3, 0, 0))])
    return [one for one in ep.effects(scene, radar) if one.name == "transmission through sheets"]


@pytest.mark.parametrize(("permittivity", "thickness"), [(2.2 - 0.01j, 0.01), (6.3 - 0.3j, 0.012), (2.0 - 0.002j, 0.3)])
def test_effects_tell_how_much_a_sheet_changes_over_the_band(permittivity, thickness):
    (effect,) = effects_of_sheet(ep.Layer(thickness, permittivity))
    powers = np.array([airy_powers(one, permittivity, thickness) for one in np.linspace(78e9, 82e9, 20_001)])
    passed, reflected = np.abs(10.0 * np.log10(powers / powers[0])).max(axis=0)
    told = [float(one) for one in re.findall(r"by (?:up to |more than )?([0-9.]+) dB", effect.reason)]
    assert told[0] == pytest.approx(passed, abs=0.1)
    assert told[1] == pytest.approx(min(reflected, 40.0), rel=0.15)


@pytest.mark.parametrize(("layer", "told"), [
    (ep.Layer(0.1, 5 - 0.5j), False),                                                # opaque: what passes is nothing either way
    (ep.Layer(256.0 * ep.speed_of_light / (2.0 * np.sqrt(2.2) * 4e9), 2.2), True)])  # 256 whole ripples over the band
def test_effects_of_very_thick_sheets(layer, told):
    (effect,) = effects_of_sheet(layer)
    assert ("over the band it differs by up to 0." in effect.reason) == told


def test_effects_say_nothing_of_sheets_that_are_alike_over_the_band():
    (effect,) = effects_of_sheet(ep.Layer(0.0005, 6.3 - 0.3j))
    powers = np.array([airy_powers(one, 6.3 - 0.3j, 0.0005) for one in np.linspace(78e9, 82e9, 101)])
    assert np.abs(10.0 * np.log10(powers / powers[0])).max() < 0.5
    assert "over the band" not in effect.reason


def test_effects_name_sheets_and_what_passes():
    effects = {effect.name: effect for effect in ep.trace(make_scene(), make_radar(), num_rays=2000).effects}
    effect = effects["transmission through sheets"]
    share = 20.0 * np.log10(abs(over_free(0.0)[0]))
    assert effect.modelled and "pane" in effect.reason and f"{share:.1f} dB" in effect.reason
