"""The command line: echopath demo | run | view | info | scene | labels | dataset | bench."""
from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from .. import DeviceError
from .._startup import EXIT_INTERRUPTED, STOPPED, loading_is_over
from ..base.files import require_writable
from .numbers import natural, number_range, positive, seconds, shard

EXIT_BAD_INPUT = 2


def main(arguments=None) -> int:
    """Runs one command and returns its exit code: 0, 2 for bad input, 130 after Ctrl-C."""
    try:
        loading_is_over()
        options = _parser().parse_args(arguments)
        options.command(options)
        sys.stdout.flush()
    except KeyboardInterrupt:
        print(f"\n{STOPPED}", file=sys.stderr)
        return EXIT_INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (ValueError, OSError, ModuleNotFoundError, DeviceError) as error:
        print(f"echopath: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except MemoryError:
        print("echopath: not enough memory; fewer rays (--rays) need less", file=sys.stderr)
        return EXIT_BAD_INPUT
    return 0


class _Command(argparse.ArgumentParser):
    """A command that says itself, with its own usage, which of its options are wrong; none may be shortened."""

    def __init__(self, **settings):
        super().__init__(allow_abbrev=False, **settings)

    def parse_known_args(self, args=None, namespace=None):
        options, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}{self._nearest_option(unknown)}")
        return options, unknown

    def _nearest_option(self, unknown) -> str:
        from .. import _core

        wrong = next((word for word in unknown if word.startswith("--")), "")
        known = [option.removeprefix("--").replace("-", "_") for option in self._option_string_actions
                 if option.startswith("--")]
        meant = _core.meant_name(wrong.partition("=")[0].removeprefix("--").replace("-", "_"), known) if wrong else ""
        return f" (the nearest option is --{meant.replace('_', '-')})" if meant else ""


