"""Antenna tables: the closed forms they were sampled from, files and what is wrong with them."""
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from support.files.scene_text import WAVEFORM
from support.shapes import lambert

DATA = Path(__file__).resolve().parents[4] / "data" / "antennas"
INTERPOLATION = 2e-3      # of the peak: bicubics on steps of 5 degrees
WRITTEN = 2e-4            # relative: three decimals of dB
AZIMUTH = np.radians(np.arange(-90, 91, 5))
ELEVATION = np.radians(np.arange(-90, 91, 5))
FILE = "azimuth_deg,elevation_deg,gain_db,phase_deg\n" + "\n".join(
    f"{a},{e},{-0.1 * abs(a) + 0.02 * e},{a + 2 * e}" for a in (-10, 0, 20) for e in (-5, 5))
ROUNDING = 1e-12


def direction(azimuth, elevation):
    return np.stack([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation),
                     np.sin(elevation) + 0 * azimuth], axis=-1)


def cosine4(u):
    return 10.0 * np.maximum(u[..., 0], 0.0) ** 4


def grid():
    return direction(AZIMUTH[None, :], ELEVATION[:, None])


def fault_of(tmp_path, text):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(ep.FileError) as fault:
        ep.load_antenna(path)
    assert str(path) in str(fault.value)
    return str(fault.value)


def test_table_gives_the_gain_that_was_sampled():
    pattern = ep.GainTable(azimuth=AZIMUTH, elevation=ELEVATION, gain=cosine4(grid()))
    u = direction(np.radians([0, 12.5, -33.3, 71.0, 120.0]), np.radians([0, 7.5, -21.0, 44.4, 3.0]))
    np.testing.assert_allclose(np.abs(pattern.field(u)) ** 2, cosine4(u), atol=10 * INTERPOLATION)
    assert pattern.kind == "table" and pattern.peak_gain == pytest.approx(10.0)
    assert pattern.efficiency == pytest.approx(1.0, abs=INTERPOLATION)
    np.testing.assert_array_equal(pattern.azimuth, AZIMUTH)
    np.testing.assert_array_equal(pattern.table_gain, cosine4(grid()))
    assert pattern.table_phase is None
    with pytest.raises(ValueError, match="needs a direction"):
        pattern.gain(1.0)


@pytest.mark.parametrize("degrees", [30.0, -1.1, 1.001])
def test_gains_are_asked_for_by_cosines(degrees):
    for pattern in (ep.CosinePower(2.0), ep.Isotropic()):
        with pytest.raises(ValueError, match="^cos_boresight: must be a cosine, from -1 to 1, got "):
            pattern.gain(degrees)
        for rounded in (1.0 + 1e-15, 1.0 + 2e-6):  # as products of unit vectors of double and single precision may be
            assert pattern.gain(rounded) == pattern.gain(1.0)


def test_other_patterns_have_no_table():
    for pattern, efficiency in ((ep.Isotropic(0.5), 0.5), (ep.CosinePower(3.0), 1.0)):
        assert pattern.efficiency == pytest.approx(efficiency)
        assert pattern.azimuth is None and pattern.table_gain is None
    np.testing.assert_allclose(ep.CosinePower(2.0).field([[0.6, 0.8, 0.0]]), [np.sqrt(6 * 0.36)])


