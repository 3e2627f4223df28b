"""Antenna patterns from field solvers and of two cuts: the closed forms they were sampled from, and what is wrong with them."""
import numpy as np
import pytest

import echopath as ep
from support.files.scene_text import WAVEFORM

INTERPOLATION = 2e-3  # of the peak: bicubics twice, on steps of 5 degrees and of half as much
PLANE = 1e-3          # relative: losses with three decimals, of steps of one degree
AXES = {"x": (0, 1, 2), "y": (1, 2, 0), "z": (2, 0, 1)}  # of the file: ahead, left and up
OFFSET = np.array([0.2, -0.3, 0.4])  # rad: of the phase along the file's axes
RNG = np.random.default_rng(5)
TOWARD = (lambda u: u / np.linalg.norm(u, axis=1, keepdims=True))(RNG.normal(size=(500, 3)))


def gain(u):
    """A beam ahead, more to the left than to the right and more up than down, in front alone."""
    return 6.0 * np.maximum(u[..., 0], 0.0) ** 3 * (1.0 + 0.4 * u[..., 1] + 0.3 * u[..., 2]) * np.exp(-0.5 * u[..., 1] ** 2)


def in_file(theta_deg, phi_deg):
    theta, phi = np.radians(theta_deg), np.radians(phi_deg)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def samples(boresight, thetas=range(0, 181, 5), phis=range(0, 360, 5)):
    """(theta, phi, gain) in the axes of a file."""
    return [(theta, phi, gain(in_file(theta, phi)[list(AXES[boresight])])) for phi in phis for theta in thetas]


def db(value):
    return 10.0 * np.log10(max(value, 1e-30))


def own(rows):
    return "\n".join(["# of ours", "theta_deg,phi_deg,gain_db", *(f"{t},{p},{db(g):.6f}" for t, p, g in rows)])


def hfss(rows):
    head = '"Freq [GHz]","Phi [deg]","Theta [deg]","dB(RealizedGainTotal) [] - Freq=\'77GHz\'"'
    return "\n".join([head, *(f"77,{p},{t},{db(g):.6f}" for t, p, g in rows)])


def hfss_linear(rows):
    return "\n".join(["Phi[deg],Theta[deg],mag(GainTotal)[]", *(f"{p},{t},{g:.9e}" for t, p, g in rows)])


def cst(rows, quantity="Abs(Gain)[dBi   ]", value=lambda g: f"{db(g):.3e}"):
    head = (f"Theta [deg.]  Phi   [deg.]  {quantity}   Abs(Theta)[dBi   ]  Phase(Theta)[deg.]  Abs(Phi  )[dBi   ]  "
            "Phase(Phi  )[deg.]  Ax.Ratio[dB    ]    ")
    return "\n".join([head, "-" * 120, *(f"{t:8.3f} {p:8.3f}  {value(g)}  -3.0 10.0 -40.0 20.0 40.0" for t, p, g in rows)])


def cst_linear(rows):
    return cst(rows, "Abs(Grlz)[      ]", lambda g: f"{g:.3e}")


def feko(rows):
    head = ["##File Type: Far Field", "##File Format: 3", "", "#Request Name: FarField1", "#Frequency: 7.7E+010",
            "#Result Type: Gain", '#  "Theta"  "Phi"  "Re(Etheta)"  "Im(Etheta)"  "Gain(Theta)"  "Gain(Phi)"  "Gain(Total)"']
    return "\n".join([*head, *(f"  {t:.8E} {p:.8E} 0.1 0.2 -3.0 -40.0 {db(g):.8E}" for t, p, g in rows)])


def semicolons_in_radians(rows):
    return "\n".join(["Theta [rad]; Phi [rad]; Gain (dBi)",
                      *(f"{np.radians(t):.12f};{np.radians(p):.12f};{db(g):.6f}" for t, p, g in rows)])


KINDS = [own, hfss, hfss_linear, cst, cst_linear, feko, semicolons_in_radians]


def loaded(tmp_path, text, **options):
    (tmp_path / "antenna.txt").write_text(text)
    return ep.load_antenna(tmp_path / "antenna.txt", **options)


def fault_of(tmp_path, text):
    with pytest.raises(ep.FileError) as fault:
        loaded(tmp_path, text)
    assert str(fault.value).startswith(f"{tmp_path / 'antenna.txt'}: ")
    return str(fault.value)


