"""What each command does; each imports what it needs, so that none waits for the others."""
from __future__ import annotations

from pathlib import Path
from shlex import quote

from ..arguments.checks import file
from ..base.storage.files import require_writable
from .typed_names import told_as, typed_arguments

# Whose they are, of the options that one benchmark alone has.
BENCH_OPTIONS = {"rays_max": "physics", "scenes": "certificate", "seeds": "crowd", "suite": "measured", "cities": "worlds",
                 "sionna": "worlds", "models": "worlds"}


def demo(options) -> None:
    from ..base.process.progress import progress_bars
    from .demo import run_demo

    require_writable(options.out, "--out")
    if options.view:
        from echopath_viewer import require_window

        require_window()
    with progress_bars() as progress:
        frame = run_demo(options.out, num_rays=options.rays, seed=options.seed, batches=options.batches, progress=progress)
    if options.view:
        import echopath as ep

        ep.view(frame)


def view(options) -> None:
    import echopath as ep

    if options.picture is not None:
        require_writable(Path(file("--picture", options.picture)).parent, "--picture")
    frames = options.frames[0] if len(options.frames) == 1 else options.frames
    with told_as(what="FRAME.h5"):
        ep.view(*([frames] if frames else []), state=options.state, picture=options.picture, scale=options.scale)


def run(options) -> None:
    from ..base.process.progress import progress_bars
    from ..frame.unresolved import unresolved_of_frame
    from ..frame_file.opening import SUFFIXES as FRAME_SUFFIXES
    from ..scene_file import load_scene
    from ..scene_file.lines import settings_told
    from . import report
    from .resumable import print_resumable
    from .run import DETECTIONS_NAME, certify, chosen_partition, raw_line, require_raw_name, simulate_file, write_outputs
    from .run_sequence import is_sequence, require_no_others, run_sequence

    out = Path(options.out)
    require_writable(out.parent if out.is_file() else out, "--out")
    if options.raw is not None:
        require_raw_name(options.raw)
        require_writable(Path(file("--raw", options.raw)).parent, "--raw")
    with told_as(path="SCENE.toml"):
        scene_file = load_scene(options.scene)
    if scene_file.radar is None:
        raise ValueError(f"{options.scene}: has no radar; `echopath scene {quote(options.scene)} --out SCENE.toml` writes a "
                         "scene file with one, where [[objects]] names it as model")
    chosen = chosen_partition(options.part, scene_file.partitions())
    require_no_others(out, is_sequence(scene_file, options))
    typed = typed_arguments(options)
    if is_sequence(scene_file, options):
        with settings_told(scene_file.path, typed):
            print_resumable(run_sequence(scene_file, options, chosen), options.out)
        return
    if out.suffix.lower() in FRAME_SUFFIXES and not out.is_dir():  # of a file of frames in time: the scene had to say
        raise ValueError(f"--out: must be a folder for one frame and its pictures, got '{out}'; frames in time (--frames) go to "
                         "one file")
    require_writable(out, "--out")
    with progress_bars() as progress, settings_told(scene_file.path, typed):
        frame = simulate_file(scene_file, num_rays=options.rays, seed=options.seed,
                              batches=options.batches, extra_parts=chosen, truth=options.truth or None, progress=progress)
        certificate = certify(frame, progress=progress)
        objects = scene_file.label_objects()
        written = write_outputs(frame, options.out, partitions=frame.parts, objects=objects)
    if options.raw is not None:
        print(raw_line(options.raw, frame.save_raw(options.raw)))
    advice = report.other_method(scene_file.detection_settings(), 'method = "os" of [detections]')
    for text in [scene_file.title or options.scene, *report.counts(frame.paths),
                 *report.overlaps(frame.scene, frame.paths.frame.trace_time),
                 *report.folded_velocities(frame.scene, frame.radar, frame.paths.frame.trace_time),
                 *report.effects(frame.effects), *report.stages(frame.stages),
                 *report.powers(frame, frame.parts), *report.mean_powers(frame),
                 *report.labels(frame.labels), *report.detections(frame.detections, frame.labels, advice, file=DETECTIONS_NAME),
                 *report.truth(frame.kept_truth), *report.checks(frame.checks), *report.validity(certificate),
                 *report.files(written), *report.unresolved(unresolved_of_frame(frame, objects), frame.paths)]:
        print(text)


