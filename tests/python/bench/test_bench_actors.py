"""`echopath bench actors`: statistics of a cross section over aspect, what is written, and a person beside measurements."""
import csv

import numpy as np
import pytest

import echopath as ep
from echopath.bench import actors

SPECKLE_DB = 2.0   # of a dozen azimuths


def subject(name):
    return next(one for one in actors.SUBJECTS if one.name == name)


def test_a_sphere_has_its_cross_section_from_all_sides():
    ball = actors.Subject("ball", lambda: ep.actors.Actor([ep.actors.Part("ball", ep.actors.sphere(0.2), "metal", smooth=True)]),
                          "mean", -10.0, -8.0, "pi a^2")
    found = actors.aspect_of(ball, quick=True)
    expected = 10 * np.log10(np.pi * 0.2**2)
    assert (found.mean, found.median) == pytest.approx((expected, expected), abs=0.3)
    assert found.is_within


def test_a_person_is_in_the_band_of_measured_ones():
    found = actors.aspect_of(subject("pedestrian"), quick=True)
    assert subject("pedestrian").low - SPECKLE_DB < found.mean < subject("pedestrian").high + SPECKLE_DB


def test_rows_and_picture_are_written(tmp_path, monkeypatch):
    monkeypatch.setattr(actors, "SUBJECTS", (subject("drone"),))
    found = actors.run_actors(tmp_path, quick=True)
    with open(tmp_path / "actors.csv", newline="", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert row["actor"] == "drone" and float(row["mean_dbsm"]) == pytest.approx(found[0].mean, abs=0.06)
    assert (tmp_path / "actors.png").stat().st_size > 10_000
    assert len(actors.describe(found)) == 2


def test_what_has_no_published_band_is_not_judged(tmp_path):
    """The picture is drawn without one."""
    ball = actors.Subject("ball", lambda: None, "mean", None, None, actors.NONE_FOUND)
    found = [actors.Aspect(ball, np.linspace(0.0, 6.0, 8), np.full(8, 0.1))]
    assert found[0].is_within is None and "no band" in actors.describe(found)[1]
    assert found[0].peak == pytest.approx(-10.0)
    actors.draw(found, tmp_path / "actors.png")
    assert (tmp_path / "actors.png").stat().st_size > 10_000


def test_a_sign_that_faces_the_radar_has_its_closed_form():
    found = actors.aspect_of(subject("traffic sign"), quick=True)
    area = np.pi * 0.3**2
    expected = 4.0 * np.pi * area**2 / (299792458.0 / 77e9) ** 2
    assert found.peak == pytest.approx(10.0 * np.log10(expected), abs=actors.CLOSED_FORM_DB)
    assert found.is_within
