"""`echopath bench measured`: metal targets beside measurement and method of moments, with and without edges."""
import csv

import numpy as np
import pytest

import echopath as ep
from echopath.bench import measured
from echopath.bench.measured import targets as measured_targets


@pytest.fixture(scope="module")
def table():
    return measured.read_table()


def of_name(name):
    return next(one for one in measured.TARGETS if one.name == name)


def test_waves_bring_a_bent_duct_to_its_level(table):
    """At 7 GHz, every twelfth degree; rays inside miss the bound by 1.6 dB."""
    duct = of_name("cobra duct")
    rows = measured.rows_of(duct, 7.0, "hh", table, quick=True)[::4]
    floor = rows["moments_dbsm"].max() - measured.FLOOR_DB
    found, expected = (np.maximum(one, floor) for one in (measured.levels_of(duct, rows, edges=True, quick=True),
                                                          rows["moments_dbsm"]))
    assert np.abs(found - expected).mean() < measured.LIMITS["cobra duct", "hh"]


@pytest.mark.parametrize("name, polarization", [("plate", "vv"), ("plate", "hh"), ("camera box", "vv"), ("camera box", "hh")])
def test_edges_bring_real_targets_to_their_levels(table, name, polarization):
    """Every third degree and few rays: a quarter more than the bound of all azimuths."""
    found = measured.pattern_of(of_name(name), 10.24, polarization, table, quick=True)
    reference = found.measured if name == "plate" else found.moments
    limit = measured.LIMITS[name, polarization]
    assert found.error(found.with_edges, reference) < 1.25 * limit < found.error(found.optics, reference)


def test_the_table_has_the_broadside_of_its_targets(table):
    """4 pi A^2 / lambda^2 of the faces that the radar looks at."""
    wavelength = 299792458.0 / 10.24e9
    plate = 6.0 * 10.5 * measured_targets.INCH ** 2
    for target, azimuth, area in (("plate", 0, plate), ("camera box", 0, 0.325 * 0.26 * 0.4 ** 2)):
        rows = table[(table["target"] == target) & (table["frequency_ghz"] == 10.24) & (table["azimuth_deg"] == azimuth)]
        assert rows["measured_dbsm"] == pytest.approx(10.0 * np.log10(4.0 * np.pi * area ** 2 / wavelength ** 2), abs=1.0)


@pytest.mark.usefixtures("plain_pictures")
def test_a_run_writes_a_table_and_a_picture(tmp_path, monkeypatch):
    monkeypatch.setattr(measured, "TARGETS", [of_name("plate")])
    found = measured.run_measured(tmp_path, quick=True)
    rows = list(csv.DictReader(open(tmp_path / "measured.csv", newline="", encoding="utf-8")))
    assert len(rows) == len(found) == 4 and {row["target"] for row in rows} == {"plate"}
    assert (tmp_path / "measured_1.png").stat().st_size > 10_000
    assert any("plate 7 GHz vv beside measurement" in line for line in measured.describe(found))


def faces_of(meshes):
    """Corners [F, 3, 3] of the triangles of several meshes."""
    return np.concatenate([np.asarray(mesh.vertices)[np.asarray(mesh.triangles)] for mesh in meshes])


def test_what_nobody_measured_has_a_dash():
    levels, nothing = np.linspace(-20.0, 0.0, 4), np.full(4, np.nan)
    one = measured.Pattern("sheet IIA", 7.0, "vv", np.arange(4.0), nothing, levels, levels - 1.0, levels, 64, (0.1, 0.2))
    told = measured.describe([one])[2]
    assert "- -> -" in told and "1.00 -> 0.00" in told and "nan" not in told


@pytest.mark.parametrize("make, size, volume", [
    (measured_targets.camera_box, (1.0, 0.325, 0.8), 0.325 * (0.8 - 0.27 ** 2)),
    (measured_targets.cylindrical_duct, (1.0, 0.975, 1.6), 0.975 * (1.6 - 0.41 ** 2) - 0.75 * np.pi * 0.375 ** 2),
    (measured_targets.cobra_duct, (1.0, 0.325, 0.8),  # of the duct: its height times width times the length of its middle
     0.325 * (0.8 - 0.27 ** 2) - 0.21 * 0.275 * (0.025 + 0.2 + 0.25 + np.radians(35.0) * (0.57 + 0.36)))])
def test_boxes_with_ducts_are_closed_and_as_large_as_described(make, size, volume):
    """By Gauss's theorem, each triangle turned to the outside of the metal by a ray toward +x that counts what it meets."""
    faces = faces_of(make()) / measured_targets.BOX_LENGTH
    assert np.ptp(faces.reshape(-1, 3), axis=0) == pytest.approx(size, abs=1e-6)
    assert enclosed(faces) == pytest.approx(volume, rel=0.01)


def enclosed(faces, steps=60) -> float:
    """The volume inside of a closed surface: a lattice of lines along x, the lengths between every second pair of crossings."""
    low, high = faces.reshape(-1, 3)[:, 1:].min(axis=0), faces.reshape(-1, 3)[:, 1:].max(axis=0)
    places = [low[k] + (np.arange(steps) + 0.4871) / steps * (high[k] - low[k]) for k in range(2)]
    total = 0.0
    a, b, c = (faces[:, k] for k in range(3))
    across = lambda p, q: p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]
    area = across((b - a)[:, 1:], (c - a)[:, 1:])
    kept = np.abs(area) > 1e-12
    a, b, c, area = a[kept], b[kept], c[kept], area[kept]
    for y in places[0]:
        for z in places[1]:
            point = np.array([y, z])
            u, v = across(point - a[:, 1:], (c - a)[:, 1:]) / area, across((b - a)[:, 1:], point - a[:, 1:]) / area
            met = (u >= 0.0) & (v >= 0.0) & (u + v < 1.0)
            x = np.sort((a[:, 0] + u * (b - a)[:, 0] + v * (c - a)[:, 0])[met])
            assert x.size % 2 == 0
            total += (x[1::2] - x[0::2]).sum()
    return total * np.prod(high - low) / steps ** 2


def test_the_almond_has_the_girth_of_its_formula():
    corners = faces_of(measured_targets.almond()).reshape(-1, 3) / measured_targets.ALMOND_LENGTH
    assert np.ptp(corners, axis=0) == pytest.approx((1.0, 2 * 0.193333, 2 * 0.193333 / 3.0), abs=2e-3)
    assert corners[:, 0].max() == pytest.approx(0.583333, abs=1e-6)


def test_a_well_seen_along_its_walls_has_the_echo_of_its_floor():
    """A duct of facets: its floor is no endless mirror between its walls. The nose about it adds its own echo."""
    scene = measured.scene_of(measured.Target("cylindrical duct", "", measured_targets.cylindrical_duct))
    frequency, length = 10e9, measured_targets.BOX_LENGTH
    sigma = ep.rcs(scene, frequency=frequency, incidence=(1, 0, 0), num_rays=2 ** 14)
    wavelength, floor = 299792458.0 / frequency, np.pi * 0.375 ** 2 * length ** 2
    nose = 0.975 * 0.78 * length ** 2 - floor
    field = nose + floor * np.exp(-4j * np.pi * 0.75 * length / wavelength)
    assert 10.0 * np.log10(sigma) == pytest.approx(10.0 * np.log10(4.0 * np.pi * abs(field) ** 2 / wavelength ** 2), abs=0.5)
