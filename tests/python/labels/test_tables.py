"""Tables of paths, detections and labels: what each row says is what the record says, told path by path."""
import sys

import numpy as np
import pytest

import echopath as ep
from echopath.presentation.tables import name_with_unit


@pytest.fixture(scope="module")
def paths(plates_and_wall):
    return plates_and_wall[0]


def test_rows_of_paths_tell_each_hit(paths):
    table = paths.to_dataframe()
    assert len(table) == paths.num_paths
    names = [mesh.name for mesh in paths.scene.meshes]
    strata = [stratum.name for stratum in paths.frame.strata]
    length, power = paths.lengths([paths.frame.trace_time])[0], np.abs(paths.amplitude) ** 2
    families = ep.families(paths)
    for path in np.linspace(0, paths.num_paths - 1, 60).astype(int):
        row, first, count = table.iloc[path], paths.offsets[path], int(paths.num_bounces[path])
        assert row.bounces == count
        assert row.meshes == " > ".join(names[mesh] for mesh in paths.mesh_id[first:first + count])
        assert row.events == "".join("D" if int(paths.diffuse[path]) >> hit & 1 else "S" for hit in range(count))
        assert row.kind == ("diffuse" if paths.diffuse[path] else "coherent")
        assert row.length == length[path] and row.power == pytest.approx(power[path], rel=1e-12)
        assert row.stratum == ("" if paths.stratum[path] == 65535 else strata[paths.stratum[path]])
        family = families.families[families.family_of_path[path]]
        assert (row.object, row.ghost_type, row.order) == (family.object, family.ghost_type, family.order)
        assert row.is_reversed == bool(paths.flags[path] & 1)
    assert table.attrs["units"] == {"length": "m", "power": "W"}


def test_events_agree_with_path_expressions(paths):
    table = paths.to_dataframe()
    for expression, events in (("T D R", "D"), ("T S D R", "SD"), ("T D S R", "DS")):
        taken = ep.Selection(expression).matches(paths)
        assert taken.any() and np.array_equal(taken, table.events == events)


def test_tables_of_no_paths_and_of_the_longest_ones():
    scene = ep.Scene()
    mirror = ep.Material.metal(mirror=True)
    for name, x, yaw in (("near", -1.0, 0.0), ("far", 1.0, np.pi)):
        scene.add(ep.actors.plate(40.0, 40.0), name=name, position=(x, 0, 0), yaw=yaw, material=mirror)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=1e9, bandwidth=1e8, num_samples=8, sampling_rate=1e6, num_chirps=1,
                                      chirp_interval=1e-4),
                     transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0.1, 0))])
    paths = ep.trace(scene, radar, num_rays=100, max_bounces=64)
    table = paths.to_dataframe()
    assert table.bounces.max() == 64 and set(table.events.str.len() - table.bounces) == {0}
    none = paths.select(np.zeros(paths.num_paths, bool)).to_dataframe()
    assert len(none) == 0 and list(none.columns) == list(table.columns)


def test_labels_have_a_row_for_each_object_and_ghost(labels):
    table = labels.to_dataframe()
    assert list(table.kind) == ["object"] * len(labels.objects) + ["ghost"] * len(labels.ghosts)
    for row, label in zip(table.itertuples(), [*labels.objects, *labels.ghosts]):
        assert row.cells == label.cells and row.power == label.power
        assert row.received == label.received.power and row.is_resolved == label.received.resolved
        if label.peak is not None:
            assert (row.range, row.velocity, row.peak_power) == tuple(label.peak)
            assert (row.range_min, row.range_max, row.velocity_min, row.velocity_max) == tuple(label.box)
        else:
            assert np.isnan(row.range)
    ghosts = table[table.kind == "ghost"]
    assert list(ghosts.via) == [" > ".join(ghost.via) for ghost in labels.ghosts]
    assert table.attrs["units"]["velocity"] == "m/s" and "azimuth" not in table.attrs["units"]


def test_detections_are_the_rows_of_their_csv(paths, tmp_path):
    import pandas

    cube = ep.add_noise(ep.synthesize(paths), paths.radar, seed=3)
    found = ep.detect(ep.range_doppler(cube, paths.radar), paths.radar, paths=paths)
    found.to_csv(tmp_path / "found.csv")
    table, read = found.to_dataframe(), pandas.read_csv(tmp_path / "found.csv")
    assert len(table) == len(found) > 0
    for name in table.columns:
        if table[name].dtype.kind in "fiub":
            written = read[name_with_unit(name, table.attrs["units"])].to_numpy(float)
            assert np.array_equal(written, table[name].to_numpy(float), equal_nan=True), name
    assert table.attrs["seed"] == paths.frame.seed and table.attrs["units"]["snr_db"] == "dB"


def test_without_pandas_the_message_says_what_to_install(labels, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ModuleNotFoundError, match=r"to_dataframe needs pandas, .*: pip install 'echopath\[pandas\]'"):
        labels.to_dataframe()
