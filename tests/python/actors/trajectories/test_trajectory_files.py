"""Trajectories of files: tables, SUMO's floating car data, GPX; what is wrong is refused by file and line."""
import gzip
import math
import re
import warnings
from fractions import Fraction
from time import tzset

import numpy as np
import pytest

import echopath as ep
from echopath.trajectories.files import geodesy
from echopath.trajectories.files.geodesy import east_north_up
from echopath.trajectories.files.smoothing import _solved, smoothed
from support.files.floating_car_data import FCD

GPX = """<?xml version="1.0"?><gpx version="1.1"><metadata><name>all</name></metadata><trk><name>ride</name><trkseg>
<trkpt lat="46.017" lon="7.750"><ele>1673</ele><time>2026-05-01T12:00:00Z</time></trkpt>
<trkpt lat="46.0171" lon="7.750"><ele>1673</ele><time>2026-05-01T14:00:05+02:00</time></trkpt></trkseg></trk></gpx>
"""


def write(folder, name, text):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("kind", ["truck", "trailer", "bus", "coach", "tram", "delivery", "van", "motorcycle", "bicycle",
                                  "passenger"])
def test_vehicles_of_sumo_have_their_fronts_where_the_file_has_them(tmp_path, kind):
    fcd = FCD.replace('type="passenger"', f'type="{kind}"').replace('id="once"', 'id="flow/0"')
    others = ("south", "walker", 'y="0.00" angle="0')
    fcd = "\n".join(line for line in fcd.splitlines() if not any(words in line for words in others))
    scene = ep.Scene()
    (name,) = ep.add_traffic(scene, ep.read_trajectories(write(tmp_path, "fcd.xml", fcd)))
    fronts = [scene.world_vertices(mesh.id, 1.0)[:, 0].max() for mesh in scene.meshes if mesh.name.startswith(name)]
    assert max(fronts) == pytest.approx(20.0, abs=0.05)


@pytest.mark.filterwarnings("ignore:.*single position")
def test_packed_files_of_sumo_are_read_as_the_same_files(tmp_path):
    plain, packed = write(tmp_path, "fcd.xml", FCD), tmp_path / "fcd.xml.gz"
    packed.write_bytes(gzip.compress(FCD.encode()))
    expected, found = ep.read_trajectories(plain), ep.read_trajectories(packed)
    assert list(found) == list(expected) and all(found[name] == expected[name] for name in found)
    for content, told in ((b"no gzip at all", "cannot be read"), (packed.read_bytes()[:-40], "cannot be read|is no XML"),
                          (packed.read_bytes()[:60] + b"\xff" * 60, "cannot be read|is no XML")):
        packed.write_bytes(content)
        with pytest.raises(ep.FileError, match=f"fcd.xml.gz.*({told})"):
            ep.read_trajectories(packed)


def test_what_unpacks_to_more_than_files_may_hold_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("echopath.base.storage.markup.MAX_BYTES", 1000)
    (tmp_path / "fcd.xml.gz").write_bytes(gzip.compress(b"<fcd-export>" + b" " * 100_000 + b"</fcd-export>"))
    with pytest.raises(ep.FileError, match="is larger than 1000 bytes"):
        ep.read_trajectories(tmp_path / "fcd.xml.gz")


def test_vehicles_of_sumo_are_half_their_length_behind_their_bumpers(tmp_path):
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", FCD), vehicle_length={"truck": 16.5})
    assert {name: one.kind for name, one in found.items()} == {"flow/0": "passenger", "walker": "pedestrian", "south": "truck"}
    np.testing.assert_allclose(found["flow/0"].position([0.0, 1.5]), [[7.85, 0, 0], [22.85, 0, 0]], atol=1e-9)  # of a compact car
    np.testing.assert_allclose(found["south"].position(2.0), [50, 32 + 8.25, 0], atol=1e-9)
    np.testing.assert_allclose(found["walker"].position(1.0), [3, 5, 0], atol=1e-9)
    assert [one.yaw(1.0) for one in found.values()] == pytest.approx([0.0, np.pi / 2, -np.pi / 2])
    assert (found["south"].begin, found["south"].end, float(found["south"].speed(1.5))) == pytest.approx((1.0, 2.0, 8.0))


