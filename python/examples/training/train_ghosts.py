"""Trains a small network to tell ghosts from objects by cell, and reports its IoU on held-out scenes beside power alone.

    echopath dataset data/datasets/ghosts.toml --out ghosts       # a thousand frames, minutes
    OMP_NUM_THREADS=1 python train_ghosts.py ghosts               # minutes on a processor, also where others use it

The network has three scales (8, 16 and 32 channels) and sees the map in dB with range and velocity of each cell. Power alone has
two thresholds, those of the best mean IoU on the training frames: nothing, ghost, object by ascending power.
"""
import argparse
import time

import numpy as np
import torch
from torch import nn
from torch.utils.data import DataLoader
from torch_dataset import CLASSES, MapsWithGhosts

BATCH, RATE = 8, 5e-3
WEIGHTS = torch.tensor([0.05, 1.0, 1.5])  # of the classes in the loss: most cells have nothing


class Network(nn.Module):
    """Scores [N, 3, V, R] of the classes from maps [N, 1, V, R] in dB over the noise."""

    def __init__(self, channels=(8, 16, 32)):
        super().__init__()
        ends = [3, *channels]
        self.down = nn.ModuleList(_block(before, after) for before, after in zip(ends, channels))
        self.up = nn.ModuleList(_block(wide + narrow, narrow) for wide, narrow in zip(channels[:0:-1], channels[-2::-1]))
        self.last = nn.Conv2d(channels[0], len(CLASSES), 1)

    def forward(self, maps):
        axes = (torch.linspace(-1, 1, count) for count in maps.shape[2:])
        velocity, place = torch.meshgrid(*axes, indexing="ij")
        values = torch.cat([maps / 20.0, velocity.expand_as(maps), place.expand_as(maps)], 1)
        scales = []
        for index, block in enumerate(self.down):
            values = block(nn.functional.max_pool2d(values, 2) if index else values)
            scales.append(values)
        for block, finer in zip(self.up, scales[-2::-1]):
            values = block(torch.cat([nn.functional.interpolate(values, scale_factor=2), finer], 1))
        return self.last(values)


def _block(before, after):
    return nn.Sequential(nn.Conv2d(before, after, 3, padding=1), nn.BatchNorm2d(after), nn.ReLU(),
                         nn.Conv2d(after, after, 3, padding=1), nn.BatchNorm2d(after), nn.ReLU())


def ious(found, true):
    """IoU of each class, [3], over all cells of all frames."""
    counts = np.bincount(3 * np.ravel(true) + np.ravel(found), minlength=9).reshape(3, 3)
    return np.diag(counts) / (counts.sum(0) + counts.sum(1) - np.diag(counts))


def all_of(frames):
    """Maps [N, 1, V, R] and classes [N, V, R] of all frames of a split."""
    maps, classes = zip(*(frames[place] for place in range(len(frames))))
    return torch.stack(maps), torch.stack(classes)


def best_thresholds(maps, classes):
    """(of a ghost, of an object) in dB: of the best mean IoU on these frames."""
    levels = np.arange(4.0, 50.0, 1.0)
    steps = np.digitize(maps[:, 0], levels)  # how many levels each cell reaches
    cells = np.stack([np.bincount(steps[classes == index], minlength=len(levels) + 1) for index in range(len(CLASSES))])
    before = np.concatenate([np.zeros((len(CLASSES), 1)), np.cumsum(cells, axis=1)], axis=1)  # of fewer levels

    def mean_iou(pair):
        low, high = pair
        counts = np.stack([before[:, low + 1], before[:, -1] - before[:, high + 1], before[:, high + 1] - before[:, low + 1]], 1)
        return (np.diag(counts) / (counts.sum(0) + counts.sum(1) - np.diag(counts))).mean()

    low, high = max(((low, high) for high in range(len(levels)) for low in range(high + 1)), key=mean_iou)
    return levels[low], levels[high]


def by_power(maps, thresholds):
    """Classes [N, V, R] by two thresholds in dB."""
    low, high = thresholds
    return np.where(maps[:, 0] >= high, 1, np.where(maps[:, 0] >= low, 2, 0))


def train(network, frames, epochs):
    """Trains a network on (maps, classes)."""
    optimizer = torch.optim.Adam(network.parameters(), lr=RATE)
    loader = DataLoader(torch.utils.data.TensorDataset(*frames), batch_size=BATCH, shuffle=True)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, RATE, total_steps=epochs * len(loader))
    loss_of = nn.CrossEntropyLoss(weight=WEIGHTS)
    for epoch in range(epochs):
        network.train()
        begin, total = time.process_time(), 0.0
        for maps, classes in loader:
            if torch.rand(()) < 0.5:  # approaching and receding alike
                maps, classes = maps.flip(2), classes.flip(1)
            optimizer.zero_grad()
            loss = loss_of(network(maps), classes)
            loss.backward()
            optimizer.step()
            schedule.step()
            total += loss.item() / len(loader)
        print(f"epoch {epoch + 1}: loss {total:.4f}, {time.process_time() - begin:.1f} s of the processor", flush=True)


@torch.no_grad()
def classes_by(network, maps):
    """Classes [N, V, R] by a network."""
    network.eval()
    return torch.cat([network(batch).argmax(1) for batch in maps.split(BATCH)]).numpy()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--epochs", type=int, default=12)
    options = parser.parse_args()
    torch.manual_seed(1)
    known, held_out = (all_of(MapsWithGhosts(options.folder, split)) for split in ("train", "test"))
    print(f"{len(known[0])} frames to train on, {len(held_out[0])} held out")
    thresholds = best_thresholds(known[0].numpy(), known[1].numpy())
    network = Network()
    train(network, known, options.epochs)
    alone = f"power alone, from {thresholds[0]:.0f} and {thresholds[1]:.0f} dB"
    for name, found in ((alone, by_power(held_out[0].numpy(), thresholds)), ("network", classes_by(network, held_out[0]))):
        values = ious(found, held_out[1].numpy())
        print(f"{name}: mIoU {100 * values.mean():.1f} %, "
              + ", ".join(f"{kind} {100 * value:.1f} %" for kind, value in zip(CLASSES, values)))


if __name__ == "__main__":
    main()
