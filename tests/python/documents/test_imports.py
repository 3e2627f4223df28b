"""Imports between modules of the package and of its viewer go one way, as far as the text of the modules tells."""
import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PACKAGES = (ROOT / "python" / "echopath", ROOT / "viewer" / "echopath_viewer")

# Imports within functions that close a circle, and why each may.
CLOSING = {
    ("echopath.viewing.viewer", "echopath_viewer"): "ep.view and ep.plot_rays start the viewer",
    ("echopath.frame.frame", "echopath_viewer"): "Frame.show makes a page with what draws scenes in the viewer",
    ("echopath.scene.scene", "echopath_viewer"): "Scene.to_pyvista makes blocks with the viewer's code",
    ("echopath.frame.frame", "echopath.frame_file"): "Frame.save writes with what also reads frames",
    ("echopath.frame.frame", "echopath.sensor_files"): "Frame.save_raw writes with what writes several frames",
    ("echopath.readers.model", "echopath.scene.along"): "Model.along makes another model of its nodes",
    ("echopath.cli.commands", "echopath_viewer"): "`echopath view` starts the viewer, whose demo is that of the command line",
}


def modules_of(packages) -> dict:
    """{name: (its file, whether it is a package)}"""
    found = {}
    for package in packages:
        for file in package.rglob("*.py"):
            *parents, own = file.relative_to(package.parent).with_suffix("").parts
            name = ".".join(parents if own == "__init__" else [*parents, own])
            found[name] = (file, own == "__init__")
    return found