@pytest.mark.parametrize("azimuth_deg, elevation_deg", [(4, 4), (3, 10), (60, 10), (120, 30), (1, 0.5), (180, 180)])
def test_a_beam_known_by_its_widths_falls_to_half_at_half_of_them(azimuth_deg, elevation_deg):
    widths = np.radians([azimuth_deg, elevation_deg])
    beam = ep.GaussianBeam(azimuth=widths[0], elevation=widths[1])
    u, v = (array.ravel() for array in np.meshgrid(np.linspace(-0.9, 0.9, 13), np.linspace(-0.9, 0.9, 11)))
    angles = widths[:, None] * [u, v]
    is_ahead = np.all(np.abs(angles) < np.pi / 2, axis=0)
    azimuth, elevation = angles[:, is_ahead]
    toward = np.column_stack([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    expected = 0.5 ** ((2 * u) ** 2 + (2 * v) ** 2)[is_ahead]
    np.testing.assert_allclose(np.abs(beam.field(toward)) ** 2 / beam.peak_gain, expected, atol=1e-3)
    assert beam.efficiency == pytest.approx(1.0, abs=1e-12)
    if max(azimuth_deg, elevation_deg) <= 10:  # the integral over the plane
        assert beam.peak_gain == pytest.approx(16 * np.log(2) / np.prod(widths), rel=0.01)


def test_a_beam_with_losses_has_the_gain_that_is_told_and_none_behind():
    beam = ep.GaussianBeam(azimuth=1.2, elevation=0.3, peak_gain=10.0)
    assert beam.peak_gain == 10.0 and beam.efficiency < 1.0
    np.testing.assert_allclose(np.abs(beam.field([[1, 0, 0], [-1, 0, 0], [0, 0, 1]])) ** 2, [10.0, 0.0, 0.0], rtol=1e-12)
    for wrong in ({"azimuth": 0.0}, {"elevation": 3.2}, {"peak_gain": -1.0}):
        with pytest.raises(ValueError, match=f"^{next(iter(wrong))}: must be"):
            ep.GaussianBeam(**{"azimuth": 1.2, "elevation": 0.3, **wrong})


def test_more_gain_than_the_sphere_has_is_an_error():
    with pytest.raises(ValueError, match=r"^gain: must have a mean over the sphere of at most 1.02 \(0.09 dB\).*"
                                         r"normalize=True.*, got a mean of 1\.1\d* \(0\.41\d* dB\)"):
        ep.GainTable(azimuth=AZIMUTH, elevation=ELEVATION, gain=1.1 * cosine4(grid()))


def test_normalized_tables_have_a_mean_of_one():
    pattern = ep.GainTable(azimuth=AZIMUTH, elevation=ELEVATION, gain=123.0 * cosine4(grid()), normalize=True)
    assert pattern.efficiency == pytest.approx(1.0, abs=1e-12)
    assert pattern.peak_gain == pytest.approx(10.0, rel=2e-3)  # of cos^4: 2 (4 + 1)


def test_normalized_files_have_a_mean_of_one(tmp_path):
    """Of levels that are not known: 20 dB too much in all directions."""
    rows = [f"{np.degrees(a):.6f},{np.degrees(e):.6f},{10 * np.log10(max(100.0 * gain, 1e-30)):.9f}"
            for e, row in zip(ELEVATION, cosine4(grid())) for a, gain in zip(AZIMUTH, row)]
    (tmp_path / "loud.csv").write_text("\n".join(["azimuth_deg,elevation_deg,gain_db", *rows]))
    with pytest.raises(ep.FileError, match="loud.csv: gain: must have a mean over the sphere .* normalize=True"):
        ep.load_antenna(tmp_path / "loud.csv")
    pattern = ep.load_antenna(tmp_path / "loud.csv", normalize=True)
    assert pattern.peak_gain == pytest.approx(10.0, rel=2e-3)  # of cos^4: 2 (4 + 1)
    scene = WAVEFORM + """
[radar]
pattern = {kind = "table", file = "loud.csv", normalize = true}
transmitters = [{position = [0, 0, 0]}]
receivers = [{position = [0, 0, 0]}]
"""
    (tmp_path / "loud.toml").write_text(scene)
    loaded = ep.load_scene(tmp_path / "loud.toml").radar.receivers[0].pattern
    np.testing.assert_array_equal(loaded.table_gain, pattern.table_gain)
    (tmp_path / "loud.toml").write_text(scene.replace("true", "false"))
    with pytest.raises(ep.FileError, match="loud.csv: gain: must have a mean over the sphere"):
        ep.load_scene(tmp_path / "loud.toml")


def test_shapes_are_checked():
    with pytest.raises(ValueError, match="^gain: .*row for each elevation"):
        ep.GainTable(azimuth=AZIMUTH[:5], elevation=ELEVATION[:3], gain=np.ones((5, 3)))
    with pytest.raises(ValueError, match="^phase"):
        ep.GainTable(azimuth=AZIMUTH[:2], elevation=ELEVATION[:2], gain=np.ones((2, 2)), phase=np.ones((2, 3)))
    with pytest.raises(TypeError, match="'elevation'"):
        ep.GainTable(azimuth=AZIMUTH, elevation=ELEVATION, gain=cosine4(grid()), elevatoin=1)


def test_file_means_what_its_units_say(tmp_path):
    path = tmp_path / "small.csv"
    lines = FILE.splitlines()
    path.write_text("\n".join(["# a comment", lines[0], "", *reversed(lines[1:])]))  # rows in any order
    pattern = ep.load_antenna(str(path))
    np.testing.assert_allclose(np.degrees(pattern.azimuth), [-10, 0, 20])
    np.testing.assert_allclose(np.degrees(pattern.elevation), [-5, 5])
    np.testing.assert_allclose(10 * np.log10(pattern.table_gain), [[-1.1, -0.1, -2.1], [-0.9, 0.1, -1.9]], atol=ROUNDING)
    np.testing.assert_allclose(np.degrees(pattern.table_phase), [[-20, -10, 10], [0, 10, 30]], atol=ROUNDING)


@pytest.mark.parametrize("change, complaint", [
    (lambda text: "", "no line of column names"),
    (lambda text: text.replace("gain_db", "gain"), "line 1: column 'gain' is none of"),
    (lambda text: text.replace(",phase_deg", ",gain_db"), "line 1: column 'gain_db' stands twice"),
    (lambda text: text.replace("azimuth_deg,", "", 1), "line 1: column 'azimuth_deg' is missing"),
    (lambda text: text.splitlines()[0], "holds no directions"),
    (lambda text: text.replace("0,5,0.1", "0,5,x"), "line 5: gain_db must be a number, got 'x'"),
    (lambda text: text.replace("0,5,0.1", "0,nan,0.1"), "line 5: elevation_deg must be finite"),
    (lambda text: text.replace("0,5,0.1,10", "0,5,0.1"), "line 5: must have 4 values, has 3"),
    (lambda text: text.replace("0,5,0.1", "0,-5,0.1"), "line 5: direction (0, -5) deg stands already in line 4"),
    (lambda text: text.rsplit("\n", 1)[0], "direction (20, 5) deg is missing"),
    (lambda text: text.replace("0,5,0.1", "0,95,0.1"), "line 5: elevation_deg must lie in [-90, 90], got 95"),
    (lambda text: "\n".join(text.splitlines()[:2]), "azimuth_deg must have at least 2 values, got -10 alone"),
    (lambda text: "\n".join(text.splitlines()[:6:2]).replace(",5,", ",-5,"), "elevation_deg must have at least 2 values, got -5"),
    (lambda text: text.replace("\n20,", "\n355,"), "azimuth_deg must cover at most 360, got -10 to 355"),
    (lambda text: text.splitlines()[0] + "".join(f"\n{a},{e},3.1,0" for a in (-90, 90, 270) for e in (-90, 0, 90)),
     "gain: must have a mean over the sphere"),
])
def test_what_is_wrong_with_a_file_is_named_with_its_line(tmp_path, change, complaint):
    assert complaint in fault_of(tmp_path, change(FILE))


def test_a_byte_order_mark_is_no_part_of_the_first_column(tmp_path):
    text = "azimuth_deg,elevation_deg,gain_db\n" + "".join(f"{a},{e},0\n" for a in (-90, 90) for e in (-90, 90))
    (tmp_path / "antenna.csv").write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert ep.load_antenna(tmp_path / "antenna.csv").table_gain.shape == (2, 2)


def test_missing_file_is_a_file_error(tmp_path):
    with pytest.raises(ep.FileError, match="nowhere.csv"):
        ep.load_antenna(tmp_path / "nowhere.csv")


def test_example_patch_is_the_formula_in_its_head():
    pattern = ep.load_antenna(DATA / "patch_77ghz.csv")
    k = 2 * np.pi * 77e9 / ep.speed_of_light
    u = direction(pattern.azimuth[None, :], pattern.elevation[:, None])
    shape = (np.sinc(k * 0.688e-3 * u[..., 1] / np.pi) * np.cos(k * 0.565e-3 * u[..., 2])) ** 2 * (1 - u[..., 1] ** 2)
    scale = pattern.table_gain.max() / shape.max()
    np.testing.assert_allclose(pattern.table_gain, scale * shape, rtol=WRITTEN, atol=1e-9)
    assert pattern.efficiency == pytest.approx(0.8, abs=INTERPOLATION)


def test_table_survives_a_frame_file(tmp_path):
    tables = [ep.GainTable(azimuth=AZIMUTH, elevation=ELEVATION, gain=cosine4(grid()), phase=grid()[..., 1]),
              ep.load_antenna(DATA / "patch_77ghz.csv")]
    receivers = [ep.Antenna((0, 0.002 * i, 0), pattern=pattern)
                 for i, pattern in enumerate([tables[0], ep.Isotropic(0.5), tables[1], tables[0]])]
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=lambert(0.27), position=(5, 0, 0))
    waveform = ep.ChirpSequence(num_chirps=2)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna(pattern=tables[1])], receivers=receivers)
    paths = ep.trace(scene, radar, num_rays=1000)
    paths.save(tmp_path / "paths.h5")
    back = ep.Paths.load(tmp_path / "paths.h5")
    for one, other in zip([*radar.transmitters, *receivers], [*back.radar.transmitters, *back.radar.receivers]):
        assert one.pattern.kind == other.pattern.kind
        for name in ("azimuth", "elevation", "table_gain", "table_phase"):
            np.testing.assert_array_equal(getattr(one.pattern, name), getattr(other.pattern, name))
    for rx in range(4):
        np.testing.assert_array_equal(paths.amplitudes([0.0], 0, rx), back.amplitudes([0.0], 0, rx))


def test_scene_file_finds_the_table_beside_it(tmp_path):
    (tmp_path / "small.csv").write_text(FILE)
    text = """
[radar]
pattern = {kind = "table", file = "small.csv"}
""" + WAVEFORM + """\
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
pattern = {kind = "isotropic"}
"""
    (tmp_path / "scene.toml").write_text(text)
    radar = ep.load_scene(tmp_path / "scene.toml").radar
    assert (radar.transmitters[0].pattern.kind, radar.receivers[0].pattern.kind) == ("table", "isotropic")
    assert radar.transmitters[0].pattern.table_gain.shape == (2, 3)
    (tmp_path / "scene.toml").write_text(text.replace("file", "path"))
    with pytest.raises(ValueError, match="file"):
        ep.load_scene(tmp_path / "scene.toml")
