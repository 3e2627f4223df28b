"""The options of each command."""
from __future__ import annotations

import argparse
from typing import get_args

from .. import _core
from ..arguments.keywords import default_of
from ..arguments.settings import LabelSettings, Plane
from ..base.storage.data_folder import data_folder
from ..readers.options import AXES
from ..sequence.keep import Keep
from ..spectra.range_doppler import CfarMethod, cfar
from ..viewing.viewer import view as open_viewer
from . import commands as work
from .demo import run_demo
from .numbers import named, natural, number_range, positive, seconds, shard

# What `echopath bench` measures, and what it tells of it.
BENCHES = {
    "physics": "levels of canonical targets",
    "replay": "one record against tracing every chirp and antenna",
    "labels": "cost of parts, rate of path expressions",
    "hard": "cases that break ray tracers and coherent sums, each with its bound",
    "speed": "synthesis beside FINUFFT, frames, memory",
    "crowd": "objects of a crowded scene against themselves alone",
    "certificate": "objects of random moving scenes against traces of every 8th chirp, and what `validity` says of them",
    "targets": "a pedestrian, a road and spheres beside published levels",
    "actors": "cross sections of vehicles, people and the rest over aspect",
    "measured": "plates, boxes, ducts and an almond of metal beside measurement and method of moments, with and without sharp "
                "edges",
    "worlds": "crowds, and cities of many walls and meshes, their mirror paths against a search over all walls, public ones "
              "beside Sionna RT, and files of others",
    "live": "scenes that change and go on in time, a drive through a city street",
    "receiver": "faults of receivers beside closed forms, codes of transmitters beside turns, and what they cost",
    "dataset": "frames of datasets by second and core, what each stage takes, growth and memory of workers"}


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
        wrong = next((word for word in unknown if word.startswith("--")), "")
        known = [option.removeprefix("--").replace("-", "_") for option in self._option_string_actions
                 if option.startswith("--")]
        meant = _core.meant_name(wrong.partition("=")[0].removeprefix("--").replace("-", "_"), known) if wrong else ""
        return f" (the nearest option is --{meant.replace('_', '-')})" if meant else ""


def command_parser() -> argparse.ArgumentParser:
    parser = _Command(prog="echopath", description="FMCW radar simulation by ray tracing.")
    parser.add_argument("--version", action="version", version=f"echopath {_core.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for add_command in (_add_demo, _add_run, _add_view, _add_info, _add_scene, _add_labels, _add_dataset, _add_dataset_report,
                        _add_bench):
        add_command(commands)
    return parser


def _add_demo(commands) -> None:
    demo = commands.add_parser("demo", help="simulate a pedestrian in a street and show what every ray touched")
    demo.add_argument("--out", type=named, default=default_of(run_demo, "out"), metavar="DIR",
                      help="folder of the results (default: %(default)s)")
    _add_trace_options(demo, default_rays=default_of(run_demo, "num_rays"))
    demo.add_argument("--view", action="store_true", help="then open it in the viewer")
    demo.set_defaults(command=work.demo)


def _add_run(commands) -> None:
    run = commands.add_parser("run", help="simulate a scene file")
    run.add_argument("scene", metavar="SCENE.toml", help=f"scene file (keys: {data_folder('README.md')})")
    run.add_argument("--out", type=named, required=True, metavar="DIR",
                     help="folder of the results, in the place of those of an earlier run; of frames in time also one file (.h5) "
                          "of all")
    _add_trace_options(run, default_rays=None)
    _add_part_option(run)
    run.add_argument("--truth", action="store_true",
                     help="also place, motion, box, visible share and cross section of each object, in frame.h5 and truth.csv "
                          "(default: as [truth] of the scene file says)")
    run.add_argument("--raw", metavar="OUT.bin", help="also what the converter gives, frame after frame as a DCA1000 writes it")
    _add_sequence_options(run)
    run.set_defaults(command=work.run)


def _add_view(commands) -> None:
    view = commands.add_parser("view", help="see which rays made which cell of a frame, or of frames in time")
    view.add_argument("frames", metavar="FRAME.h5", nargs="*",
                      help="frame file; several, a pattern or a folder of frames, a sequence or a dataset open as one time line "
                           "(default: an empty window)")
    view.add_argument("--state", metavar="VIEW.json", help="show it as a saved view says")
    view.add_argument("--picture", metavar="OUT.png", help="write what it shows and close it: .png the window, .svg or .pdf its "
                      "maps, .gif or .mp4 a film through frames or chirps, .html its scene with rays to be picked")
    view.add_argument("--scale", type=int, default=default_of(open_viewer, "scale"), metavar="N",
                      help="of a PNG: N times the pixels (default: %(default)s)")
    view.set_defaults(command=work.view)


def _add_info(commands) -> None:
    info = commands.add_parser("info", help="say what is in a scene, template, frame, mesh or foreign file, or in a folder of "
                                            "frames or of a dataset")
    info.add_argument("file", metavar="FILE", help=".toml, .h5, or a file or folder that load_model reads (.usd, .xml, .obj ...)")
    info.add_argument("--select", action="append", default=[], metavar="SELECTION",
                      help="also say which paths of a frame it takes, as in \"T .* 'wall*' .* R & power > 1e-17\"; may be "
                           "repeated")
    _add_unit_and_up(info)
    info.set_defaults(command=work.info)


