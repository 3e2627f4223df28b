"""Live scenes warn of what a fresh run of them warns of, when it comes."""
import re
import warnings

import pytest

import echopath as ep


def plate_and_radar() -> tuple[ep.Scene, ep.Radar]:
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=ep.Material(permittivity=5.0, scattering=0.5),
              position=(10.0, 0.0, 0.0), yaw=3.0)
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=3e8, num_samples=64, sampling_rate=10e6, num_chirps=4,
                                chirp_interval=3e-5)
    return scene, ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0.0, 0.01, 0.0))])


def told(run) -> list[str]:
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        run()
    return sorted(re.sub(r"[\d,]+ paths", "some paths", str(one.message)) for one in record)


def put_in_a_box(scene) -> None:
    scene.add(ep.actors.box(2.0), name="car", material=ep.Material(permittivity=5.0, scattering=0.5))


def empty(scene) -> None:
    scene.remove("plate")


def drive_out_of_range(scene) -> None:
    scene["plate"].position = (40.0, 0.0, 0.0)


def give_millimetres(scene) -> None:
    scene.add(ep.actors.box(4.0e3), name="house", material="concrete", position=(5.0e3, 0.0, 0.0))


@pytest.mark.parametrize("change, words", [(put_in_a_box, "stands inside of 'car'"), (empty, "no ray hits"),
                                           (drive_out_of_range, "beyond the last range"), (give_millimetres, "'house'")])
def test_a_change_has_the_warnings_of_a_fresh_run(change, words):
    scene, radar = plate_and_radar()
    live = ep.Live(scene, radar, num_rays=500)
    assert told(live.update) == []
    live.change(change)
    found = told(live.update)
    assert any(words in text for text in found), found
    assert found == told(lambda: ep.simulate(ep.Scene(live.scene), radar, num_rays=500, guard=False))
    assert told(lambda: live.preview(num_rays=200)) == []  # of the full view alone


def test_what_no_path_makes_is_told_to_be_missing():
    scene, radar = plate_and_radar()
    live = ep.Live(scene, radar, num_rays=500)
    live.scene.weather = ep.Weather(rain_mm_per_hour=10.0)
    assert [text.split(":")[0] for text in told(live.update)] == ["scene.weather"]
    live.scene.weather = ep.Weather(fog_g_per_m3=0.1)
    assert told(live.update) == []
    live.scene.interferers = [ep.Interferer(radar=radar.replace(position=(9.0, 0.0, 0.0)))]
    assert [text.split(":")[0] for text in told(live.update)] == ["scene.interferers"]


def test_faults_of_the_receiver_are_told_to_be_missing_once_for_each_setting():
    """By their names, as Python's own rule for warnings says the same words at one line once."""
    scene, radar = plate_and_radar()
    live = ep.Live(scene, radar.replace(receiver=ep.Receiver()), num_rays=500)
    assert told(live.update) == []
    noisy = ep.Receiver(phase_noise={"offsets": [1e5], "levels": [-90.0]}, leakage_db=[[-30.0, -40.0]])
    settings = (noisy, noisy, ep.Receiver(adc={"bits": 8}))
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("default")
        for receiver in settings:
            live.radar = radar.replace(receiver=receiver)
            live.preview(num_rays=200)
            live.update()
    texts = [str(one.message) for one in record]
    assert [re.findall("here (.*);", text) for text in texts] == [["phase_noise, leakage_db"], ["adc"]]
    assert all(text.startswith("radar.receiver: live views have no ") for text in texts)


def test_previews_do_not_warn_of_coarse_meshes_and_updates_do():
    """Edges of 0.1 m are far above 0.4 sqrt(radius wavelength) = 14 mm."""
    scene, radar = plate_and_radar()
    scene.add(ep.actors.sphere(0.3, subdivisions=3), name="ball", material="metal", position=(6.0, 1.0, 0.0))
    live = ep.Live(scene, radar, num_rays=500)
    assert told(lambda: live.preview(num_rays=200)) == []
    with pytest.warns(ep.TessellationWarning, match="ball"):
        live.update()


def test_rays_that_touch_the_radar_are_told_of():
    scene, radar = plate_and_radar()
    scene["plate"].position = (3e-4, 0.0, 0.0)
    live = ep.Live(scene, radar, num_rays=500)
    assert any("met a surface within 1 mm of the radar" in text for text in told(live.update))
