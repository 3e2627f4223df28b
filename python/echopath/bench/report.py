"""The benchmark in words and numbers."""
from __future__ import annotations

MUST_REACH = (  # target, rays, dB
    ("sphere_161", 2 ** 13, 0.1), ("sphere_3228", 2 ** 13, 0.1), ("ellipsoid", 2 ** 14, 0.1))
PLATES, PLATE_RAYS = ("plate_0", "plate_5", "plate_20.3"), 2 ** 14
SAME_DB = 0.02  # errors that differ by less count as equal
SLOPE = -0.9
SLOPE_TARGETS = ("sphere_161", "sphere_3228", "ellipsoid")
BEST, UNFILTERED = "second_order lattice", "none lattice"


def verdicts(results: dict) -> list[dict]:
    """What the default must reach: one row {what, limit, measured, holds} each; only what the run has measured."""
    targets, rows = results["targets"], []
    for name, num_rays, limit in MUST_REACH:
        point = _point(targets[name], BEST, num_rays)
        if point:
            rows.append(_row(f"{targets[name]['title']}: rms dB at {_rays(num_rays)}", limit, point["rms_db"]))
    for name in PLATES:
        for point in targets[name]["curves"][BEST]:
            if point["num_rays"] < PLATE_RAYS:
                continue
            unfiltered = _point(targets[name], UNFILTERED, point["num_rays"])["rms_db"]
            rows.append(_row(f"{targets[name]['title']}: rms dB at {_rays(point['num_rays'])}, as unfiltered",
                             unfiltered + SAME_DB, point["rms_db"]))
    for name in SLOPE_TARGETS:
        slope = targets[name]["slopes"][BEST]
        if slope is not None:
            rows.append(_row(f"{targets[name]['title']}: slope of the error over rays", SLOPE, slope))
    return rows


def describe(results: dict) -> list[str]:
    """Lines for people: errors of the targets, what must be reached, costs."""
    machine = results["machine"]
    lines = [f"{machine['processor']}, {machine['threads']} threads, echopath {machine['echopath']}, "
             f"rms dB over {results['shifts']} shifts", ""]
    lines += _errors(results)
    lines += ["", "must reach" + " " * 54 + "limit  measured"]
    lines += [f"  {row['what']:<60} {row['limit']:7.3f} {row['measured']:8.3f}  {'holds' if row['holds'] else 'MISSED'}"
              for row in results["must_reach"]]
    lines += ["", "two metal spheres, 3 bounces      rays/s   replayed paths/s   bytes per hit   per path"]
    lines += [f"  {'smooth' if row['smooth'] else 'facets':<7} {row['footprint']:<13} {row['rays_per_second']:15.3g}"
              f" {row['replayed_paths_per_second']:18.3g} {row['bytes_per_hit']:15.1f} {row['bytes_per_path']:10.1f}"
              for row in results["costs"]]
    return lines + ["", f"{results['seconds']:.0f} s in all"]


def _errors(results: dict) -> list[str]:
    lines = [" " * 58 + "".join(f"{_rays(count):>8}" for count in results["rays"]) + "   slope"]
    for target in results["targets"].values():
        for label, points in target["curves"].items():
            slope = target["slopes"][label]
            lines.append(f"{target['title']:<34}{label:<24}" + "".join(f"{point['rms_db']:8.3f}" for point in points) +
                         (f"{slope:8.2f}" if slope is not None else ""))
    return lines


def _point(target: dict, label: str, num_rays: int):
    return next((point for point in target["curves"].get(label, []) if point["num_rays"] == num_rays), None)


def _row(what: str, limit: float, measured: float) -> dict:
    return {"what": what, "limit": limit, "measured": measured, "holds": bool(measured <= limit)}


def _rays(count: int) -> str:
    return f"2^{count.bit_length() - 1}"
