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