@pytest.mark.filterwarnings("ignore:.*single position")
def test_lengths_of_types_that_the_file_lacks_are_told(tmp_path):
    path = write(tmp_path, "fcd.xml", FCD)
    assert ep.read_trajectories(path, vehicle_length={"TRUCK": 16.5, "p*": 4.3})["flow/0"].kind == "passenger"
    with pytest.warns(RuntimeWarning, match=r"^vehicle_length: lorry, truck_\* take none of the kinds passenger, ped.*, truck"):
        ep.read_trajectories(path, vehicle_length={"truck": 16.5, "lorry": 7.1, "truck_*": 7.1})


def test_objects_with_a_single_position_are_left_out_with_a_word(tmp_path):
    with pytest.warns(RuntimeWarning, match="1 object with a single position is left out, such as 'once'"):
        ep.read_trajectories(write(tmp_path, "fcd.xml", FCD))


def test_a_table_gives_back_what_was_written(tmp_path):
    times, rng = np.arange(12) * 0.1, np.random.default_rng(1)
    rows = [(name, float(time), *map(float, place)) for name in ("a", "b") for time, place in
            zip(times, np.cumsum(rng.uniform(0.5, 1.0, (12, 3)), axis=0))]
    text = "frame,Timestamp [s],Track_ID,X (m),Y (m),z,type\n" + "".join(
        f"9,{time!r},{name},{x!r},{y!r},{z!r},car\n" for name, time, x, y, z in rows)
    found = ep.read_trajectories(write(tmp_path, "drive.csv", text))
    for name, time, *place in rows:
        np.testing.assert_allclose(found[name].position(time), place, atol=1e-12)
    assert list(found) == ["a", "b"] and found["b"].kind == "car"


def test_yaw_and_speed_of_a_table_are_kept(tmp_path):
    text = "# made by hand\nt;x;y;yaw_deg;speed\n\n0;0;0;10;3\n1;4;0;20;5\n2;8;0;30;3\n"
    (one,) = ep.read_trajectories(write(tmp_path, "drive.csv", text)).values()
    np.testing.assert_allclose(np.degrees(one.yaw([0, 1, 2])), [10, 20, 30])
    np.testing.assert_allclose(one.speed([0, 1, 2]), [3, 5, 3])


@pytest.mark.parametrize("between", [";", "\t"])
def test_decimal_commas_are_read_where_no_comma_stands_between_values(tmp_path, between):
    rows = [["time", "id", "x", "y", "speed"], ["0,0", "car 1,5", "-1,25", "2", "4,5e0"], ["0,5", "car 1,5", "1", ",25", "4,5"]]
    text = "\n".join(between.join(row) for row in rows) + "\n"
    own = ep.read_trajectories(write(tmp_path, "comma.csv", text))
    point = text.replace("1,5", "one").replace(",", ".").replace("one", "1,5")
    other = ep.read_trajectories(write(tmp_path, "point.csv", point))
    assert list(own) == list(other) == ["car 1,5"]
    for time in (0.0, 0.2, 0.5):
        assert np.array_equal(own["car 1,5"].position(time), other["car 1,5"].position(time))
    assert own["car 1,5"].position(0.0)[:2] == pytest.approx([-1.25, 2.0])
    for line, bad in ((2, text.replace("-1,25", "1.234,5")), (3, text.replace("0,5", "0.5"))):
        with pytest.raises(ep.FileError, match=f"line {line}: numbers must have decimal points or decimal commas"):
            ep.read_trajectories(write(tmp_path, "both.csv", bad))


def test_units_in_brackets_are_taken(tmp_path):
    """10 m/s straight on along y, 36 km/h, in the units of others; the other file has the same in those of ours."""
    names = "t [ms],x (cm),y [mm],z (ft),yaw (\u00b0),speed [km/h]\n"
    (one,) = ep.read_trajectories(write(tmp_path, "a.csv", names + "0,150,0,10,90,36\n500,150,5000,10,90,36\n")).values()
    (same,) = ep.read_trajectories(write(tmp_path, "b.csv", "t [s],x [m],y [m],z [m],yaw [rad],speed [m/s]\n"
                                         "0,1.5,0,3.048,1.5707963267948966,10\n.5,1.5,5,3.048,1.5707963267948966,10\n")).values()
    assert (one.begin, one.end) == (0.0, 0.5)
    np.testing.assert_allclose(one.position([0.0, 0.25, 0.5]), [[1.5, 0, 3.048], [1.5, 2.5, 3.048], [1.5, 5, 3.048]], atol=1e-9)
    np.testing.assert_allclose(one.position(0.3), same.position(0.3), atol=1e-9)
    np.testing.assert_allclose([one.speed(0.2), one.yaw(0.2)], [10.0, np.pi / 2], atol=1e-9)
    days = "t [us],x,y\n1767225600000000,0,0\n1767225601500000,1,0\n"
    (since_1970,) = ep.read_trajectories(write(tmp_path, "c.csv", days)).values()
    assert (since_1970.begin, since_1970.end) == pytest.approx((0.0, 1.5))


