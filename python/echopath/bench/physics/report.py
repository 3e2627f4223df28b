"""The benchmark in words and numbers."""
from __future__ import annotations

from pathlib import Path

from ...base.storage.files import write_texts
from ..steps import csv_text, json_text
from ..suite import judged_row

MUST_REACH = (  # target, rays, dB
    ("sphere_161", 2 ** 13, 0.1), ("sphere_3228", 2 ** 13, 0.1), ("ellipsoid", 2 ** 14, 0.1))
SAME_SHARE = 0.02  # errors that differ by less, or by two standard errors of the difference, count as equal
SLOPE, SETTLED_DB = -0.9, 0.01
BEST = "second_order lattice"
FEWEST_SHOWN = 2 ** 10
POINT_COLUMNS = ("num_rays", "shifts", "rms_db", "rms_from_converged_db", "mean_db", "worst_db", "seconds")


def verdicts(results: dict) -> list[dict]:
    """What the default must reach: one row {what, limit, measured, holds} each; only what the run has measured."""
    targets, rows = results["targets"], []
    for name, num_rays, limit in MUST_REACH:
        point = _point(targets[name], BEST, num_rays)
        if point:
            rows.append(judged_row(f"{targets[name]['title']}: rms dB at {_rays(num_rays)}", point["rms_db"], limit))
    for pair in results["plates"]:
        allowed = max(SAME_SHARE * pair["unfiltered_db"], 2.0 * pair["margin_error_db"])
        rows.append(judged_row(f"plate, {pair['angle_deg']:g} deg: rms dB at {_rays(pair['num_rays'])}, as unfiltered",
                               pair["filtered_db"], pair["unfiltered_db"] + allowed))
    for target in targets.values():
        if target["converged_db"] is None:
            continue
        is_by_mesh = abs(target["converged_db"]) > SETTLED_DB  # what rays cannot mend must not flatten their slope
        slope = target["slopes_from_converged" if is_by_mesh else "slopes"][BEST]
        if slope is not None:
            reference = "converged level" if is_by_mesh else "theory"
            rows.append(judged_row(f"{target['title']}: slope from {reference}", slope, SLOPE))
    return rows


def write_results(results: dict, folder: Path) -> None:
    """Writes physics.json, physics.csv (a row for each target, variant and number of rays) and costs.csv."""
    points = [{"target": name, "variant": label, **{column: point[column] for column in POINT_COLUMNS}}
              for name, target in results["targets"].items() for label, curve in target["curves"].items() for point in curve]
    write_texts(folder, {"physics.json": json_text(results), "physics.csv": csv_text(points),
                         "costs.csv": csv_text(results["costs"])})


def describe(results: dict) -> list[str]:
    """Lines for people: errors of the targets, plates with and without the filter, what must be reached, costs."""
    machine = results["machine"]
    lines = [f"{machine['processor']}, {machine['threads']} threads, echopath {machine['echopath']}, "
             f"error in dB, rms over {results['shifts']} shifts of the rays",
             "slope: of log error over log rays, -1 where twice the rays halve it; from converged: of the difference from what",
             "the default converges to, 2^18 rays", "", *_errors(results), *_plates(results)]
    if results["must_reach"]:
        lines += ["", "must reach" + " " * 54 + "limit  measured"]
    lines += [f"  {row['what']:<60} {row['limit']:7.3f} {row['measured']:8.3f}  {'holds' if row['holds'] else 'MISSED'}"
              for row in results["must_reach"]]
    lines += ["",
              f"{'two spheres, 3 bounces':<28}{'rays/s':>10}{'replayed paths/s':>18}{'bytes per hit':>15}{'per path':>10}"
              f"{'of it smooth':>14}{'jones':>8}"]
    lines += [f"  {row['label']:<26}{row['rays_per_second']:10.3g}{row['replayed_paths_per_second']:18.3g}"
              f"{row['bytes_per_hit']:15.1f}{row['bytes_per_path']:10.1f}{row['bytes_of_curved_cell']:14.1f}"
              f"{row['bytes_of_jones']:8.1f}" for row in results["costs"]]
    return lines + ["", f"{results['seconds']:.0f} s in all, {results['processor_seconds']:.0f} s of processor time"]


def _errors(results: dict) -> list[str]:
    """Slopes: of the error from theory, and from the level that the default converges to on the same mesh."""
    shown = [count for count in results["rays"] if count >= FEWEST_SHOWN]
    lines = [" " * 58 + "".join(f"{_rays(count):>8}" for count in shown) + "   slope  from converged"]
    for target in results["targets"].values():
        for label, curve in target["curves"].items():
            slopes = "".join(f"{target[kind][label]:8.2f}" if target[kind][label] is not None else " " * 8
                             for kind in ("slopes", "slopes_from_converged"))
            points = "".join(f"{point['rms_db']:8.3f}" for point in curve if point["num_rays"] in shown)
            lines.append(f"{target['title']:<34}{label:<24}{points}{slopes}".rstrip())
    return lines


def _plates(results: dict) -> list[str]:
    if not results["plates"]:
        return []
    return ["", "plate 0.1 m, over the same shifts     filtered  unfiltered   margin +- standard error, dB rms",
            *(f"  {pair['angle_deg']:5.1f} deg, {_rays(pair['num_rays'])}, {pair['shifts']} shifts"
              f"{pair['filtered_db']:15.4f}{pair['unfiltered_db']:12.4f}{pair['margin_db']:+11.4f} +- "
              f"{pair['margin_error_db']:.4f}"
              for pair in results["plates"])]


def _point(target: dict, label: str, num_rays: int):
    return next((point for point in target["curves"].get(label, []) if point["num_rays"] == num_rays), None)


def _rays(count: int) -> str:
    return f"2^{count.bit_length() - 1}"
