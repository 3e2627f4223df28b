"""Frames of a dataset as a PyTorch Dataset: maps in dB over the noise, and for each cell nothing, an object or a ghost.

    python torch_dataset.py DIR          # the folder of `echopath dataset`, of a template with [labels] and keep = "maps"
"""
import sys

import numpy as np
import torch
from torch.utils.data import DataLoader, Dataset

import echopath as ep

CLASSES = ("nothing", "object", "ghost")


class MapsWithGhosts(Dataset):
    """Map and classes of each frame of a split of `ep.dataset.open(folder)`, read when it is asked for.

    folder: of the dataset; split: name of a split
    Items: f32 [1, V, R] dB over the mean noise, and i64 [V, R], indices of CLASSES. It pickles, so that the workers of a
    DataLoader read frames beside each other.
    """

    def __init__(self, folder, split):
        self.frames = ep.dataset.open(folder).split(split)

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, place):
        frame = self.frames[place].frame
        labels = next(iter(frame.labels.values()))
        power = 10.0 * np.log10(np.maximum(frame.power, 1e-30) / labels.noise_power)
        classes = np.where(labels.ghost_map >= 0, 2, np.where(labels.object_map >= 0, 1, 0))
        return torch.from_numpy(power.astype(np.float32)[None]), torch.from_numpy(classes.astype(np.int64))


if __name__ == "__main__":
    frames = MapsWithGhosts(sys.argv[1], "train")
    for maps, classes in DataLoader(frames, batch_size=8, shuffle=True):
        print(list(maps.shape), {name: int((classes == index).sum()) for index, name in enumerate(CLASSES)})