def _add_scene(commands) -> None:
    scene = commands.add_parser("scene", help="write a scene file for a foreign scene, ready to run and to be edited")
    scene.add_argument("file", metavar="FILE", help="what load_model reads (.usd, .xml, .obj ...)")
    scene.add_argument("--out", type=named, required=True, metavar="SCENE.toml", help="scene file to be written")
    scene.add_argument("--overwrite", action="store_true", help="also in the place of a file that is there")
    _add_unit_and_up(scene)
    scene.set_defaults(command=work.scene)


def _add_labels(commands) -> None:
    labels = commands.add_parser("labels", help="say which part, object or ghost made each cell and detection of a frame")
    labels.add_argument("frame", metavar="FRAME.h5", help="frame file")
    labels.add_argument("--out", type=named, required=True, metavar="DIR",
                        help="folder of labels.h5, detections.csv, maps and pictures")
    _add_part_option(labels)
    labels.add_argument("--object", action="append", default=[], metavar="NAME=GLOB",
                        help="an object to report on, instead of the children of the scene's root; may be repeated, the "
                             "first that a path touches owns it")
    labels.add_argument("--plane", choices=get_args(Plane), default=LabelSettings.plane,
                        help="whose cells are labelled (default: %(default)s)")
    labels.add_argument("--dynamic-range", type=float, default=LabelSettings.dynamic_range_db, metavar="DB",
                        help="how far below the peak of the echoes cells are labelled (default: %(default)s)")
    labels.add_argument("--noise-margin", type=float, default=LabelSettings.noise_margin_db, metavar="DB",
                        help="by how much they stand out of the noise (default: %(default)s)")
    labels.add_argument("--errors", action="store_true", help="standard errors too, of frames traced with batches")
    labels.add_argument("--cfar", choices=get_args(CfarMethod), default=default_of(cfar, "method"),
                        help="how echoes are detected (default: %(default)s)")
    labels.add_argument("--false-alarm-rate", type=float, default=default_of(cfar, "false_alarm_rate"), metavar="P",
                        help="of a cell of noise (default: %(default)s)")
    labels.add_argument("--beams", action="store_true", help="tests cells in beams of the array: weaker echoes of large arrays")
    labels.set_defaults(command=work.labels)


def _add_dataset(commands) -> None:
    dataset = commands.add_parser("dataset", help="make the labelled frames of a template, each scene drawn anew")
    dataset.add_argument("template", metavar="DATASET.toml", help=f"template (keys: {data_folder('README.md')})")
    dataset.add_argument("--out", type=named, required=True, metavar="DIR",
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
    dataset.set_defaults(command=work.dataset)


def _add_dataset_report(commands) -> None:
    report = commands.add_parser("dataset-report", help="write a page about what a dataset holds")
    report.add_argument("folder", metavar="DIR", help="folder of the dataset")
    report.add_argument("--out", type=named, default=None, metavar="PAGE.html", help="(default: DIR/report.html)")
    report.set_defaults(command=work.dataset_report)


def _add_bench(commands) -> None:
    bench = commands.add_parser("bench", help="measure error and speed side by side")
    bench.add_argument("what", choices=list(BENCHES), metavar="WHAT",
                       help="; ".join(f"{what}: {measured}" for what, measured in BENCHES.items()))
    bench.add_argument("--out", type=named, required=True, metavar="DIR", help="folder of its results")
    bench.add_argument("--quick", action="store_true", help="few shifts and rays, for a look; hard: without the heavy cases")
    _add_of_one(bench, "--rays-max", "N", f"most rays of a trace (default: {2**16})", positive)
    _add_of_one(bench, "--scenes", "N", "how many (default: a few dozen)", positive)
    _add_of_one(bench, "--seeds", "N",
                "scenes of each echo whose coverage is measured (default: 20 to 60, some ten minutes in all)", positive)
    _add_of_one(bench, "--suite", "DIR", "a checkout of the Austin RCS Benchmark Suite, for its PRIME aircraft, too")
    _add_of_one(bench, "--cities", "DIR", "a folder of scenes as sionna-rt ships them (default: its own, where it is installed)")
    _add_of_one(bench, "--sionna", "PYTHON",
                "a Python that has sionna-rt, whose paths and seconds stand beside ours (default: this one)")
    _add_of_one(bench, "--models", "DIR", "a folder of models and cities, each of which is read in one call")
    bench.set_defaults(command=work.bench)


def _add_of_one(bench, option: str, metavar: str, text: str, kind=str) -> None:
    """Adds an option that one benchmark alone has, which its help tells first."""
    owner = work.BENCH_OPTIONS[option.removeprefix("--").replace("-", "_")]
    bench.add_argument(option, type=kind, default=None, metavar=metavar, help=f"{owner}: {text}")


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
    parser.add_argument("--keep", choices=get_args(Keep), default=None,
                        help="what the file of each frame keeps: all, maps with labels and detections, or labels and "
                             "detections alone (default: that of the scene file, or all)")


def _add_unit_and_up(parser) -> None:
    parser.add_argument("--unit", type=float, metavar="M", help="m per unit of a foreign file (default: as it says)")
    parser.add_argument("--up", choices=sorted(AXES), help="vertical axis of a foreign file (default: as it says)")


def _add_part_option(parser) -> None:
    parser.add_argument("--part", action="append", default=[], metavar="NAME=SELECTION",
                        help="a part of a partition \"choice\" of its own, as in walls=\"T .* 'wall*' .* R\"; may be "
                             "repeated, the first that takes a path has it")
