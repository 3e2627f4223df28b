"""The physics benchmark: its closed forms computed another way, its targets at one number of rays, its files."""
import json

import numpy as np
import pytest

import echopath as ep
from echopath.bench.physics import DEFAULT, Variant, _point, _slope, closed_forms, figure as physics_figure, plate_pairs, targets
from echopath.bench.physics.report import BEST, describe, verdicts
from echopath.bench.replay import figure as replay_figure
from echopath.cli import main

MULTI_BOUNCE_DB = 0.2   # what python/docs/measurements.md promises of corners
MEAN_DB = 0.1           # mean power of diffuse targets and mirrors
PLATE_DB = 0.3          # beyond the first null
INTEGRAL = 1e-5    # relative: a sum of 4000 points, and a radar at 1 km
ROUNDING = 1e-9    # of a fit to powers made exactly
MARGIN = 0.02      # of the error itself: the filter changes little where it has nothing to filter


def test_ellipsoid_of_three_equal_axes_is_a_sphere():
    assert closed_forms.ellipsoid_rcs((0.3, 0.3, 0.3), (0.6, 0.0, 0.8)) == pytest.approx(np.pi * 0.09)


def test_ellipsoid_along_an_axis_has_the_radii_of_curvature_of_its_sections():
    # At the end of the x axis: b^2 / a and c^2 / a.
    assert closed_forms.ellipsoid_rcs((2.0, 1.0, 0.5), (1.0, 0.0, 0.0)) == pytest.approx(np.pi * 0.5 * 0.125)


def test_plate_integrates_its_currents():
    angle, side = np.radians(3.0), 0.1
    x = (np.arange(4000) + 0.5) / 4000 * side - side / 2
    field = np.mean(np.exp(2j * closed_forms.WAVENUMBER * x * np.sin(angle))) * np.cos(angle) * side ** 2
    expected = 4 * np.pi / closed_forms.WAVELENGTH ** 2 * abs(field) ** 2
    assert closed_forms.plate_rcs(side, angle) == pytest.approx(expected, rel=INTEGRAL, abs=0)


def test_lambert_plate_far_away_is_four_rho_area():
    assert closed_forms.lambert_plate_rcs(1.0, 0.3, 1000.0) == pytest.approx(1.2, rel=INTEGRAL, abs=0)


TARGETS = {target.name: target for target in targets.all_targets()}
LIMITS = {"sphere_161": 0.1, "sphere_3228": 0.1, "plate_0": 0.1, "plate_5": PLATE_DB, "dihedral": MULTI_BOUNCE_DB,
          "trihedral": MULTI_BOUNCE_DB, "lambert_plate": MEAN_DB, "two_ray": MEAN_DB, "wall_ghost": MEAN_DB}


@pytest.mark.parametrize("name", LIMITS)
def test_target_is_its_closed_form(name):
    assert _point(TARGETS[name], DEFAULT, 2 ** 14, 3)["rms_db"] < LIMITS[name]


def test_slope_is_that_of_errors_that_mean_something_and_are_not_settled():
    rays = [2 ** exponent for exponent in range(6, 17)]
    law = [{"num_rays": count, "rms_db": 200.0 / count if count > 64 else 40.0} for count in rays]
    settled = [{**point, "rms_db": max(point["rms_db"], 0.006)} for point in law]
    assert _slope(settled, "rms_db") == pytest.approx(-1.0, abs=ROUNDING)
    assert _slope(law[:2], "rms_db") is None


def test_a_run_too_short_to_know_where_errors_converge_judges_no_slope():
    """The facets of a mesh leave an error that rays cannot mend: beside theory alone it would flatten the slope."""
    floor = [{"num_rays": 2 ** exponent, "rms_db": 0.3, "rms_from_converged_db": None} for exponent in (10, 11, 12)]
    target = {"title": "facets", "curves": {BEST: floor}, "slopes": {BEST: _slope(floor, "rms_db")},
              "slopes_from_converged": {BEST: _slope(floor, "rms_from_converged_db")}, "converged_db": None}
    assert target["slopes"][BEST] == pytest.approx(0.0, abs=ROUNDING)
    assert verdicts({"targets": dict.fromkeys(("sphere_161", "sphere_3228", "ellipsoid"), target), "plates": []}) == []


