"""A forward and a backward step of TMVA-Net on a dataset of ours, by the loaders of its authors as they are.

    git clone https://github.com/valeoai/MVRSS; pip install torch scikit-image
    PYTHONPATH=MVRSS python mvrss/utils/set_paths.py --carrada FOLDER      # in MVRSS: the folder of `write_carrada`
    PYTHONPATH=MVRSS python tests/bench/mvrss_step.py

Input is scaled by their fixed statistics, the loss is theirs (weighted cross entropy, soft Dice, coherence). Prints shapes, the
ends of the scaled input and the loss before and after a step of Adam, which must fall.
"""
from __future__ import annotations

import sys

import torch
from mvrss.loaders.dataloaders import CarradaDataset, SequenceCarradaDataset
from mvrss.loaders.dataset import Carrada
from mvrss.models import TMVANet
from mvrss.utils.functions import define_loss, get_transformations, normalize
from mvrss.utils.paths import Paths
from torch.utils.data import DataLoader

NUM_CLASSES, NUM_FRAMES, STEPS = 4, 5, 2
VIEWS = {"rd": "range_doppler", "ra": "range_angle", "ad": "angle_doppler"}


def batches(split: str):
    """The batches of all sequences of a split, as their training has them."""
    for names, frames in DataLoader(SequenceCarradaDataset(Carrada().get(split)), batch_size=1):
        own = CarradaDataset(frames, "dense", Paths().get()["carrada"] / names[0], True, NUM_FRAMES,
                             get_transformations(["hflip", "vflip"]), add_temp=True)
        yield from DataLoader(own, batch_size=1)


def loss_of(net, batch, criteria):
    inputs = [normalize(batch[f"{short}_matrix"].float(), name, norm_type="tvt") for short, name in VIEWS.items()]
    outputs = net(*inputs)
    losses = [sum(criterion(output, torch.argmax(batch[f"{short}_mask"].float(), axis=1)) for criterion in own[:2]) / 2
              for short, output, own in zip(VIEWS, outputs, criteria)]
    return sum(losses) + criteria[0][2](*outputs), inputs, outputs


def main() -> int:
    torch.manual_seed(1)
    counts = {split: sum(1 for _ in batches(split)) for split in ("Train", "Validation", "Test")}
    print("samples by their loaders:", counts, flush=True)
    batch = next(one for one in batches("Train") if one["ra_mask"][:, 1:].any() and one["rd_mask"][:, 1:].any())
    net = TMVANet(NUM_CLASSES, NUM_FRAMES)
    criteria = [define_loss(name, "wce_w10sdice_w5col", "cpu") for name in ("range_doppler", "range_angle")]
    optimizer = torch.optim.Adam(net.parameters(), lr=1e-4)
    values = []
    for _ in range(STEPS):
        optimizer.zero_grad()
        loss, inputs, outputs = loss_of(net, batch, criteria)
        loss.backward()
        optimizer.step()
        values.append(loss.item())
        print(f"loss {values[-1]:.4f}", flush=True)
    for name, scaled in zip(VIEWS.values(), inputs):
        print(f"{name}: {list(scaled.shape)}, scaled to {scaled.min():.3f} ... {scaled.max():.3f}, mean {scaled.mean():.3f}")
    print("outputs:", *(list(output.shape) for output in outputs))
    return 0 if all(scaled.min() >= 0.0 and scaled.max() <= 1.0 for scaled in inputs) and values[-1] < values[0] else 1


if __name__ == "__main__":
    sys.exit(main())