@pytest.mark.parametrize("unit, told", [("m/s", "20"), ("km/h", "72"), ("mph", "44.73873"), ("knots", "38.87689")])
def test_speeds_of_20_metres_a_second_may_be_in_any_unit(tmp_path, unit, told):
    """A mile is 1609.344 m and a nautical one 1852 m."""
    rows = f"t [s],x,y,speed [{unit}]\n0,0,0,{told}\n1,20,0,{told}\n3,60,0,{told}\n"
    (one,) = ep.read_trajectories(write(tmp_path, "a.csv", rows)).values()
    assert one.speed([0.0, 1.0]) == pytest.approx([20.0, 20.0], rel=1e-6)


@pytest.mark.parametrize("columns, rows, words", [
    ("time,x,y,speed", "0,0,0,36\n1,10,0,36\n2,20,0,36\n", "'a' goes 72 m by its speeds and 20 m by its positions"),
    ("time,x,y,yaw", "0,0,0,90\n1,0,10,90\n2,0,20,90\n", "'a' has a yaw of up to 90 rad, .*call the column yaw_deg"),
    ("time,x,y,yaw", "0,0,0,-2\n1,10,0.1,1\n2,20,0.4,2\n3,30,0.9,4\n", "'a' has a yaw of up to 4 rad, .*call the column yaw_"),
    ("time,x,y,yaw_deg", "0,0,0,80\n1,10,1,90\n2,20,1,95\n3,30,0,100\n", "'a' has yaws .* clockwise from [+]y, as from north"),
    ("time,x,y,yaw_deg", "0,0,0,105\n1,9.66,-2.59,105\n2,19.32,-5.18,105\n", "'a' has yaws .* clockwise from [+]y, as from no"),
    ("time,x,y,yaw_deg", "0,0,0,0\n1,9,2,-30\n2,15,9,-70\n3,16,18,-90\n", "'a' has yaws .* clockwise from [+]x;")])
def test_columns_that_the_positions_contradict_are_told(tmp_path, columns, rows, words):
    with pytest.warns(RuntimeWarning, match=words):
        ep.read_trajectories(write(tmp_path, "a.csv", f"{columns}\n{rows}"))


@pytest.mark.filterwarnings("error")
def test_columns_that_the_positions_bear_out_are_taken_without_a_word(tmp_path):
    """Two turns of a circle of 10 m, yaws without jumps; stop and go, whose speeds tell nothing of the way between rows."""
    turns = np.linspace(0.0, 4 * np.pi, 41)
    circle = [(t, 10 * math.sin(t), -10 * math.cos(t), t, 10.0) for t in turns.tolist()]
    rows = "".join(f"{','.join(map(repr, row))}\n" for row in circle)
    ep.read_trajectories(write(tmp_path, "a.csv", f"time,x,y,yaw,speed\n{rows}"))
    ep.read_trajectories(write(tmp_path, "a.csv", "time,x,y,speed\n0,0,0,0\n9,60,0,0\n18,120,0,0\n"))
    backs_up, wraps = "0,0,0,3.14\n1,5,0,3.14\n2,9,0,3.14\n", "0,0,0,3.1\n1,-5,0,-3.1\n2,-9,0,3.14\n3,-14,0,-3.1\n"
    for rows in (backs_up, wraps):
        ep.read_trajectories(write(tmp_path, "a.csv", f"time,x,y,yaw\n{rows}"))


def test_times_since_1970_count_from_the_first_of_all_objects(tmp_path):
    rows = "t,x,y,id\n1767225600,0,0,a\n1767225602,9,0,a\n1767225601.5,0,5,b\n1767225604,9,5,b\n"
    found = ep.read_trajectories(write(tmp_path, "a.csv", rows))
    assert [(one.begin, one.end) for one in found.values()] == [(0.0, 2.0), (1.5, 4.0)]