def assert_is_the_beam(pattern):
    np.testing.assert_allclose(np.abs(pattern.field(TOWARD)) ** 2, gain(TOWARD), atol=6.0 * INTERPOLATION)


@pytest.mark.parametrize("kind", KINDS)
def test_files_of_solvers_give_the_gain_that_was_sampled(tmp_path, kind):
    assert_is_the_beam(loaded(tmp_path, kind(samples("z"))))


@pytest.mark.parametrize("boresight", AXES)
def test_any_axis_of_a_file_may_look_ahead(tmp_path, boresight):
    assert_is_the_beam(loaded(tmp_path, own(samples(boresight)), boresight=boresight))


@pytest.mark.parametrize("rows", [
    samples("z", range(-180, 181, 5), range(0, 180, 5)),            # negative theta: on the other side
    samples("z", range(-180, 181, 5), range(-90, 91, 5)),           # with both ends of phi
    samples("z", phis=range(-180, 181, 5)),                         # the whole turn with both of its ends
    [*samples("z", range(5, 180, 5)), (0, 0, gain(np.array([1, 0, 0]))), (180, 0, 0.0)],  # poles that stand once
])
def test_directions_may_be_told_in_other_ways(tmp_path, rows):
    assert_is_the_beam(loaded(tmp_path, hfss(rows)))


@pytest.mark.parametrize("digits", [4, 5, 7])
def test_quarter_turns_in_radians_may_be_rounded(tmp_path, digits):
    rows = ["Theta [rad],Phi [rad],Gain [dBi]"]
    rows += [f"{np.radians(t):.{digits}f},{np.radians(p):.{digits}f},{db(g):.6f}"
             for t, p, g in samples("z", phis=range(0, 361, 5))]
    assert_is_the_beam(loaded(tmp_path, "\n".join(rows)))


def test_comments_above_a_table_may_name_its_angles(tmp_path):
    table = "azimuth_deg,elevation_deg,gain_db\n-9,-9,1\n-9,9,1\n9,-9,1\n9,9,1"
    for comment in ("# azimuth, elevation, gain", "# azimuth and elevation in degrees", "# elevation_deg,azimuth_deg,gain_db"):
        np.testing.assert_array_equal(loaded(tmp_path, f"{comment}\n{table}").table_gain, loaded(tmp_path, table).table_gain)


def test_directions_that_stand_twice_agree_as_fields(tmp_path):
    """Phases half a turn apart by their sign, and nulls that differ by what nobody receives."""
    rows = ["theta_deg,phi_deg,gain_db,phase_deg"]
    rows += [f"{t},{p},{db(g) - (0.1 if p == 360 and g < 1e-8 else 0):.2f},{-180 if p == 360 else 180}"
             for t, p, g in samples("z", phis=range(0, 361, 5))]
    assert loaded(tmp_path, "\n".join(rows)).peak_gain == pytest.approx(6.2, abs=0.1)


def test_old_encodings_of_comments_do_not_matter(tmp_path):
    (tmp_path / "antenna.msi").write_bytes(planet("3.5 dBi").replace("NAME beam", "NAME beam \xb145\xb0").encode("latin-1"))
    assert ep.load_antenna(tmp_path / "antenna.msi").peak_gain == pytest.approx(10.0 ** 0.35, rel=0.01)


def test_a_first_word_does_not_make_a_table_a_cut(tmp_path):
    assert_is_the_beam(loaded(tmp_path, "# Horizontal\n" + own(samples("z"))))
    assert "line 1: column" in fault_of(tmp_path, "Vertical polarisation of a patch\n1 2")


def test_phases_turn_with_the_axes(tmp_path):
    """Of an element off the origin of the file, whose phase is that of its way."""
    rows = ["theta_deg,phi_deg,gain_db,phase_deg"]
    rows += [f"{t},{p},{db(g):.6f},{np.degrees(OFFSET @ in_file(t, p)):.6f}" for t, p, g in samples("z")]
    field = loaded(tmp_path, "\n".join(rows)).field(TOWARD)
    of_file = TOWARD[:, [1, 2, 0]]  # left is x, up is y, ahead is z
    np.testing.assert_allclose(field, np.sqrt(gain(TOWARD)) * np.exp(1j * of_file @ OFFSET), atol=5.0 * INTERPOLATION)