def info(options) -> None:
    from .info import describe_file

    with told_as(path="FILE"):
        print("\n".join(describe_file(options.file, options.select, unit=options.unit, up=options.up)))


def scene(options) -> None:
    from ..scene_file.write import write_scene_file
    from .model_info import describe_model

    out = Path(options.out)
    if out.suffix.lower() != ".toml":
        raise ValueError(f"--out: must be a file .toml, got '{options.out}'")
    if out.exists() and not options.overwrite:
        raise ValueError("--out: must be a new file, as there may be edits in one that is there (--overwrite takes its place), "
                         f"got '{options.out}'")
    with told_as(path="FILE"):
        model = write_scene_file(options.file, out, unit=options.unit, up=options.up)
    print("\n".join([*describe_model(Path(options.file), model), f"wrote {out}: echopath run {quote(str(out))} --out DIR"]))


def labels(options) -> None:
    from ..arguments.settings import LabelSettings
    from ..base.process.progress import progress_bars
    from .labels import label_file, objects_of_options

    require_writable(options.out, "--out")
    settings = LabelSettings(objects=objects_of_options(options.object), plane=options.plane,
                             dynamic_range_db=options.dynamic_range, noise_margin_db=options.noise_margin,
                             errors=options.errors)
    with progress_bars() as progress:
        lines = label_file(options.frame, options.out, settings=settings, parts=options.part, progress=progress,
                           cfar={"method": options.cfar, "false_alarm_rate": options.false_alarm_rate, "beams": options.beams})
    print("\n".join(lines))


def dataset(options) -> None:
    from .dataset import lines_of
    from .resumable import print_resumable

    with told_as(template="DATASET.toml", folder="--out"):
        print_resumable(lines_of(options), options.out)


def dataset_report(options) -> None:
    from ..dataset import open as open_dataset, write_report

    page = options.out or Path(options.folder) / "report.html"
    with told_as(folder="DIR"):
        write_report(open_dataset(options.folder), page)
    print(f"wrote {page}")


def bench(options) -> None:
    given = {name: getattr(options, name) for name in BENCH_OPTIONS if getattr(options, name) is not None}
    for name, value in given.items():
        if BENCH_OPTIONS[name] != options.what:
            raise ValueError(f"--{name.replace('_', '-')}: belongs to `echopath bench {BENCH_OPTIONS[name]}`, got {value}")

    from .. import bench as of
    from ..base.process.progress import progress_bars
    from ..bench import hard
    from ..bench.physics import report

    works = {"physics": (of.run_physics, report), "labels": (of.run_labels, of.labels), "hard": (hard.run_hard, hard),
             "certificate": (of.run_certificate, of.certificate), "crowd": (of.run_crowd, of.crowd),
             "speed": (of.run_speed, of.speed), "actors": (of.run_actors, of.actors), "measured": (of.run_measured, of.measured),
             "worlds": (of.run_worlds, of.worlds), "live": (of.run_live, of.live), "receiver": (of.run_receiver, of.receiver),
             "dataset": (of.run_dataset, of.dataset), "targets": (of.run_published, of.published),
             "replay": (of.run_replay, of.replay)}
    require_writable(options.out, "--out")
    run, benchmark = works[options.what]
    with progress_bars() as progress:
        lines = benchmark.describe(run(options.out, quick=options.quick, progress=progress, **given))
    if options.quick:
        print("quick run, for a look: few rays and repeats; limits are those of runs without --quick\n")
    print("\n".join(lines))
