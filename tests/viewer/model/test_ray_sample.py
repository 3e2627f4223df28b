"""Which rays are drawn: some of every mesh and part, against slow counts."""
from __future__ import annotations

import numpy as np
import pytest

from echopath_viewer.model import Session, from_frame
from echopath_viewer.model.rays.ray_sample import RaySampler, coherent_powers
from echopath_viewer.model.rays.touch_groups import TouchGroups


def record(rng, num_paths: int, num_meshes: int):
    """(offsets, num_bounces, mesh_id) of chance paths of 0 to 3 hits, most of them on mesh 0."""
    num_bounces = rng.integers(0, 4, num_paths)
    offsets = np.cumsum(num_bounces) - num_bounces
    share = np.full(num_meshes, 0.05 / (num_meshes - 1))
    share[0] = 0.95
    return offsets, num_bounces, rng.choice(num_meshes, int(num_bounces.sum()), p=share)


def test_groups_are_the_sets_of_meshes_that_paths_touch():
    offsets, num_bounces, mesh_id = record(np.random.default_rng(1), 5000, 70)
    groups = TouchGroups(offsets, num_bounces, mesh_id, 70)
    wanted = [tuple(sorted(set(mesh_id[at:at + count].tolist()))) for at, count in zip(offsets, num_bounces)]
    assert [groups.meshes[group] for group in groups.group_of_path] == wanted
    assert len(set(groups.meshes)) == len(groups) and sorted(groups.order) == list(range(5000))
    for group, rows in enumerate(groups.slices()):
        assert np.all(groups.group_of_path[groups.order[rows]] == group)


@pytest.mark.parametrize("count", [1, 40, 300, 6000])
def test_every_mesh_that_there_is_room_for_has_a_ray(count):
    rng = np.random.default_rng(2)
    offsets, num_bounces, mesh_id = record(rng, 5000, 30)
    power = 10.0 ** rng.uniform(-12.0, -9.0, 5000)
    power[[mesh_id[at:at + n].tolist() == [0] for at, n in zip(offsets, num_bounces)]] *= 1e6  # the floor drowns the rest
    power[:50] = 0.0
    groups = TouchGroups(offsets, num_bounces, mesh_id, 30)
    groups.sort_within(power)
    coherent_power = coherent_powers(groups, np.sqrt(power) + 0j, rng.integers(0, 99, 5000))
    sampler = RaySampler(groups, power, coherent_power, 30)
    mask = rng.random(5000) < 0.7
    chosen = sampler.sample(mask, count)
    assert len(chosen) == len(set(chosen.tolist())) == min(count, np.count_nonzero(mask & (power > 0.0)))
    assert np.all(mask[chosen]) and np.all(power[chosen] > 0.0)
    drawn = {mesh for path in chosen for mesh in mesh_id[offsets[path]:offsets[path] + num_bounces[path]]}
    there = {mesh for path in np.flatnonzero(mask & (power > 0.0))
             for mesh in mesh_id[offsets[path]:offsets[path] + num_bounces[path]]}
    assert drawn == there or count < len(there)


@pytest.mark.filterwarnings("error")
def test_rays_far_beyond_the_filter_of_the_receiver_are_drawn_without_a_warning():
    """Their power is so low that the sum of a cell vanishes."""
    groups = TouchGroups(np.array([0, 1, 2]), np.ones(3, int), np.array([0, 0, 1]), 2)
    power = np.array([1e-300, 1e-320, 1e-310])
    sampler = RaySampler(groups, power, np.zeros(len(groups)), 2)
    assert sorted(sampler.sample(np.ones(3, bool), 5)) == [0, 1, 2]


def test_coherent_power_is_the_peak_of_a_slow_sum():
    rng = np.random.default_rng(3)
    offsets, num_bounces, mesh_id = record(rng, 800, 4)
    amplitude = rng.normal(size=800) + 1j * rng.normal(size=800)
    cell = rng.integers(0, 20, 800)
    groups = TouchGroups(offsets, num_bounces, mesh_id, 4)
    found = coherent_powers(groups, amplitude, cell)
    for group in range(len(groups)):
        of_group = groups.group_of_path == group
        wanted = max(abs(amplitude[of_group & (cell == one)].sum()) ** 2 for one in range(20))
        assert found[group] == pytest.approx(wanted, rel=1e-12, abs=0)


def test_what_a_view_draws_touches_every_mesh_and_part(frame):
    session = Session(from_frame(frame))
    session.set_max_rays(25)
    drawn = session.shown_rays()
    touched = {mesh for path in drawn for mesh in session.columns.meshes_of(path).tolist()}
    assert len(drawn) == 25 and touched == {0, 1, 2, 3}
    assert all(part.mask[drawn].any() for part in session.parts.of_group("route") if part.mask.any())
    session.set_sampling("strongest")
    assert np.array_equal(session.shown_rays(), np.argsort(-session.columns.power, kind="stable")[:25])
    with pytest.raises(ValueError, match="sampling: must be one of over objects, strongest, got 'best'"):
        session.set_sampling("best")