def test_times_of_no_zone_are_those_of_greenwich_wherever_they_are_read(tmp_path, monkeypatch):
    rows = "time,x,y\n2026-05-01T12:00:00,0,0\n2026-05-01T12:00:01Z,9,0\n2026-05-01T14:00:02+02:00,18,0\n"
    try:
        with monkeypatch.context() as patch:
            patch.setenv("TZ", "America/New_York")
            tzset()
            (one,) = ep.read_trajectories(write(tmp_path, "a.csv", rows)).values()
    finally:
        tzset()
    assert one.end == 2.0 and one.position(1.0)[0] == pytest.approx(9.0)


def test_a_file_that_is_placed_turns_its_yaws_too(tmp_path):
    """What slides along +x of the file and looks to the left of that: by 0.5 rad more in the world."""
    path = write(tmp_path, "a.csv", "t,x,y,yaw\n0,0,0,0.3\n1,10,0,0.3\n2,20,0,0.3\n")
    (one,) = ep.read_trajectories(path, position=(1, 2, 3), yaw=0.5).values()
    assert one.yaw(1.0) == pytest.approx(0.8)
    np.testing.assert_allclose(one.position(1.0), [1 + 10 * np.cos(0.5), 2 + 10 * np.sin(0.5), 3], atol=1e-9)


@pytest.mark.parametrize("during, is_there", [
    ((-2.0, -0.1), False), ((-2.0, 0.0), True), ((2.0, 5.0), True), ((2.1, 5.0), False)])
def test_who_is_there_at_an_end_of_a_span_is_on_the_way(tmp_path, during, is_there):
    path = write(tmp_path, "a.csv", "t,x,y,id\n0,0,0,a\n2,20,0,a\n-9,0,9,b\n9,20,9,b\n")
    assert ("a" in ep.read_trajectories(path, during=during)) == is_there


def test_the_ellipsoid_is_that_of_wgs_84():
    """Its eccentricity and minor axis as NIMA TR8350.2 has them, and the metres of a degree at the equator and at the poles."""
    assert geodesy.SQUARED_ECCENTRICITY == pytest.approx(6.69437999014e-3, rel=1e-11)
    assert geodesy.SEMI_MAJOR_AXIS * math.sqrt(1.0 - geodesy.SQUARED_ECCENTRICITY) == pytest.approx(6356752.3142, abs=1e-4)
    for latitude, metres in ((0.0, 110574.3), (89.0, 111693.8)):
        step = east_north_up(np.array([latitude + 0.5]), np.array([7.0]), np.zeros(1), (latitude - 0.5, 7.0, 0.0))[0]
        assert np.hypot(step[1], step[2]) * np.radians(0.5) / np.sin(np.radians(0.5)) == pytest.approx(metres, rel=2e-5)


def test_east_north_up_is_that_of_published_examples():
    """MathWorks, documentation of geodetic2enu (the Matterhorn from Zermatt); Octave Forge, the same function."""
    matterhorn = east_north_up(np.array([45.976]), np.array([7.658]), np.array([4531.0]), (46.017, 7.750, 1673.0))
    np.testing.assert_allclose(matterhorn, [[-7134.8, -4556.3, 2852.4]], atol=0.05)
    near = east_north_up(np.array([42.002]), np.array([-81.998]), np.array([1000.0]), (42.0, -82.0, 200.0))
    np.testing.assert_allclose(near, [[165.72, 222.18, 799.99]], atol=0.005)


def test_places_on_the_earth_become_metres(tmp_path):
    """A ten-thousandth of a degree of latitude at 46 degrees is 11.1144 m (meridian arc), and 1673 m up a little more."""
    (one,) = ep.read_trajectories(write(tmp_path, "ride.gpx", GPX)).values()
    assert (one.begin, one.end) == (0.0, 5.0)
    np.testing.assert_allclose(one.position(5.0), [0.0, 11.1144 * (1 + 1673 / 6.368e6), 0.0], atol=0.002)
    table = write(tmp_path, "ride.csv", "time,lat,lon,ele\n0,46.017,7.75,1673\n5,46.0171,7.75,1673\n")
    np.testing.assert_allclose(ep.read_trajectories(table)["ride"].position(5.0), one.position(5.0))
    moved = ep.read_trajectories(table, origin=(46.0171, 7.75, 1673.0))["ride"]
    np.testing.assert_allclose(moved.position(5.0), 0.0, atol=1e-6)


def test_tracks_have_the_names_that_stand_in_them(tmp_path):
    before = "<wpt lat='46' lon='7'><name>home</name></wpt><trk><name>ride</name>"
    two = GPX.replace("<trk><name>ride</name>", before).replace("</gpx>", GPX[GPX.index("<trk>"):])
    found = ep.read_trajectories(write(tmp_path, "two.gpx", two.replace("7.750", "7.751", 2)), origin=(46.017, 7.75, 1673.0))
    assert list(found) == ["ride", "ride_2"]
    assert found["ride"].position(0.0)[0] - found["ride_2"].position(0.0)[0] == pytest.approx(77.4, abs=0.1)  # 0.001 degrees


