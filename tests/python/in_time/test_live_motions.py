"""Live scenes in which objects come and go whose motions have other knots: the signals of all others stay as they are."""
import numpy as np
import pytest

import echopath as ep
from support.arm import make_arm
from support.live import difference

pytestmark = pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")  # bodies are coarse, which tells as much
ROUNDING = 1e-12  # of the largest sample: signals are added and taken away
RAYS = 1000
ROUGH = ep.Material(permittivity=5.0, scattering=0.5)
FIRST, LAST = -0.1, 0.3  # s, of what is sampled, around a frame of 38 ms


def keyframes(rate: float, *, shift: float = 0.0, interpolation: str = "cubic") -> ep.KeyframeMotion:
    """Goes straight on and sways, sampled at a rate (1/s) and at times that are shifted (s)."""
    times = np.arange(FIRST + shift, LAST, 1.0 / rate)
    places = np.column_stack([-3.0 * times, 0.1 * np.sin(20.0 * times), 0.02 * np.cos(15.0 * times)])
    angles = 0.3 * np.sin(12.0 * times)
    turns = np.column_stack([np.cos(0.5 * angles), 0.0 * angles, 0.0 * angles, np.sin(0.5 * angles)])
    return ep.KeyframeMotion(times=times, translations=places, rotations=turns, interpolation=interpolation)


def breathing(mesh: ep.Mesh, rate: float) -> ep.VertexSequence:
    times = np.arange(FIRST, LAST, 1.0 / rate)
    return ep.VertexSequence(times=times, vertices=np.array([mesh.vertices * (1.0 + 0.05 * np.sin(25.0 * t)) for t in times]))


def add_skin(scene, **place) -> None:
    """An arm that bends at shoulder and elbow, whose joints are sampled at other times."""
    mesh, skin = make_arm((keyframes(110.0, shift=0.003), keyframes(70.0)))
    scene.add(mesh, motion=skin, material="skin", smooth=True, **place)


def add_breather(scene, **place) -> None:
    mesh = ep.actors.sphere(0.5, edge=0.1)
    scene.add(mesh, motion=breathing(mesh, 95.0), material="clothing", smooth=True, **place)


GUESTS = {
    "dog": lambda scene, **place: scene.add(ep.actors.dog(), **place),
    "child": lambda scene, **place: scene.add(ep.actors.child(start_time=-0.3, edge=0.05), **place),
    "cyclist": lambda scene, **place: scene.add(ep.actors.cyclist(start_time=-0.21, edge=0.05), **place),
    "keyframed": lambda scene, **place: scene.add(ep.actors.car(), motion=keyframes(60.0, shift=0.007), **place),
    "jerking": lambda scene, **place: scene.add(ep.actors.box(0.8), material=ROUGH,
                                                motion=keyframes(45.0, interpolation="linear"), **place),
    "skin": add_skin,
    "breather": add_breather,
}


def street() -> ep.Live:
    """Boxes at rest, a pedestrian, and cars that drive straight on and round a bend; frames have several knots."""
    scene = ep.Scene()
    for k in range(30):
        scene.add(ep.actors.box(0.6), name=f"box_{k}", material=ROUGH, position=(6.0 + 0.8 * k, 7.0 * (-1) ** k, 0.3))
    scene.add(ep.actors.pedestrian(edge=0.05), name="pedestrian", position=(9.0, 1.0, 0.0), yaw=np.pi)
    scene.add(ep.actors.box((3.5, 1.6, 1.4)), name="car", material=ROUGH, position=(14.0, -2.0, 0.7),
              motion=ep.LinearMotion(velocity=(8.0, 0.0, 0.0)))
    scene.add(ep.actors.box((3.5, 1.6, 1.4)), name="turning", material=ROUGH, position=(18.0, 2.5, 0.7),
              motion=ep.LinearMotion(velocity=(-9.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 9.0)))
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=5e8, num_samples=32, sampling_rate=10e6, num_chirps=64,
                                chirp_interval=6e-4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.0, 0.7))], receivers=[ep.Antenna((0.0, 0.01, 0.7))])
    return ep.Live(scene, radar, num_rays=RAYS)


def error_of(live: ep.Live) -> float:
    return difference(live.update(), ep.Live(live.scene, live.radar, num_rays=RAYS).update())


@pytest.mark.parametrize("guest", GUESTS)
def test_an_object_with_knots_of_its_own_comes_is_moved_and_goes(guest):
    live = street()
    live.update()
    for change in (lambda scene: GUESTS[guest](scene, name=guest, position=(11.0, -0.5, 0.8)),
                   lambda scene: setattr(scene["car"], "position", (14.5, -2.0, 0.7)),
                   lambda scene: setattr(scene[guest], "position", (11.2, -0.4, 0.8)),
                   lambda scene: setattr(scene["box_0"], "position", (8.0, -0.4, 0.5)),  # before a part of it
                   lambda scene: setattr(scene[guest], "visible", False),
                   lambda scene: setattr(scene[guest], "visible", True),
                   lambda scene: scene.remove(guest)):
        live.change(change)
        view = live.update()
        assert view.num_rays_shot < 0.4 * view.num_rays  # or all would be summed anew
        assert error_of(live) < ROUNDING


def come_or_go(scene, draw, name: str) -> None:
    if name in scene:
        scene.remove(name)
    else:
        GUESTS[name](scene, name=name, position=(11.0, 0.0, 0.8) + draw.normal(0.0, 1.0, 3) * (3.0, 2.0, 0.0))


def hide_or_show(scene, draw, name: str) -> None:
    scene["pedestrian"].visible = not scene["pedestrian"].visible


def stand_before(scene, draw, name: str) -> None:
    """A box somewhere between the radar and a guest."""
    if name in scene:
        scene["box_0"].position = np.multiply(scene[name].position, draw.uniform(0.5, 0.9)) + (0.0, 0.0, draw.normal(0.0, 0.2))


def move_otherwise(scene, draw, name: str) -> None:
    scene["turning"].motion = keyframes(draw.uniform(40.0, 120.0), shift=draw.uniform(0.0, 0.01))


EDITS = (come_or_go, come_or_go, hide_or_show, stand_before, move_otherwise)


@pytest.mark.parametrize("seed", [1, 2])
def test_random_edits_of_what_moves_end_in_the_view_of_a_fresh_scene(seed):
    draw, live = np.random.default_rng(seed), street()
    live.update()
    for _ in range(16):
        edit, name = EDITS[draw.integers(len(EDITS))], str(draw.choice(list(GUESTS)))
        with live.changing() as scene:
            edit(scene, draw, name)
        assert error_of(live) < ROUNDING, (edit.__name__, name)
