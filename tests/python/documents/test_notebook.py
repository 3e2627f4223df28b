"""Tables for notebooks: they say what the results hold, and names of meshes are text in them, whatever they are."""
from html.parser import HTMLParser

import numpy as np
import pytest

import echopath as ep

EVIL = "<img src=x onerror=alert(1)>&amp;"  # the name of a mesh; neither quotes nor / can be in one
ALLOWED = {"table", "caption", "b", "tr", "th", "td", "p"}


class Reader(HTMLParser):
    """Rows of cells, and the tags that occur."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.tags, self._open, self.text = [], [], [], ""
        self.feed(text)
        self.close()
        assert not self._open

    def handle_starttag(self, tag, attrs):
        assert {name for name, _ in attrs} <= {"style", "colspan"}
        self.tags.append(tag)
        self._open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self._open.pop() == tag

    def handle_data(self, data):
        self.text += data
        if self._open and self._open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


@pytest.fixture(scope="module")
def frame():
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name=EVIL, material="metal", position=(6, 0, 0), yaw=np.pi)
    scene.add(ep.actors.plate(4.0, 2.0), name="wall", material=ep.Material.metal(mirror=True), position=(5, 4, 0), yaw=-np.pi / 2,
              motion=ep.LinearMotion(velocity=(0, 0, 0)))
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=5e6, num_chirps=16,
                              chirp_interval=1e-4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0.01, 0))], transmit_power=1.0)
    return ep.simulate(scene, radar, num_rays=2000, parts={EVIL: "T . R"}, labels=True, detections=True)


def results(frame) -> dict:
    return {"Scene": frame.scene, "Radar": frame.radar, "Paths": frame.paths, "RangeDoppler": frame.spectrum, "Frame": frame,
            "Detections": frame.detections, "Labels": frame.labels["parts"], "Validity": ep.validity(frame.paths),
            "Effects": frame.effects}


KINDS = ("Scene", "Radar", "Paths", "RangeDoppler", "Frame", "Detections", "Labels", "Validity", "Effects")


@pytest.mark.parametrize("kind", KINDS)
def test_tables_are_well_formed_and_have_no_tag_of_a_name(frame, kind):
    made = results(frame)[kind]._repr_html_()
    read = Reader(made)
    assert set(read.tags) <= ALLOWED and "table" in read.tags and len(read.rows) > 1
    assert "<img" not in made and kind in read.text


@pytest.mark.parametrize("kind", ("Scene", "Frame", "Labels", "Validity", "Detections"))
def test_names_are_there_as_they_are_written(frame, kind):
    assert EVIL in Reader(results(frame)[kind]._repr_html_()).text


def test_numbers_of_paths_are_those_of_the_record(frame):
    rows = Reader(frame.paths._repr_html_()).rows[1:]
    for bounces, coherent, diffuse in rows:
        here = frame.paths.num_bounces == int(bounces)
        assert int(coherent.replace(",", "")) == np.count_nonzero(here & (frame.paths.diffuse == 0))
        assert int(diffuse.replace(",", "")) == np.count_nonzero(here & (frame.paths.diffuse != 0))


def test_the_peak_of_a_map_is_told_where_it_is(frame):
    power = np.mean(np.abs(frame.spectrum.values) ** 2, axis=(0, 1))
    row, column = np.unravel_index(power.argmax(), power.shape)
    told = dict(Reader(frame.spectrum._repr_html_()).rows)["strongest cell"]
    assert told == (f"{10 * np.log10(1e3 * power.max()):.1f} dBm at {frame.spectrum.range[column]:.4g} m, "
                    f"{frame.spectrum.velocity[row]:+.4g} m/s")


def test_areas_of_a_scene_are_those_of_objects_as_they_are_scaled():
    scene = ep.Scene()
    scene.add(None, name="in_cm", transform=np.diag([0.01, 0.01, 0.01, 1.0]))
    scene.add(ep.actors.plate(200.0, 300.0), name="wall", parent="in_cm", material="metal")
    scene.add(ep.actors.plate(2.0, 3.0), name="long", transform=np.diag([1.0, 5.0, 1.0, 1.0]), material="metal")
    assert [row[2] for row in Reader(scene._repr_html_()).rows[1:]] == ["6", "30"]


def test_long_scenes_are_cut_and_say_so():
    scene = ep.Scene()
    for index in range(25):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"plate_{index}", material="metal", position=(index, 0, 0))
    read = Reader(scene._repr_html_())
    assert len(read.rows) == 1 + 20 + 1 and read.rows[-1] == ["and 5 more"]
