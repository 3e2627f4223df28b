"""`echopath bench measured`: metal targets beside measurement and method of moments, with and without edges."""
import csv

import numpy as np
import pytest

from echopath.bench import measured


@pytest.fixture(scope="module")
def table():
    return measured.read_table()


def of_name(name):
    return next(one for one in measured.TARGETS if one.name == name)


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
    for target, azimuth, area in (("plate", 0, 6.0 * 10.5 * measured.INCH ** 2), ("camera box", 0, 0.325 * 0.3 * 0.4 ** 2)):
        rows = table[(table["target"] == target) & (table["frequency_ghz"] == 10.24) & (table["azimuth_deg"] == azimuth)]
        assert rows["measured_dbsm"] == pytest.approx(10.0 * np.log10(4.0 * np.pi * area ** 2 / wavelength ** 2), abs=1.0)


def test_a_run_writes_a_table_and_a_picture(tmp_path, monkeypatch):
    monkeypatch.setattr(measured, "TARGETS", [of_name("plate")])
    found = measured.run_measured(tmp_path, quick=True)
    rows = list(csv.DictReader(open(tmp_path / "measured.csv", newline="", encoding="utf-8")))
    assert len(rows) == len(found) == 4 and {row["target"] for row in rows} == {"plate"}
    assert (tmp_path / "measured.png").stat().st_size > 10_000
    assert any("plate 7 GHz vv beside measurement" in line for line in measured.describe(found))
