"""Edits of a live scene at random, of every kind that there is."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep

GUESTS = ("guest_a", "guest_b", "guest_c")   # what is added and removed
GUEST_PLACE, GUEST_SPREAD = (12.0, 0.0, 0.8), (4.0, 3.0, 0.0)   # m: where guests stand on the mean, and how far from there


@dataclasses.dataclass
class RandomEdits:
    """Makes edits of a Live one by one.

    live: whose scene they change; names: of the objects that are moved and the like; planes: of flat objects that become flagged
    mirrors and cease to be; seed: of all numbers
    """

    live: ep.Live
    names: list[str]
    planes: list[str]
    seed: int = 3

    def __post_init__(self) -> None:
        self.draw = np.random.default_rng(self.seed)
        self.first_radar = self.live.radar
        self.window = "hann"
        self._to_come: list[str] = []

    def make(self) -> str:
        """Makes one and returns its kind; of as many in a row as there are kinds, each comes once."""
        if not self._to_come:
            self._to_come = [str(kind) for kind in self.draw.permutation(list(KINDS))]
        kind = self._to_come.pop()
        KINDS[kind](self)
        return kind

    def fresh_view(self) -> ep.LiveView:
        """What a new Live of the scene as it is now shows."""
        return ep.Live(self.live.scene, self.live.radar, num_rays=self.live.num_rays, window=self.window).update()

    def _node(self):
        return self.live.scene[self.names[self.draw.integers(len(self.names))]]

    def _place(self) -> None:
        self._node().position += self.draw.normal(0.0, 0.2, 3) * (1, 1, 0)

    def _turn(self) -> None:
        self._node().yaw += self.draw.normal(0.0, 0.3)

    def _motion(self) -> None:
        node = self._node()
        speed = (self.draw.normal(0.0, 5.0), 0.0, 0.0)
        node.motion = ep.LinearMotion(velocity=speed) if node.motion is None else None

    def _hide(self) -> None:
        node = self._node()
        node.visible = not node.visible

    def _material(self) -> None:
        self._node().material = ep.Material.metal() if self.draw.integers(2) else ep.materials["concrete"]

    def _mirror(self) -> None:
        node = self.live.scene[self.planes[self.draw.integers(len(self.planes))]]
        node.material = node.material.replace(mirror=not node.material.mirror)

    def _add_or_remove(self) -> None:
        name = GUESTS[self.draw.integers(len(GUESTS))]
        if name in self.live.scene:
            self.live.scene.remove(name)
        else:
            self._add_guest(name, GUEST_PLACE + self.draw.normal(0.0, 1.0, 3) * GUEST_SPREAD)

    def _shape(self) -> None:
        """A guest with another mesh at the same place; a new one where there was none."""
        name = GUESTS[0]
        with self.live.changing() as scene:
            place = scene[name].position if name in scene else GUEST_PLACE
            if name in scene:
                scene.remove(name)
            self._add_guest(name, place)

    def _add_guest(self, name: str, place) -> None:
        self.live.scene.add(ep.actors.box(tuple(self.draw.uniform(0.3, 1.2, 3))), name=name, material="concrete", position=place)

    def _power(self) -> None:
        self._set_radar(transmit_power=float(self.draw.uniform(0.005, 0.02)))

    def _array(self) -> None:
        """One to three receivers about the same middle, or not."""
        first = self.first_radar.receivers[0]
        count, shift = int(self.draw.integers(1, 4)), float(self.draw.integers(2)) * 0.002
        places = 0.002 * (np.arange(count) - 0.5 * (count - 1)) + shift
        pattern = self.live.radar.receivers[0].pattern
        self._set_radar(receivers=[first.replace(position=np.add(first.position, (0.0, y, 0.0)), pattern=pattern)
                                   for y in places])

    def _waveform(self) -> None:
        waveform = self.first_radar.waveform
        chirps, bandwidth = (waveform.num_chirps // (1 + self.draw.integers(2)), waveform.bandwidth * self.draw.uniform(0.5, 1.0))
        start = waveform.start_frequency + 1e8 * self.draw.integers(2)
        self._set_radar(waveform=waveform.replace(num_chirps=int(chirps), bandwidth=float(bandwidth),
                                                  start_frequency=float(start)))

    def _pattern(self) -> None:
        pattern = (ep.Isotropic(), ep.CosinePower(2.0), ep.CosinePower(4.0))[self.draw.integers(3)]
        radar = self.live.radar
        self._set_radar(transmitters=[one.replace(pattern=pattern) for one in radar.transmitters],
                        receivers=[one.replace(pattern=pattern) for one in radar.receivers])

    def _radar_place(self) -> None:
        self._set_radar(position=tuple(self.draw.normal(0.0, 0.1, 3) * (1, 1, 0)))

    def _map(self) -> None:
        self.window = "hann" if self.window == "hamming" else "hamming"
        self.live.set_map(window=self.window)

    def _set_radar(self, **fields) -> None:
        self.live.radar = self.live.radar.replace(**fields)


KINDS = {"place": RandomEdits._place, "turn": RandomEdits._turn, "motion": RandomEdits._motion, "hide or show": RandomEdits._hide,
         "material": RandomEdits._material, "flagged mirror": RandomEdits._mirror, "add or remove": RandomEdits._add_or_remove,
         "shape": RandomEdits._shape, "power": RandomEdits._power, "array": RandomEdits._array,
         "waveform": RandomEdits._waveform, "pattern": RandomEdits._pattern, "place of the radar": RandomEdits._radar_place,
         "window": RandomEdits._map}
