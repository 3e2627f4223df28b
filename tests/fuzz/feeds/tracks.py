"""Files of trajectories (tables, SUMO, GPX) and configurations of sensors."""
from __future__ import annotations

import warnings
from pathlib import Path
from random import Random

import numpy as np

import echopath as ep
from echopath.trajectories import knots
from fuzz.folder import memory_folder
from fuzz.mutate import damaged, mistaken
from support.scenes.sensor_text import CONFIGURATION

MANY_KEYS = 50_000  # of a trajectory: up to 2 million are made, at 30 microseconds each, which is no fault of a reader
STEPS = range(4)
TABLES = ["time,id,x,y,z,yaw,speed,type\n" + "".join(f"{0.5 * k},a,{k},{0.1 * k * k},0,{0.1 * k},{2 + 0.1 * k},car\n"
                                                     f"{0.5 * k},b,{-k},0,0,0,2,bus\n" for k in STEPS),
          "Timestamp [s];lat;lon;ele\n" + "".join(f"2026-05-01T12:00:0{k}Z;{48 + 1e-5 * k};11;500\n" for k in STEPS),
          "t\tx\ty\tyaw_deg\n0\t0\t0\t0\n1\t1\t0\t350\n2\t1\t0\t10\n"]
STATES = ('<timestep time="{0}.00">\n<vehicle id="v" x="{0}" y="1.5" angle="90.0" type="passenger" speed="1.0"/>\n'
          '<person id="p" x="{0}" y="4" angle="80" speed="1.0" z="0.1"/>\n</timestep>\n')
SUMO = ["<!-- written by hand -->\n<fcd-export>\n" + "".join(map(STATES.format, STEPS)) + "</fcd-export>\n"]
POINT = '<trkpt lat="48.0000{0}" lon="11"><ele>500</ele>\n<time>2026-05-01T12:00:0{0}Z</time></trkpt>\n'
TRACK = "<trkseg>\n" + "".join(map(POINT.format, STEPS)) + "</trkseg>\n</trk>\n"
GPX = ["<gpx>\n<trk>\n<name>walk</name>\n" + TRACK + "<trk>\n" + TRACK + "</gpx>\n"]
SENSORS = [CONFIGURATION, CONFIGURATION.replace(" 0 0 0 0 1\n", " 0 0 0 0 5\n").replace(" 0 0 0 0 4\n", " 1e6 0 2 0 5\n") +
           "bpmCfg -1 1 0 1\nlvdsStreamCfg -1 0 1 0\n",
           CONFIGURATION.replace("dfeDataOutputMode 1", "dfeDataOutputMode 3").replace(
               "frameCfg 0 1 32 0 50 1 0", "advFrameCfg 2 0 0 1 0\nsubFrameCfg 0 -1 0 2 16 20 0 1 1 20\n"
               "subFrameCfg 1 -1 1 1 64 30 0 1 1 30")]
NUMBERS = ["0", "-1", "2", "0.5", "1e-7", "1e5", "1e300", "1e309", "nan", "inf", "-inf", "99999999999999", "9" * 400,
           "4294967296", "", "x", "2026-05-01T12:00:00Z", "0001-01-01T00:00:00+14:00"]


def feed_tracks(suffix: str, seeds: list):
    """Cases of one kind of file of trajectories: tracks that are finite throughout, or an error that names the file."""
    knots.MOST_KEYS = MANY_KEYS
    folder = memory_folder()
    path = Path(folder.name) / f"drive{suffix}"
    for seed in seeds:
        path.write_text(seed)
        assert ep.read_trajectories(path)

    def case(number: int) -> None:
        random = Random(f"tracks{suffix} {number}")
        path.write_bytes(_changed(seeds, random))
        smoothing = random.choice((0.0, 0.0, 0.5))
        try:
            with warnings.catch_warnings():
                warnings.filterwarnings("error", "(divide|overflow|invalid)", RuntimeWarning)  # of numpy
                found = ep.read_trajectories(path, smoothing=smoothing)
        except ep.FileError as error:
            assert str(error).startswith(f"{path}"), f"names no file: {error}"
            return
        for track in found.values():
            times = np.linspace(track.begin, track.end, 5)
            for told in (track.position, track.velocity, track.acceleration, track.yaw, track.yaw_rate):
                assert np.isfinite(told(times)).all(), f"{told.__name__} is finite"

    case.folder = folder
    return case


def feed_sensor():
    """Cases of configurations of sensors: radars with finite times, or an error that names the file."""
    folder = memory_folder()
    path = Path(folder.name) / "profile.cfg"
    for seed in SENSORS:
        path.write_text(seed)
        ep.load_sensor(path)

    def case(number: int) -> None:
        random = Random(f"sensor {number}")
        path.write_bytes(_changed(SENSORS, random))
        try:
            sensor = ep.load_sensor(path, "IWR6843ISK", ideal=random.random() < 0.5)
        except ep.FileError as error:
            assert str(error).startswith(f"{path}"), f"names no file: {error}"
            return
        assert 0.0 <= sensor.interval < np.inf and sensor.num_frames >= 0
        assert all(np.isfinite(radar.frame_duration) for radar in sensor.radars)

    case.folder = folder
    return case


def _changed(seeds: list, random: Random) -> bytes:
    """A seed in which words are other numbers, or with mistakes, or with damaged bytes."""
    text, kind = random.choice(seeds), random.random()
    if kind > 0.85:
        return damaged(text.encode(), random)
    if kind > 0.5:
        return mistaken(text, seeds, random).encode("utf-8", "surrogatepass")
    for _ in range(random.choice((1, 1, 2, 4))):
        begin = random.randrange(len(text))
        while begin and text[begin - 1].isalnum():
            begin -= 1
        end = begin
        while end < len(text) and text[end] in "0123456789+-.e":
            end += 1
        text = text[:begin] + random.choice(NUMBERS) + text[end:]
    return text.encode()
