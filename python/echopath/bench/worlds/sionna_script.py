"""Specular paths and seconds of Sionna RT in its own scenes: `python sionna_script.py REQUEST.json ANSWER.json`.

It is run by an interpreter that has the package sionna-rt, and uses nothing of Echopath: the package wants versions of its
own of what both need. Antennas are isotropic and vertically polarised, and walls are half spaces.
"""
import json
import sys
import time

HALF_SPACE = 1000.0  # m, a thickness that nothing passes
CALLS = 4            # of which the first compiles and is not told


def _settings(request: dict) -> dict:
    return {"max_depth": request["bounces"], "samples_per_src": request["rays"], "los": False, "specular_reflection": True,
            "diffuse_reflection": False, "refraction": False, "diffraction": False}


def _scene(rt, city: dict, frequency: float):
    scene = rt.load_scene(city["file"])
    scene.frequency = frequency
    scene.tx_array = scene.rx_array = rt.PlanarArray(num_rows=1, num_cols=1, pattern="iso", polarization="V")
    for material in scene.radio_materials.values():
        material.thickness = HALF_SPACE
    scene.add(rt.Transmitter("transmitter", position=city["transmitter"]))
    return scene


def _materials(scene) -> dict:
    """(relative permittivity, conductivity in S/m) by name."""
    return {name: [float(material.relative_permittivity[0]), float(material.conductivity[0])]
            for name, material in scene.radio_materials.items() if material.is_used}


def _paths(np, solver, scene, settings: dict) -> list:
    """(delay in s, received over transmitted power, bounces) of each path to the one receiver."""
    paths = solver(scene, **settings)
    real, imaginary = (np.array(part)[0, 0, 0, 0] for part in paths.a)
    delays, valid = np.array(paths.tau)[0, 0], np.array(paths.valid)[0, 0]
    bounces = (np.array(paths.interactions)[:, 0, 0] != 0).sum(axis=0)
    return [[float(delays[k]), float(real[k] ** 2 + imaginary[k] ** 2), int(bounces[k])] for k in np.flatnonzero(valid)]


def _seconds(work) -> list:
    """Of the processor, of each call but the first."""
    found = []
    for _ in range(CALLS):
        began = time.process_time()
        work()
        found.append(time.process_time() - began)
    return found[1:]


def answer(request: dict) -> dict:
    """What is asked of each city: materials, paths to each receiver, and seconds of a call for the first receiver."""
    import numpy as np
    import sionna.rt as rt

    solver, settings, found = rt.PathSolver(), _settings(request), {}
    for city in request["cities"]:
        scene = _scene(rt, city, request["frequency"])
        paths, seconds = [], []
        for index, place in enumerate(city["receivers"]):
            scene.add(rt.Receiver(f"receiver_{index}", position=place))
            if index == 0:
                seconds = _seconds(lambda: _paths(np, solver, scene, settings))
            paths.append(_paths(np, solver, scene, settings))
            scene.remove(f"receiver_{index}")
        found[city["name"]] = {"materials": _materials(scene), "paths": paths, "seconds": seconds}
    return {"version": rt.__version__, "cities": found}


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as stream:
        asked = json.load(stream)
    with open(sys.argv[2], "w", encoding="utf-8") as stream:
        json.dump(answer(asked), stream)