def test_rows_without_a_height_have_one_between_those_around(tmp_path):
    point = '<trkpt lat="46.01{}" lon="7.75">{}<time>2026-05-01T12:00:0{}Z</time></trkpt>'
    heights = ["<ele>500</ele>", "", "<ele>504</ele>", "<ele>504</ele>", ""]
    points = "".join(point.format(second, height, second) for second, height in enumerate(heights))
    gpx = write(tmp_path, "hill.gpx", f"<gpx><trk>{points}</trk></gpx>")
    table = write(tmp_path, "hill.csv", "time,x,y,z\n0,0,0,500\n1,10,0,\n2,20,0,504\n3,30,0,504\n4,40,0,\n")
    level = write(tmp_path, "level.csv", "time,x,y,z\n0,0,0,\n1,10,0,\n")
    for path, options, least in ((gpx, {"origin": (46.01, 7.75, 0.0)}, 500.0), (table, {}, 500.0)):
        (one,) = ep.read_trajectories(path, **options).values()
        np.testing.assert_allclose(one.position(np.arange(5.0))[:, 2], np.array([0.0, 2.0, 4.0, 4.0, 4.0]) + least, atol=2.0e-2)
    assert ep.read_trajectories(level)["level"].position(1.0).tolist() == [10.0, 0.0, 0.0]


def test_positions_are_moved_by_no_more_than_asked_for():
    rng = np.random.default_rng(2)
    times = np.cumsum(rng.uniform(0.2, 0.4, 200))
    true = np.stack([1.3 * times, 5 * np.sin(times / 10), 0 * times], axis=-1)
    noisy = true + rng.normal(0.0, 0.3, true.shape)
    assert smoothed(times, noisy, 0.0) is noisy
    for distance in (0.05, 0.3, 0.5):
        found = smoothed(times, noisy, distance)
        assert np.sqrt(np.mean(np.sum((found - noisy) ** 2, axis=1))) == pytest.approx(distance, rel=1e-3)
    assert np.sum((found - true) ** 2) < 0.3 * np.sum((noisy - true) ** 2)
    np.testing.assert_allclose(smoothed(times, true[:, :1], 1.0), true[:, :1], atol=1e-6)      # a straight line is smooth


def test_the_smoothest_is_that_of_the_dense_equations():
    times, values = np.array([0.0, 1.0, 2.5, 3.0, 4.2]), np.array([[0.0], [1.0], [0.5], [2.0], [1.0]])
    found = smoothed(times, values, 0.2)
    step, rows = np.mean(np.diff(times)), np.zeros((3, 5))
    for k in range(3):
        h0, h1 = np.diff(times)[k:k + 2] / step
        rows[k, k:k + 3] = 2 / (h0 + h1) * np.array([1 / h0, -1 / h0 - 1 / h1, 1 / h1])
    force, residual = rows.T @ rows @ found, values - found
    weight = (force.T @ residual / (force.T @ force)).item()
    np.testing.assert_allclose(residual, weight * force, atol=1e-9)


