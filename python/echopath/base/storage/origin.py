"""What made a file: the version of the program and the seeds, in words that pictures and tables carry along."""
from __future__ import annotations

import os
from pathlib import Path

from ... import _core
from .files import written_whole

FIXED_SEEDS = "fixed in the source of this version"  # of benchmarks


def origin_texts(seed=None, noise_seed=None) -> dict:
    """{"Software", "Seed", "Noise seed": text}, without the seeds that are None.

    seed: of the rays; noise_seed: of the thermal noise
    """
    seeds = {"Seed": seed, "Noise seed": noise_seed}
    told = {name: str(value) for name, value in seeds.items() if value is not None}
    return {"Software": f"echopath {_core.__version__}"} | told


def mark_png(path, texts: dict) -> None:
    """Adds text chunks {keyword: text} to the PNG file at `path`; other files are left as they are."""
    from PIL import Image

    if Path(path).suffix.lower() != ".png" or not os.path.exists(path):
        return
    with Image.open(path) as image, written_whole(path) as temporary:
        image.save(temporary, format="PNG", pnginfo=png_info(texts))


def png_info(texts: dict):
    """Text chunks as PIL takes them, in Latin-1 or UTF-8 as needed."""
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    for keyword, text in texts.items():
        info.add_text(keyword, text)
    return info