def test_filter_costs_plates_nothing():
    (pair,) = plate_pairs(5.0, [2 ** 14], 3)
    assert abs(pair["margin_db"]) < MARGIN * pair["unfiltered_db"] and pair["shifts"] == 6


@pytest.mark.parametrize("sampler", ["fibonacci", "r2", "random"])
def test_every_sampler_finds_the_dihedral(sampler):
    limit = 1.0 if sampler == "random" else MULTI_BOUNCE_DB  # shot noise of 2^14 independent rays
    assert _point(TARGETS["dihedral"], Variant("second_order", sampler), 2 ** 14, 3)["rms_db"] < limit


def test_sampler_is_checked_and_kept(tmp_path):
    scene = TARGETS["sphere_161"].scene
    with pytest.raises(ValueError, match="sampler: must be 'lattice', 'fibonacci', 'r2' or 'random', got 'sobol'"):
        ep.trace(scene, targets.radar(), num_rays=10, sampler="sobol")
    for sampler in ("lattice", "fibonacci", "r2", "random"):
        paths = ep.trace(scene, targets.radar(), num_rays=1000, sampler=sampler)
        assert paths.frame.sampler == sampler
        assert paths.frame.statistics.num_rays == 1000
        paths.save(tmp_path / "paths.h5")
        again = ep.Paths.load(tmp_path / "paths.h5")
        assert again.frame.sampler == sampler and np.array_equal(again.amplitude, paths.amplitude)


@pytest.mark.usefixtures("plain_pictures")
def test_command_writes_numbers_and_picture(tmp_path, capsys):
    assert main(["bench", "physics", "--out", str(tmp_path / "b"), "--quick", "--rays-max", "1024"]) == 0
    results = json.loads((tmp_path / "b" / "physics.json").read_text())
    assert (tmp_path / "b" / "physics.png").stat().st_size > 10_000
    assert set(results["targets"]) >= set(LIMITS)
    assert all(point["num_rays"] <= 1024 for target in results["targets"].values() for curve in target["curves"].values()
               for point in curve)
    printed = capsys.readouterr().out
    assert len((tmp_path / "b" / "costs.csv").read_text().splitlines()) == 1 + len(results["costs"])
    rows = (tmp_path / "b" / "physics.csv").read_text().splitlines()
    assert len(rows) == 1 + sum(len(curve) for target in results["targets"].values() for curve in target["curves"].values())
    sizes = {row["label"]: row["bytes_per_path"] for row in results["costs"]}
    assert sizes["second-order footprint"] == sizes["diffuse"] == sizes["all off"]  # a term that is off is not stored
    assert sizes["smooth"] == sizes["all off"] + 28 and sizes["jones"] == sizes["all off"] + 32
    assert "bytes per hit" in printed and "sphere, ka 161" in printed
    assert describe(results)[0] in printed


def test_pictures_show_all_that_is_measured(monkeypatch):
    """What took long, and errors beyond the scale, whose marks lie on its end."""
    drawn = []
    for module in (physics_figure, replay_figure):
        monkeypatch.setattr(module, "save_png", lambda figure, path, seed: drawn.append(figure))
    curve = [{"num_rays": 2 ** 10, "seconds": 1e-5, "rms_db": 1e-4}, {"num_rays": 2 ** 16, "seconds": 20.0, "rms_db": 1e-4}]
    target = {"title": "a target", "curves": {BEST: curve}}
    physics_figure.draw_physics({"targets": dict.fromkeys(physics_figure.SHOWN, target)}, None)
    variants = [{"label": "every chirp", "share_of_every_chirp": 0.5, "error_db": -3.0}]
    replay_figure.draw_replay({"cases": {"car": {"title": "car", "variants": variants}}, "apertures": []}, None)
    for axes in (*drawn[0].axes, drawn[1].axes[0]):
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        marks = [line for line in axes.lines if line.get_marker() in "v^so" and len(line.get_xdata())]
        assert len(marks) >= 2 and any(line.get_marker() in "v^" for line in marks)
        for line in marks:
            x, y = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
            assert np.all((left <= x) & (x <= right) & (low <= y) & (y <= high))
