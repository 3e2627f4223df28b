"""What a user does with frames, as the pages say it: mypy --strict is content with it (test_stubs.py). It is not run."""
import numpy as np

import echopath as ep
from echopath import plots


def taken_apart(scene: ep.Scene, radar: ep.Radar) -> None:
    """As README.md does it, and by several partitions."""
    scene["walker"].position += (0.5, 0, 0)
    paths = ep.trace(scene, radar, num_rays=100_000)
    parts = ep.decompose(paths, radar, {"direct": "T 'walker'+ R", "ghost": ep.hits("walker") & (ep.num_bounces == 3)})
    for name, cube in parts.items():
        spectrum = ep.range_doppler(cube, radar)
        print(f"{name:13}", spectrum.values.shape)
    noisy = ep.add_noise(sum(parts.values()), radar, seed=1)
    points = ep.detect(ep.range_doppler(noisy, radar), radar, paths=paths, parts=parts)
    indices, shares = points.paths(0)
    by_family = ep.decompose(paths, radar, {"routes": {"direct": "T . R"}, "families": ep.families(paths)})
    print(indices.max(), shares.sum(), by_family["routes"]["direct"].shape, [family.object for family in ep.families(paths)])


def labelled(scene: ep.Scene, radar: ep.Radar) -> ep.Detections:
    """A frame with labels, detections and their pictures."""
    frame = ep.simulate(scene, radar, labels=True, detections=True,
                        parts={"pane": "T 'pane' R", "behind": ep.passes("pane") & ep.hits("walker")})
    power = np.mean(np.abs(frame.spectrum.values) ** 2, axis=(0, 1))
    labels = frame.labels["parts"]
    print(power.max(), frame.cube.shape, frame.paths.frame.seed, frame.parts["parts"]["pane"].dtype, frame.effects[0].reason)
    print([(seen.name, seen.status) for seen in labels.objects], [ghost.via[0] for ghost in labels.ghosts])
    print(frame.unresolved[0].advice, frame.truth.position.shape, frame.mean_part_powers["parts"]["pane"].power)
    plots.save_png(plots.plot_overview(frame.spectrum, frame.part_spectra["parts"]), "overview.png", seed=1)
    plots.save_png(plots.plot_range_azimuth(frame.range_azimuth), "above.png")
    plots.save_png(plots.plot_scene(scene, frame.paths), "scene.png")
    plots.save_png(frame.plot().figure, "map.png")
    plots.save_png(frame.detections.plot(), "detections.png")
    return frame.detections


def measured(scene: ep.Scene) -> None:
    """Cross sections, a receiver with faults, and a scene file."""
    turns = np.column_stack([-np.cos([0.0, 0.1]), np.sin([0.0, 0.1]), np.zeros(2)])
    print(10.0 * np.log10(ep.rcs(scene, frequency=77e9, incidence=turns)))
    print(ep.rcs(scene, frequency=77e9, incidence=(-1, 0, 0), components=True)["coherent"])
    noise = ep.PhaseNoise(offsets=np.logspace(4, 7, 4), levels=[-70, -80, -90, -110])
    receiver = ep.Receiver(phase_noise=noise, leakage_db=np.full((1, 1), -40.0), high_pass=(175e3,), adc={"bits": 12})
    steps = receiver.adc.bits if receiver.adc else 0
    corners: tuple[float, ...] = receiver.high_pass + noise.offsets
    print(steps, corners, receiver.leakage_db[0][0], receiver.replace(dc_offset=np.zeros(2)).dc_offset[1])
    loaded = ep.load_scene("street.toml")
    frame = ep.simulate(loaded.scene, loaded.radar.replace(receiver=ep.Receiver(adc=ep.Adc(bits=12))), parts=loaded.parts)
    print(frame.received.codes.dtype, 10.0 * np.log10(np.mean(np.abs(frame.interference_cube) ** 2)))


def in_time(scene: ep.Scene, radar: ep.Radar) -> None:
    """Frames in a row, their truth and tracks."""
    sequence = ep.Sequence(scene, radar, frames=3, interval=0.1, detections=True, parts={"legs": "T 'walker/leg_*'+ R"})
    frames = list(sequence)
    truth = ep.truth(frames)
    tracks = ep.track([frame.detections for frame in frames], sequence.times, truth=truth, merge_distance=1.5)
    film = ep.spectrogram(frames, labels=True)
    film.labels["parts"].plot()
    print(tracks.num_switches, sequence.save("frames", keep="maps")[2].labels["parts"].dominant.shape)