def test_directivity_has_a_mean_of_one_at_most(tmp_path):
    """Solvers miss some of the radiated power, so that what they write may have more; what has less is left."""
    assert loaded(tmp_path, cst(samples("z"), "Abs(Dir.)[dBi   ]")).peak_gain == pytest.approx(
        loaded(tmp_path, cst(samples("z"))).peak_gain)
    louder = [(theta, phi, 2.0 * g) for theta, phi, g in samples("z")]
    assert loaded(tmp_path, cst(louder, "Abs(Dir.)[dBi   ]")).efficiency == pytest.approx(1.0, abs=1e-3)
    assert "gain: must have a mean over the sphere of at most 1.02" in fault_of(tmp_path, cst(louder))


def test_a_beam_beside_the_boresight_is_warned_of(tmp_path):
    with pytest.warns(RuntimeWarning, match=r"load_antenna: the power of the pattern goes 8\d degrees off the boresight"):
        loaded(tmp_path, own(samples("z")), boresight="x")
    with pytest.warns(RuntimeWarning, match="load_antenna: the power of the pattern goes"):
        loaded(tmp_path, own(samples("x")))


def test_scene_files_name_the_axis(tmp_path):
    (tmp_path / "beam.csv").write_text(own(samples("y")))
    text = WAVEFORM + """
[radar]
pattern = {kind = "table", file = "beam.csv", boresight = "y"}
transmitters = [{position = [0, 0, 0]}]
receivers = [{position = [0, 0, 0]}]
"""
    (tmp_path / "scene.toml").write_text(text)
    assert_is_the_beam(ep.load_scene(tmp_path / "scene.toml").radar.receivers[0].pattern)


@pytest.mark.parametrize("text", ["azimuth_deg,elevation_deg,gain_db\n-9,-9,1\n-9,9,1\n9,-9,1\n9,9,1",
                                  "GAIN 1 dBi\nHORIZONTAL 2\n0 0\n180 3\nVERTICAL 2\n0 0\n180 3"])
def test_what_counts_from_the_boresight_has_no_other_axis(tmp_path, text):
    with pytest.raises(ValueError, match="^boresight: must be left out for .*antenna.txt, whose angles count from .*, got 'z'"):
        loaded(tmp_path, text, boresight="z")
    with pytest.raises(ValueError, match="^boresight: must be 'x', 'y' or 'z', got 'w'"):
        loaded(tmp_path, text, boresight="w")


@pytest.mark.parametrize("change, complaint", [
    (lambda text: text.replace("Abs(Gain)[dBi   ]", "Abs(E   )[V/m   ]"), "line 1: column 'gain_db' is missing"),
    (lambda text: text.replace("Abs(Theta)[dBi   ]", "Abs(Dir.)[dBi   ]"),
     "line 1: column 'Abs(Dir.)[dBi   ]' is a second one beside 'Abs(Gain)[dBi   ]'"),
    (lambda text: text.replace("Phi   [deg.]", "Psi   [deg.]"), "line 1: column 'phi_deg' is missing"),
    (lambda text: text + "\n   0.000    0.000  9.000e+00  0 0 0 0 0", "line 2667: direction (0, 0) deg stands already in line 3 "
     "with another gain; a file holds one pattern, at one frequency"),
    (lambda text: text.rsplit("\n", 2)[0], "direction (355, 175) deg is missing; every phi needs every theta"),
    (lambda text: text + "\n 185.0 0.0 1 0 0 0 0 0", "line 2667: theta must lie in [-180, 180] deg, got 185"),
    (lambda text: text + "\n 5.0 0.0 1", "line 2667: must have 8 values, has 3"),
    (lambda text: "\n".join(text.splitlines()[:39]), "phi_deg must have at least 2 values, got 0 alone"),
])
def test_what_is_wrong_with_a_solvers_file_is_named(tmp_path, change, complaint):
    assert complaint in fault_of(tmp_path, change(cst(samples("z"))))


def loss_across(azimuth_deg):
    """dB, of a beam 20 degrees to the left that is 30 dB lower behind."""
    return 15.0 * (1.0 - np.cos(np.radians(azimuth_deg - 20.0)))


def loss_along(angle_deg):
    """dB, at the azimuth of the beam: 0 at 4 degrees below the horizon, narrower, and 30 at as many behind."""
    angle, tilt = np.radians(angle_deg), np.radians(4.0)
    return (30.0 * np.sin(0.5 * (angle - tilt)) ** 2 / np.sin(0.5 * np.pi - tilt) ** 2
            + 12.0 * (np.sin(angle) - np.sin(tilt)) ** 2)