PERSON_AT_0 = '<person id="a" x="0" y="0" angle="90"/>'
WALK = '<timestep time="{0}">\n<person id="a" x="{0}" y="0" angle="90"/></timestep>\n'.format
TWICE = f'<fcd-export>\n{WALK(0)}{WALK(1)}{WALK(2).replace("</", chr(10) + PERSON_AT_0 + "</")}</fcd-export>'
WRONG = {
    "a.csv": [("", "must name columns"), ("a,b\n1,2\n", "line 1: must name columns"), ("t,x,y\n", "holds no positions"),
              ("t,x,y\n0,0,0\n1,nan,0\n", "line 3: x: must be a number"), ("t,x,y\n0,0,0\n1,5\n", "line 3: must have at least 3"),
              ("t,x,y\n0,0,0\n0,5,0\n", "line 3: time: must be later"), ("t,x,y,heading\n0,0,0,1\n", "line 1: column 'heading'"),
              ("t,x,y,t\n", "line 1: column 't'"), ("t [fortnights],x,y\n", "column 't .*its unit must be one of s, .*nights"),
              ("t,x,y\n0,0,0\n1,1e9,0\n", "line 3: x: .*1e\\+07.* got '1e9'"),
              ("t,lat,lon\n0,91,0\n", "line 2: latitude"), ("t,x,y,speed\n0,0,0,-3\n", "line 2: speed: must be at least 0"),
              ("timestep_time;vehicle_id;vehicle_x;vehicle_y\n0.0;a;0;0\n", "is a table of SUMO, .* read as .xml"),
              ("t x y\n0 0 0\n", "line 1: must name columns: .* got t x y, without commas, semicolons or tabs between"),
              ("t,x,y\n315966253572412000,0,0\n", "line 2: time: must be at most 1e\\+12 s, .*; a unit in brackets"),
              ("t,x,y\n01.05.2026 12:00:00,0,0\n", "line 2: time: must be a number of seconds or a time such as 2026-"),
              ("t,x,y\nnoon,0,0\n", "line 2: time: must be"), ("t,x,y\n2026-13-01T00:00:00Z,0,0\n", "line 2: time: must be")],
    "a.xml": [("", "is no XML"), ("<net/>", "must begin with <fcd-export>"), ("<fcd-export/>", "holds no positions"),
              ('<!DOCTYPE a [<!ENTITY b "c">]><fcd-export>&b;</fcd-export>', "document type, which may expand"),
              (FCD.replace('x="20.00" ', ""), "line 8: <vehicle>: x is missing"),
              ("<fcd-export>" * 80, "elements within each other"),
              (FCD.replace('x="20.00"', 'x="far"'), "line 8: x: must be a number .*'far'"),
              (FCD.replace('time="1.00"', 'time="0.00"'), "line 8: time: must be later"),
              (TWICE, "line 8: time: must be later"),
              ('<fcd-export><vehicle id="a" x="0" y="0" angle="0"/></fcd-export>', "must stand in a <timestep>")],
    "a.gpx": [("<gpx/>", "holds no positions"),
              (GPX.replace("<time>2026-05-01T12:00:00Z</time>", ""), "line 2: <trkpt>: time is"),
              (GPX.replace("46.0171", "x"), "line 3: lat: must be a number")], "a.json": [("{}", "must end in .csv")]}


@pytest.mark.parametrize("times", [[0, 1, 1e7], [0, 1e-6, 1e7 - 1, 1e7], [0, 0.02, 0.5, 0.51, 3, 3.3]])
def test_smoothing_bears_times_that_lie_far_and_near(times):
    """What is smoothed solves (1 + w D^T D) z = y, here in fractions, for the second divided differences D in mean steps."""
    places, weight = [Fraction(value) for value in (0.0, 1.0, -0.5, 0.25, 2.0, 1.0)[:len(times)]], Fraction(10) ** 4
    steps = [Fraction(after) - Fraction(before) for before, after in zip(times, times[1:])]
    mean = Fraction(float(np.mean(np.diff(times))))
    system = [[Fraction(int(row == column)) for column in range(len(times))] + [places[row]] for row in range(len(times))]
    for at, (h, g) in enumerate(zip(steps, steps[1:])):
        h, g = h / mean, g / mean
        second = [2 / (h + g) / h, -2 / (h * g), 2 / (h + g) / g]
        for row, column in np.ndindex(3, 3):
            system[at + row][at + column] += weight * second[row] * second[column]
    exact = [float(value) for value in solved_exactly(system)]
    found = _solved(np.array(times, float), np.array(places, float)[:, None], float(mean), float(weight))
    np.testing.assert_allclose(found[:, 0], exact, atol=1e-9)


def solved_exactly(system):
    """The solution of a linear system of fractions [N, N + 1], by Gauss and Jordan."""
    for k, pivot in enumerate(system):
        system[k] = [value / pivot[k] for value in pivot]
        for row in range(len(system)):
            if row != k:
                system[row] = [value - system[row][k] * other for value, other in zip(system[row], system[k])]
    return [row[-1] for row in system]


@pytest.mark.parametrize("name, text, words", [(name, *one) for name, cases in WRONG.items() for one in cases])
def test_what_is_wrong_is_refused_by_file_and_line(tmp_path, name, text, words):
    with pytest.raises(ep.FileError, match=f"(?s){name}.*{words}"):
        ep.read_trajectories(write(tmp_path, name, text))


DEGREES = 1.0 / 111320.0  # of a metre on a great circle