def _parser() -> argparse.ArgumentParser:
    import echopath as ep

    parser = _Command(prog="echopath", description="FMCW radar simulation by ray tracing.")
    parser.add_argument("--version", action="version", version=f"echopath {ep.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    demo = commands.add_parser("demo", help="simulate a pedestrian in a street and show what every ray touched")
    demo.add_argument("--out", default="out/demo", metavar="DIR", help="folder of the results (default: %(default)s)")
    _add_trace_options(demo, default_rays=200_000)
    demo.add_argument("--view", action="store_true", help="then open it in the viewer")
    demo.set_defaults(command=_demo)

    run = commands.add_parser("run", help="simulate a scene file")
    run.add_argument("scene", metavar="SCENE.toml", help="scene file (keys: data/README.md)")
    run.add_argument("--out", required=True, metavar="DIR", help="folder of the results")
    _add_trace_options(run, default_rays=None)
    _add_part_option(run)
    run.add_argument("--truth", action="store_true",
                     help="also place, motion, box, visible share and cross section of each object, in frame.h5 and truth.csv "
                          "(default: as [truth] of the scene file says)")
    run.add_argument("--raw", metavar="OUT.bin", help="also what the converter gives, frame after frame as a DCA1000 writes it")
    _add_sequence_options(run)
    run.set_defaults(command=_run)

    view = commands.add_parser("view", help="see which rays made which cell of a frame, or of frames in time")
    view.add_argument("frames", metavar="FRAME.h5", nargs="*",
                      help="frame file; several, a pattern or a folder of frames, a sequence or a dataset open as one time line "
                           "(default: an empty window)")
    view.add_argument("--state", metavar="VIEW.json", help="show it as a saved view says")
    view.add_argument("--picture", metavar="OUT.png", help="write what it shows and close it: .png the window, .svg or .pdf its "
                      "maps, .gif or .mp4 a film through frames or chirps, .html its scene with rays to be picked")
    view.add_argument("--scale", type=int, default=1, metavar="N", help="of a PNG: N times the pixels (default: %(default)s)")
    view.set_defaults(command=_view)

    info = commands.add_parser("info", help="say what is in a scene, template, frame, mesh or foreign file, or in a folder of "
                                            "frames or of a dataset")
    info.add_argument("file", metavar="FILE", help=".toml, .h5, or a file or folder that load_model reads (.usd, .xml, .obj ...)")
    info.add_argument("--select", action="append", default=[], metavar="SELECTION",
                      help="also say which paths of a frame it takes, as in \"T .* 'wall*' .* R & power > 1e-17\"; may be "
                           "repeated")
    info.set_defaults(command=_info)

    scene = commands.add_parser("scene", help="write a scene file for a foreign scene, ready to run and to be edited")
    scene.add_argument("file", metavar="FILE", help="what load_model reads (.usd, .xml, .obj ...)")
    scene.add_argument("--out", required=True, metavar="SCENE.toml", help="scene file to be written")
    scene.add_argument("--unit", type=float, metavar="M", help="m per unit of the file (default: as the file says)")
    scene.add_argument("--up", choices=["x", "y", "z"], help="its vertical axis (default: as the file says)")
    scene.set_defaults(command=_scene)

    _add_labels(commands)
    _add_dataset(commands)

    bench = commands.add_parser("bench", help="measure error and speed side by side")
    bench.add_argument("what", choices=["physics", "replay", "labels", "hard", "speed", "crowd", "certificate", "targets",
                                           "actors", "measured", "worlds", "live", "receiver", "dataset"],
                       help="physics: levels of canonical targets; replay: one record against tracing every chirp and "
                            "antenna; labels: cost of parts, rate of path expressions; hard: cases that break ray tracers "
                            "and coherent sums, each with its bound; speed: synthesis beside FINUFFT, frames, memory; "
                            "crowd: objects of a crowded scene against themselves alone; certificate: objects of random "
                            "moving scenes against traces of every 8th chirp, and what `validity` says of them; targets: a "
                            "pedestrian, a road and spheres beside published levels; actors: cross sections of vehicles, "
                            "people and the rest over aspect; measured: a plate and a box of metal beside measurement and "
                            "method of moments, with and without sharp edges; worlds: crowds, and cities of many walls and "
                            "meshes, their mirror paths against a search over all walls; live: scenes that change and go on in "
                            "time, a drive through a city street; receiver: faults of receivers beside closed forms, codes of "
                            "transmitters beside turns, and what they cost; dataset: frames of datasets by second and core, what "
                            "each stage takes, growth and memory of workers")
    bench.add_argument("--out", required=True, metavar="DIR", help="folder of its results")
    bench.add_argument("--quick", action="store_true", help="few shifts and rays, for a look; hard: without the heavy cases")
    bench.add_argument("--rays-max", type=positive, default=2**16, metavar="N",
                       help="physics: most rays of a trace (default: %(default)s)")
    bench.add_argument("--scenes", type=positive, default=None, metavar="N", help="certificate: how many (default: a few dozen)")
    bench.set_defaults(command=_bench)
    return parser


def _add_labels(commands) -> None:
    labels = commands.add_parser("labels", help="say which part, object or ghost made each cell and detection of a frame")
    labels.add_argument("frame", metavar="FRAME.h5", help="frame file")
    labels.add_argument("--out", required=True, metavar="DIR", help="folder of labels.h5, detections.csv, maps and pictures")
    _add_part_option(labels)
    labels.add_argument("--object", action="append", default=[], metavar="NAME=GLOB",
                        help="an object to report on, instead of the children of the scene's root; may be repeated, the "
                             "first that a path touches owns it")
    labels.add_argument("--plane", choices=["range_doppler", "range_azimuth"], default="range_doppler",
                        help="whose cells are labelled (default: %(default)s)")
    labels.add_argument("--dynamic-range", type=float, default=60.0, metavar="DB",
                        help="how far below the peak cells are labelled (default: %(default)s)")
    labels.add_argument("--noise-margin", type=float, default=10.0, metavar="DB",
                        help="by how much they stand out of the noise (default: %(default)s)")
    labels.add_argument("--errors", action="store_true", help="standard errors too, of frames traced with batches")
    labels.add_argument("--cfar", choices=["ca", "os"], default="ca", help="how echoes are detected (default: %(default)s)")
    labels.add_argument("--false-alarm-rate", type=float, default=1e-6, metavar="P",
                        help="of a cell of noise (default: %(default)s)")
    labels.set_defaults(command=_labels)


def _add_dataset(commands) -> None:
    dataset = commands.add_parser("dataset", help="make the labelled frames of a template, each scene drawn anew")
    dataset.add_argument("template", metavar="DATASET.toml", help="template (keys: data/README.md)")
    dataset.add_argument("--out", required=True, metavar="DIR",
                         help="folder of the dataset; the same command goes on where it was stopped")
    dataset.add_argument("--workers", type=positive, default=1, metavar="N",
                         help="processes, which share the processors (default: %(default)s)")
    dataset.add_argument("--scheduler", default=None, metavar="ADDRESS",
                         help="of a Dask scheduler, such as tcp://host:8786, whose workers make the scenes; --out may then be an "
                              "address of fsspec, such as s3://bucket/folder")
    dataset.add_argument("--shard", type=shard, default=None, metavar="K/N",
                         help="every N-th scene alone, from the K-th on, while others make the other shards in the same folder")
    dataset.add_argument("--frames", type=number_range, default=None, metavar="A:B",
                         help="the scenes alone that one of the frames A to B - 1 belongs to, from 0 (default: all)")
    dataset.add_argument("--only-failed", action="store_true", help="make those scenes again, and no others, that failed")
    dataset.set_defaults(command=_dataset)
    report = commands.add_parser("dataset-report", help="write a page about what a dataset holds")
    report.add_argument("folder", metavar="DIR", help="folder of the dataset")
    report.add_argument("--out", default=None, metavar="PAGE.html", help="(default: DIR/report.html)")
    report.set_defaults(command=_dataset_report)


def _add_trace_options(parser, default_rays) -> None:
    default = "%(default)s" if default_rays else "that of the scene file"
    parser.add_argument("--rays", type=positive, default=default_rays, metavar="N",
                        help=f"number of rays (default: {default})")
    parser.add_argument("--seed", type=natural, default=None, metavar="N",
                        help="of the rays (default: that of the scene file)")
    parser.add_argument("--batches", type=positive, default=None, metavar="N",
                        help="parts of the rays, which give mean powers over the random phases with standard errors, beside "
                             "those of the one realisation that the maps show (default: that of the scene file)")


def _add_sequence_options(parser) -> None:
    parser.add_argument("--frames", type=positive, default=None, metavar="N",
                        help="so many frames in time, a file each; the same command goes on where it was stopped (default: "
                             "that of the scene file, or one frame with pictures)")
    parser.add_argument("--interval", type=seconds, default=None, metavar="S",
                        help="s from the start of a frame to that of the next (default: that of the scene file)")
    parser.add_argument("--shard", type=shard, default=None, metavar="K/N",
                        help="every N-th frame alone, from the K-th on, while other processes write the other shards to the "
                             "same folder")
    parser.add_argument("--keep", choices=["all", "maps", "labels"], default=None,
                        help="what the file of each frame keeps: all, maps with labels and detections, or labels and "
                             "detections alone (default: that of the scene file, or all)")


def _add_part_option(parser) -> None:
    parser.add_argument("--part", action="append", default=[], metavar="NAME=SELECTION",
                        help="a part of a partition \"choice\" of its own, as in ghosts=\"T .* 'wall*' .* R\"; may be "
                             "repeated, the first that takes a path has it")


def _demo(options) -> None:
    from .demo import run_demo
    from ..base.progress import progress_bars

    require_writable(options.out, "--out")
    if options.view:
        from echopath_viewer import require_window

        require_window()
    with progress_bars() as progress:
        frame = run_demo(options.out, num_rays=options.rays, seed=options.seed, batches=options.batches, progress=progress)
    if options.view:
        import echopath as ep

        ep.view(frame)


def _view(options) -> None:
    import echopath as ep

    if options.picture is not None:
        require_writable(Path(options.picture).parent, "--picture")
    frames = options.frames[0] if len(options.frames) == 1 else options.frames
    ep.view(*([frames] if frames else []), state=options.state, picture=options.picture, scale=options.scale)


def _run(options) -> None:
    from . import report
    from ..base.progress import progress_bars
    from .run import certify, chosen_partition, raw_line, simulate_file, write_outputs
    from .run_sequence import is_sequence, run_sequence
    from ..scene_file import load_scene

    require_writable(options.out, "--out")
    if options.raw is not None:
        require_writable(Path(options.raw).parent, "--raw")
    scene_file = load_scene(options.scene)
    if scene_file.radar is None:
        raise ValueError(f"{options.scene}: has no radar; 'echopath scene {options.scene} --out SCENE.toml' writes a scene file "
                         "with one, where [[objects]] names it as model")
    chosen = chosen_partition(options.part, scene_file.partitions())
    if is_sequence(scene_file, options):
        for line in run_sequence(scene_file, options, chosen):
            print(line, flush=True)
        return
    with progress_bars() as progress:
        frame = simulate_file(scene_file, num_rays=options.rays, seed=options.seed,
                              batches=options.batches, extra_parts=chosen, truth=options.truth or None, progress=progress)
        certificate = certify(frame, progress=progress)
        written = write_outputs(frame, options.out, partitions=frame.parts)
    if options.raw is not None:
        print(raw_line(options.raw, frame.save_raw(options.raw)))
    for text in [scene_file.title or options.scene, *report.counts(frame.paths),
                 *report.overlaps(frame.scene, frame.paths.frame.trace_time), *report.effects(frame.effects),
                 *report.stages(frame.stages), *report.powers(frame.cube, frame.parts), *report.mean_powers(frame),
                 *report.labels(frame.labels), *report.detections(frame.detections),
                 *report.truth(frame.kept_truth), *report.checks(frame.checks), *report.validity(certificate),
                 *report.files(written), *report.unresolved(frame.unresolved)]:
        print(text)


def _info(options) -> None:
    from .info import describe_file

    print("\n".join(describe_file(options.file, options.select)))


def _scene(options) -> None:
    from .model_info import describe_model
    from ..scene_file.write import write_scene_file

    out = Path(options.out)
    if out.suffix.lower() != ".toml":
        raise ValueError(f"--out: must be a file .toml, got '{options.out}'")
    model = write_scene_file(options.file, out, unit=options.unit, up=options.up)
    print("\n".join([*describe_model(Path(options.file), model), f"wrote {out}: echopath run {out} --out DIR"]))


def _labels(options) -> None:
    from ..arguments.settings import LabelSettings
    from .labels import label_file, objects_of_options
    from ..base.progress import progress_bars

    require_writable(options.out, "--out")
    settings = LabelSettings(objects=objects_of_options(options.object), plane=options.plane,
                             dynamic_range_db=options.dynamic_range, noise_margin_db=options.noise_margin,
                             errors=options.errors)
    with progress_bars() as progress:
        lines = label_file(options.frame, options.out, settings=settings, parts=options.part, progress=progress,
                           cfar={"method": options.cfar, "false_alarm_rate": options.false_alarm_rate})
    print("\n".join(lines))


def _dataset(options) -> None:
    from .dataset import lines_of

    for line in lines_of(options):
        print(line, flush=True)


def _dataset_report(options) -> None:
    from ..dataset import write_report

    page = options.out or Path(options.folder) / "report.html"
    write_report(options.folder, page)
    print(f"wrote {page}")


def _bench(options) -> None:
    from ..bench import (actors, certificate, crowd, dataset, hard, labels, live, measured, published, receiver, replay, report,
                         run_actors, run_certificate, run_crowd, run_dataset, run_labels, run_live, run_measured, run_physics,
                         run_published, run_receiver, run_replay, run_speed, run_worlds, speed, worlds)
    from ..base.progress import progress_bars

    works = {"physics": (run_physics, report.describe), "labels": (run_labels, labels.describe),
             "hard": (hard.run_hard, hard.describe), "certificate": (run_certificate, certificate.describe),
             "crowd": (run_crowd, crowd.describe), "speed": (run_speed, speed.describe),
             "actors": (run_actors, actors.describe), "measured": (run_measured, measured.describe),
             "worlds": (run_worlds, worlds.describe), "live": (run_live, live.describe),
             "receiver": (run_receiver, receiver.describe), "dataset": (run_dataset, dataset.describe),
             "targets": (run_published, published.describe), "replay": (run_replay, replay.describe)}
    more = {"physics": {"rays_max": options.rays_max}, "certificate": {"scenes": options.scenes}}
    require_writable(options.out, "--out")
    run, describe = works[options.what]
    with progress_bars() as progress:
        lines = describe(run(options.out, quick=options.quick, progress=progress, **more.get(options.what, {})))
    print("\n".join(lines))