def planet(gain_text):
    lines = ["NAME beam", "FREQUENCY 24125", f"GAIN {gain_text}", "TILT ELECTRICAL", "HORIZONTAL 360"]
    lines += [f"{angle}\t{loss_across(-angle):.3f}" for angle in range(360)]  # clockwise from above
    lines += ["VERTICAL 360", *(f"{angle:.1f} {loss_along(angle):.3f}" for angle in range(360))]  # downward from ahead
    return "\n".join(lines)


@pytest.mark.parametrize("gain_text, dbi", [("3.5 dBi", 3.5), ("1.35 dBd", 3.5), ("1.35", 3.5)])
def test_cuts_are_exact_in_both_planes(tmp_path, gain_text, dbi):
    pattern, angle = loaded(tmp_path, planet(gain_text)), np.radians(np.arange(-179.5, 180.0))
    tilt, left = np.radians(-4.0), np.radians(20.0)
    across = np.column_stack([np.cos(tilt) * np.cos(angle), np.cos(tilt) * np.sin(angle), np.full(len(angle), np.sin(tilt))])
    expected = 10.0 ** (0.1 * (dbi - loss_across(np.degrees(angle))))
    np.testing.assert_allclose(np.abs(pattern.field(across)) ** 2, expected, rtol=PLANE)
    along = np.column_stack([np.cos(angle) * np.cos(left), np.cos(angle) * np.sin(left), np.sin(angle)])
    expected = 10.0 ** (0.1 * (dbi - loss_along(-np.degrees(angle))))
    np.testing.assert_allclose(np.abs(pattern.field(along)) ** 2, expected, rtol=PLANE)
    assert loaded(tmp_path, planet(gain_text), normalize=True).efficiency == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("behind_db", [20.0, 30.0, 60.0])
def test_cuts_with_little_behind_stay_below_their_gain(tmp_path, behind_db):
    """A cardioid, all of whose cuts are alike: what the cut lacks behind does not come up above or below."""
    lines = ["GAIN 4.77 dBi"]
    for name in ("HORIZONTAL", "VERTICAL"):
        lines.append(f"{name} 360")
        lines += [f"{angle} {min(-20 * np.log10(max(0.5 + 0.5 * np.cos(np.radians(angle)), 1e-9)), behind_db):.3f}"
                  for angle in range(360)]
    pattern = loaded(tmp_path, "\n".join(lines))
    gains = np.abs(pattern.field(TOWARD)) ** 2
    assert gains.max() < 10.0 ** 0.477 * 1.01
    up_and_down = np.abs(pattern.field([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])) ** 2
    np.testing.assert_allclose(up_and_down, 0.25 * 10.0 ** 0.477, rtol=0.01)  # the root of the gain is half of its peak
    cardioid = 10.0 ** 0.477 * (0.5 + 0.5 * TOWARD[:, 0]) ** 2
    lit = TOWARD[:, 0] > -0.5
    assert np.max(np.abs(10.0 * np.log10(gains[lit] / cardioid[lit]))) < 2.0  # dB


@pytest.mark.parametrize("change, complaint", [
    (lambda text: text.replace("GAIN 3 dBi\n", ""), "holds no line GAIN, such as GAIN 12.5 dBi"),
    (lambda text: text.replace("3 dBi", "3 dBm"), "line 3: GAIN must be a number with dBd, as where it says nothing, or dBi"),
    (lambda text: text.replace("VERTICAL 360", "COMMENT 360"), "holds no cut VERTICAL; one cut makes no pattern"),
    (lambda text: text.replace("VERTICAL 360", "VERTICAL"), "line 366: VERTICAL must have the number of its lines, at least 2"),
    (lambda text: text.replace("HORIZONTAL 360", "HORIZONTAL 361"),
     "line 366: must have an angle and a loss, got 'VERTICAL 360'; HORIZONTAL has 361 lines"),
    (lambda text: text.rsplit("\n", 1)[0], "line 366: VERTICAL must have 360 lines, has 359"),
    (lambda text: text.replace("\n7.0 0.", "\n7.0 nan\n7.5 0."), "line 374: angle and loss must be finite, got '7.0 nan'"),
    (lambda text: text.replace("GAIN 3 dBi", "GAIN 19 dBi"), "gain: must have a mean over the sphere of at most 1.02"),
])
def test_what_is_wrong_with_cuts_is_named(tmp_path, change, complaint):
    assert complaint in fault_of(tmp_path, change(planet("3 dBi")))