def steps_of(rows, *, time="{:g}", speed='speed="10"'):
    """Floating car data of one car that goes along x, [(time, x, or None where it is missing)]."""
    car = '<vehicle id="a" x="{}" y="0" angle="90" type="passenger" ' + speed + "/>"
    return "<fcd-export>" + "".join(f'<timestep time="{time.format(at)}">{"" if x is None else car.format(x)}</timestep>'
                                    for at, x in rows) + "</fcd-export>"


def test_who_is_missing_in_a_file_of_sumo_and_comes_back_elsewhere_is_another(tmp_path):
    """Teleported by 480 m while it is missing for 8 s, and then out of what is written for as long at the same place."""
    rows = [(at, 10 * at) for at in range(3)] + [(at, None) for at in range(3, 10)]
    rows += [(at, 400 + 10 * at) for at in range(10, 13)] + [(at, None) for at in range(13, 20)] + [(20, 530), (21, 540)]
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", steps_of(rows)))
    assert {name: (one.begin, one.end) for name, one in found.items()} == {"a": (0, 2), "a_2": (10, 12), "a_3": (20, 21)}
    middle = found["a"].position(1.0) - [10, 0, 0]
    for name, at, x in (("a", 2.0, 20), ("a_2", 11.0, 510), ("a_3", 20.5, 535)):
        np.testing.assert_allclose(found[name].position(at) - middle, [x, 0, 0], rtol=0, atol=1e-9)
    scene = ep.Scene()
    ep.add_traffic(scene, found)
    assert scene["a_2"].lifetime == (10, 12)


def test_a_person_of_sumo_with_a_single_position_is_left_out(tmp_path, recwarn):
    there = '<person id="b" x="0" y="3" angle="0"/>'
    text = "<fcd-export>" + WALK(0).replace("</", there + "</") + WALK(1) + "</fcd-export>"
    assert list(ep.read_trajectories(write(tmp_path, "fcd.xml", text))) == ["a"]
    assert [str(one.message).split(": ")[1] for one in recwarn] == ["1 object with a single position is left out, such as 'b'"]


@pytest.mark.parametrize("speed", ['speed="10"', ""])
def test_who_goes_on_as_before_behind_steps_that_a_file_of_sumo_lacks_is_the_same(tmp_path, speed):
    rows = [(at, None if at in (3, 4) else 10 * at) for at in range(8)]
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", steps_of(rows, speed=speed)))
    assert list(found) == ["a"] and found["a"].speed(3.5) == pytest.approx(10.0)
    seldom = [(at, 10 * at if at % 3 == 0 else None) for at in range(10)]
    assert list(ep.read_trajectories(write(tmp_path, "fcd.xml", steps_of(seldom, speed='speed="2"')))) == ["a"]


@pytest.mark.parametrize("speed", [' speed="1.2"', ""])  # SUMO leaves it out if its --fcd-output.attributes do
@pytest.mark.parametrize("interval, jump", [(1.0, 8.0), (0.1, 3.0), (1.0, 1.3)])
def test_persons_of_sumo_who_jump_across_a_junction_are_others_from_there(tmp_path, interval, jump, speed):
    """At 1.2 m/s for ten steps, across in one, and on for ten; 1.3 m in a second are no jump."""
    ways = 1.2 * interval * np.arange(10)
    persons = [f'<person id="ann" x="3" y="{y:.3f}" angle="0"{speed}/>' for y in [*ways, *(ways + ways[-1] + jump)]]
    text = "".join(f'<timestep time="{step * interval:.1f}">{row}</timestep>' for step, row in enumerate(persons))
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", f"<fcd-export>{text}</fcd-export>"))
    assert list(found) == (["ann", "ann_2"] if jump > 2.0 else ["ann"])
    assert len(ep.add_traffic(ep.Scene(), found)) == len(found)


def test_persons_of_sumo_without_speeds_who_ride_are_not_parted(tmp_path):
    """Bicycles at 6 m/s by a row a second."""
    persons = [f'<person id="ann" x="3" y="{6 * step}" angle="0"/>' for step in range(5)]
    text = "".join(f'<timestep time="{step}">{row}</timestep>' for step, row in enumerate(persons))
    assert list(ep.read_trajectories(write(tmp_path, "fcd.xml", f"<fcd-export>{text}</fcd-export>"))) == ["ann"]


