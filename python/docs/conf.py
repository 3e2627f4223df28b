"""Configuration of the documentation site: `./bootstrap.sh docs` builds it into out/docs.

Reference pages are made of docstrings; the gallery and the notebooks of python/examples are executed while the site is built.
What the build generates below this folder (`generated/`) is not kept.
"""
import shutil
import sys
import warnings
from pathlib import Path

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parent / "examples"
GENERATED = HERE / "generated"
SECTIONS = ("first_steps", "bodies", "signals", "arrays", "labels", "files")  # of the gallery, in the order of its page
sys.path.insert(0, str(HERE / "_extensions"))

import matplotlib

import echopath
import echopath.plots

matplotlib.use("agg")

project, author, copyright = "Echopath", "the authors of Echopath", "the authors of Echopath"
version = release = echopath.__version__

extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.mathjax", "sphinx_gallery.gen_gallery", "myst_nb",
              "house_docstrings"]
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb", ".ipynb": "myst-nb"}
exclude_patterns = ["_templates", "_extensions", "generated/**/*.py", "generated/gallery/**/*.ipynb", "generated/**/*.zip"]
templates_path = ["_templates"]
html_theme = "furo"
html_title = f"Echopath {release}"
html_show_copyright = False

autosummary_generate = True
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
suppress_warnings = ["ref.python"]  # the type `object` of a signature is also an attribute of two classes

myst_enable_extensions = ["amsmath", "dollarmath", "deflist"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_merge_streams = True

sphinx_gallery_conf = {
    "examples_dirs": str(EXAMPLES),
    "gallery_dirs": "generated/gallery",
    "filename_pattern": r"\.py$",
    "ignore_pattern": r"notebooks",
    "subsection_order": [f"../examples/{section}" for section in SECTIONS],
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": ("gallery_pictures.save_figures",),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "remove_config_comments": True,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 1e6,
    "write_computation_times": False,
    "notebook_images": False,
}


def copy_notebooks() -> None:
    """Brings the notebooks below the folder that Sphinx reads."""
    target = GENERATED / "notebooks"
    target.mkdir(parents=True, exist_ok=True)
    for notebook in (EXAMPLES / "notebooks").glob("*.ipynb"):
        shutil.copyfile(notebook, target / notebook.name)


copy_notebooks()
for category in (echopath.TessellationWarning, echopath.GuardWarning, RuntimeWarning):
    warnings.simplefilter("error", category)  # an example that makes the program warn is no example