def statements(node, in_function=False):
    """(import statement, whether it stands in a function); not those that only type checkers read."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.Import, ast.ImportFrom)):
            yield child, in_function
        elif not (isinstance(child, ast.If) and isinstance(child.test, ast.Name) and child.test.id == "TYPE_CHECKING"):
            yield from statements(child, in_function or isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)))


def base_of(statement, name: str, is_package: bool) -> str:
    """The module that `from ... import` names."""
    if not statement.level:
        return statement.module
    parts = name.split(".") if is_package else name.split(".")[:-1]
    parts = parts[:len(parts) - statement.level + 1]
    return ".".join(parts + ([statement.module] if statement.module else []))


def named_modules(statement, name: str, modules: dict):
    """Modules that a statement in the module `name` names; of an extension such as echopath._core, none."""
    if isinstance(statement, ast.Import):
        yield from (alias.name for alias in statement.names if alias.name in modules)
        return
    base = base_of(statement, name, modules[name][1])
    for alias in statement.names:
        if f"{base}.{alias.name}" in modules:
            yield f"{base}.{alias.name}"
        elif base in modules and alias.name != "_core":
            yield base


def with_packages(target: str, name: str) -> list:
    """The module and those packages around it that its import runs first, unless they are around `name`, too."""
    parts = target.split(".")
    around = [".".join(parts[:count]) for count in range(1, len(parts))]
    return [target, *(package for package in around if not f"{name}.".startswith(f"{package}."))]


def imports_of(packages) -> dict:
    """{(module, what it imports): whether all its imports of that stand in functions}"""
    modules, found = modules_of(packages), {}
    for name, (file, _) in modules.items():
        for statement, is_late in statements(ast.parse(file.read_text())):
            for target in named_modules(statement, name, modules):
                for one in with_packages(target, name):
                    if one != name:
                        found[name, one] = found.get((name, one), True) and is_late
    return found


def circle_of(edges):
    """Modules in the order in which each imports the next and the last the first, or [] where there is no circle."""
    after = {}
    for source, target in edges:
        after.setdefault(source, []).append(target)
    done, way = set(), []

    def follow(name):
        if name in way:
            return way[way.index(name):]
        if name in done:
            return []
        way.append(name)
        circle = next(filter(None, map(follow, after.get(name, ()))), [])
        way.pop()
        done.add(name)
        return circle

    return next(filter(None, map(follow, list(after))), [])


@pytest.fixture(scope="module")
def imports():
    return imports_of(PACKAGES)


def test_modules_import_in_no_circle(imports):
    assert circle_of(edge for edge, is_late in imports.items() if not is_late) == []


def test_imports_in_functions_close_only_the_circles_that_are_listed(imports):
    assert circle_of(edge for edge in imports if edge not in CLOSING) == []


@pytest.mark.parametrize("edge", CLOSING, ids=" -> ".join)
def test_listed_imports_stand_in_functions_and_close_a_circle(imports, edge):
    assert imports[edge]
    assert circle_of(other for other in imports if other == edge or other not in CLOSING)


# The packages in the order in which data goes through them: each imports what stands before it alone, within functions, too.
ORDER = ("_startup", "arguments", "base", "trajectories", "actors", "weather", "readers", "scene", "transmit", "receiver",
         "paths", "cavities", "tracing", "signals", "spectra", "presentation", "effects", "plots", "labels", "detections",
         "truth", "guard", "frame", "frame_file", "tracks", "sequence", "in_time", "sensor_files", "live", "scene_file",
         "dataset", "viewing", "bench", "cli", "__main__")
VIEWER_ORDER = ("libraries", "off_screen", "model", "scene_builder", "plot", "window")  # behind all of echopath
AGAINST_ORDER = {*CLOSING, ("echopath.scene.scene", "echopath.presentation.notebook")}  # the table of Scene in a notebook


def against_order(imports) -> set:
    """Imports of a package by one before it, but for those in methods that are known to close a circle."""
    known = {(source, one) for source, target in AGAINST_ORDER for one in with_packages(target, source)}
    in_order = [*(f"echopath.{name}" for name in ORDER), *(f"echopath_viewer.{name}" for name in VIEWER_ORDER)]
    place = {name: index for index, name in enumerate(in_order)}
    placed = [(edge, *(place.get(".".join(name.split(".")[:2])) for name in edge)) for edge in imports if edge not in known]
    return {edge for edge, source, target in placed if None not in (source, target) and source < target}


def test_packages_import_in_their_order(imports):
    assert against_order(imports) == set()


def test_an_import_against_the_order_is_found():
    edges = [("echopath.labels.cells", "echopath.spectra.maps"), ("echopath.spectra.maps", "echopath.labels"),
             ("echopath", "echopath.labels"), ("echopath.signals.sums", "echopath.signals"),
             ("echopath_viewer.model.rays", "echopath.labels"), ("echopath_viewer.model.rays", "echopath_viewer.window")]
    assert against_order(edges) == {edges[1], edges[-1]}


@pytest.mark.parametrize("package, order", list(zip(PACKAGES, (ORDER, VIEWER_ORDER))), ids=["echopath", "viewer"])
def test_the_order_names_each_package(package, order):
    assert sorted(order) == sorted({name.split(".")[1] for name in modules_of([package]) if "." in name})


def test_the_package_loads_without_its_viewer(imports):
    outward = [edge for edge, is_late in imports.items()
               if not is_late and edge[0].split(".")[0] == "echopath" and edge[1].split(".")[0] != "echopath"]
    assert outward == []


# Two modules of a package, and the circle that they make.
CIRCLES = {
    "relative": ("from .b import x", "from .a import y", ["p.a", "p.b"]),
    "module from its package": ("from . import b", "from . import a", ["p.a", "p.b"]),
    "absolute": ("import p.b", "from p.a import y", ["p.a", "p.b"]),
    "under a condition": ("if 1:\n    from .b import x", "try:\n    from . import a\nfinally:\n    pass", ["p.a", "p.b"]),
    "one way": ("from .b import x", "import json", []),
    "of the extension": ("from .b import x", "from . import _core", []),
    "of types alone": ("from .b import x", "if TYPE_CHECKING:\n    from .a import y", []),
    "in a function": ("from .b import x", "def f():\n    from .a import y", []),
}


@pytest.mark.parametrize("first, second, expected", CIRCLES.values(), ids=CIRCLES)
def test_circles_are_found(tmp_path, first, second, expected):
    package = tmp_path / "p"
    package.mkdir()
    for name, text in {"__init__": "", "a": first, "b": second}.items():
        (package / f"{name}.py").write_text(text + "\n")
    assert sorted(circle_of(edge for edge, is_late in imports_of([package]).items() if not is_late)) == expected


def test_a_package_that_runs_first_is_part_of_the_circle(tmp_path):
    """q.inner runs q/__init__ first, which needs what asks for q.inner."""
    for name, text in {"p": "from q.inner import x", "q/__init__": "import p", "q/inner": ""}.items():
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.with_suffix(".py").write_text(text + "\n")
    (tmp_path / "p.py").rename(tmp_path / "moved.py")
    (tmp_path / "p").mkdir()
    (tmp_path / "moved.py").rename(tmp_path / "p" / "__init__.py")
    imports = imports_of([tmp_path / "p", tmp_path / "q"])
    assert sorted(circle_of(imports)) == ["p", "q"]


def patches_in(tree):
    """Lines at the top of a module that give an attribute to a class that it imports, found by its capital."""
    imported = {alias.asname or alias.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for alias in node.names}
    for statement in tree.body:
        for target in getattr(statement, "targets", ()):
            owner = getattr(target, "value", None)
            name = getattr(owner, "attr", None) or getattr(owner, "id", "")
            root = getattr(getattr(owner, "value", owner), "id", "")
            if isinstance(target, ast.Attribute) and name[:1].isupper() and root in imported:
                yield statement.lineno


def test_no_class_is_patched_from_another_file():
    text = "from . import _core\n_core.Paths.save = 3\nfrom .a import Labels\nLabels.plot = 3"
    assert list(patches_in(ast.parse(text))) == [2, 4]
    found = {name: lines for name, (file, _) in modules_of(PACKAGES).items()
             if (lines := list(patches_in(ast.parse(file.read_text()))))}
    assert found == {}


def test_datasets_and_what_they_need_are_imported_when_they_are_asked_for():
    asked = "import sys, echopath; print(*(name for name in sys.modules if name.startswith('echopath.dataset')))"
    assert subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True).stdout == "\n"