@pytest.mark.parametrize("together", [True, False])
def test_persons_of_sumo_may_have_the_ids_of_vehicles(tmp_path, together):
    """Vehicles and persons that are written by two runs are both counted from 0 on."""
    rows = [f'<vehicle id="0" x="{10 * step}" y="0" angle="90" type="car"/>' for step in range(3)]
    persons = [f'<person id="0" x="3" y="{step}" angle="0"/>' for step in range(3)]
    steps = [car + person for car, person in zip(rows, persons)] if together else rows + persons
    text = "".join(f'<timestep time="{time}">{row}</timestep>' for time, row in enumerate(steps))
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", f"<fcd-export>{text}</fcd-export>"))
    assert {name: one.is_person for name, one in found.items()} == {"0": False, "0_person": True}
    assert found["0"].length == pytest.approx(20.0) and found["0_person"].length == pytest.approx(2.0)


def test_times_of_sumo_may_be_those_of_a_clock(tmp_path):
    rows = [("23:59:59.50", 0), ("1:00:00:00.50", 10), ("1:00:00:01.50", 20)]
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", steps_of(rows, time="{}")))["a"]
    assert (found.begin, found.end) == (86399.5, 86401.5)


def test_positions_that_jump_are_warned_of(tmp_path):
    table = "time,id,x,y\n0,a,0,0\n0.1,a,1,0\n0.2,a,60,0\n0.3,a,61,0\n"
    with pytest.warns(RuntimeWarning, match="'a' goes 59 m from 0.1 to 0.2 s, as where a name is given to something else"):
        ep.read_trajectories(write(tmp_path, "jump.csv", table))


def test_what_spins_by_noise_is_warned_of_and_held_by_smoothing(tmp_path):
    """A car that brakes, stands for four seconds and drives on, straight ahead, by positions to 1 cm."""
    drive = ep.Trajectory([(0, 0), (80, 0)], speed=10.0, stops=[(40, 4.0)])
    times, rng = np.arange(0.0, drive.end, 0.1), np.random.default_rng(4)
    rows = drive.position(times)[:, :2] + rng.normal(0.0, 0.01, (len(times), 2))
    text = "time,x,y\n" + "".join(f"{time:.1f},{x:.4f},{y:.4f}\n" for time, (x, y) in zip(times, rows))
    path = write(tmp_path, "car.csv", text)
    with pytest.warns(RuntimeWarning, match="'car' turns by .* rad/s at .* s, as what stands does by the noise"):
        ep.read_trajectories(path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        car = ep.read_trajectories(path, smoothing=0.01)["car"]
    assert np.abs(car.yaw(np.linspace(0.0, times[-1], 500))).max() < 0.2
    flips = write(tmp_path, "flips.csv", "time,x,y,yaw_deg\n0,0,0,0\n0.1,1,0,178\n0.2,2,0,0\n0.3,3,0,0\n")
    with pytest.warns(RuntimeWarning, match="'flips' turns by .* rad/s at .* s, as yaws that flip do"):
        ep.read_trajectories(flips)


def in_degrees(metres):
    """Data as SUMO writes them with --fcd-output.geo, at the equator and the meridian of Greenwich."""
    return re.sub(r'([xy])="([\d.]+)"', lambda found: f'{found[1]}="{8.5 + float(found[2]) * DEGREES:.7f}"', metres)


def test_places_of_sumo_in_degrees_are_refused(tmp_path):
    with pytest.raises(ep.FileError, match=r"fcd.xml: places are in degrees \(--fcd-output.geo\), must be in m"):
        ep.read_trajectories(write(tmp_path, "fcd.xml", in_degrees(FCD)))
    options = '<!-- generated\n<output><fcd-output value="a.xml"/><fcd-output.geo value="true"/></output>\n-->'
    with pytest.raises(ep.FileError, match="line 2: places are in degrees"):
        ep.read_trajectories(write(tmp_path, "fcd.xml", FCD.replace("<fcd-export", f"{options}<fcd-export", 1)))


@pytest.mark.filterwarnings("ignore:.*single position")
def test_places_in_metres_are_taken_whatever_their_speeds_say(tmp_path):
    for text in (FCD.replace("speed=", "other="), FCD.replace('speed="10.00"', 'speed="0.00"'),
                 FCD.replace("<fcd-export", '<!-- <fcd-output.geo value="false"/> --><fcd-export', 1)):
        assert len(ep.read_trajectories(write(tmp_path, "fcd.xml", text))) == 3
    standing = FCD.replace('x="20.00"', 'x="10.00"').replace('x="30.00"', 'x="10.00"').replace('speed="10.00"', 'speed="0.00"')
    assert len(ep.read_trajectories(write(tmp_path, "fcd.xml", standing))) == 3
