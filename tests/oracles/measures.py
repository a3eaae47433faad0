"""The oracles of `depthplanes score`: the package evops, and the other measures written from their definitions.

They share nothing with ours: masks and sets instead of a table, fractions instead of floats.
"""

import sys
import types
from fractions import Fraction
from itertools import product

import numpy as np

# evops takes NDArray from nptyping for its annotations; nptyping 1 itself does not go with numpy 2.
sys.modules.setdefault("nptyping", types.SimpleNamespace(NDArray=dict))
from evops.metrics import dice, full_statistics, iou, mean  # noqa: E402


def evops(truth, prediction):
    """The measures of the package, under our names."""
    truth, prediction = truth.ravel().astype(np.int32), prediction.ravel().astype(np.int32)
    theirs = full_statistics(prediction, truth, iou, "iou")
    mean_dice = mean(prediction, truth, dice, "iou")
    return {
        "precision": theirs["precision"],
        "recall": theirs["recall"],
        "f_score": theirs["fScore"],
        "mean_iou": theirs["mean"],
        "mean_dice": mean_dice,
        "panoptic_iou": theirs["panoptic"],
        "panoptic_dice": mean_dice * theirs["fScore"],
        "usr": theirs["usr"],
        "osr": theirs["osr"],
        "missed": theirs["missed"],
        "noise": theirs["noise"],
    }


def masks(labels, none=False):
    """{label: mask}, without label 0 unless `none`."""
    return {int(label): labels == label for label in np.unique(labels) if label or none}


def segcomp(truth, prediction, tolerance):
    """The classes of Hoover et al. 1996, section 2.4, as `score --json` lists them.

    Every instance of a class claims planes of both images. Instances are taken by decreasing average, and
    one whose planes are claimed already falls away.
    """
    truths, predictions = masks(truth), masks(prediction)
    shared = {(g, m): int(np.count_nonzero(truths[g] & predictions[m])) for g, m in product(truths, predictions)}
    of_g = {pair: Fraction(n, int(np.count_nonzero(truths[pair[0]]))) for pair, n in shared.items()}
    of_m = {pair: Fraction(n, int(np.count_nonzero(predictions[pair[1]]))) for pair, n in shared.items()}
    instances = [(-(of_g[g, m] + of_m[g, m]) / 2, "correct", [g], [m])
                 for g, m in shared if of_g[g, m] > tolerance and of_m[g, m] > tolerance]
    for g in truths:
        parts = [m for m in predictions if of_m[g, m] > tolerance]
        covered = sum((of_g[g, m] for m in parts), Fraction(0))
        if len(parts) >= 2 and covered > tolerance:
            average = (sum(of_m[g, m] for m in parts) / len(parts) + covered) / 2
            instances.append((-average, "over_segmented", [g], parts))
    for m in predictions:
        parts = [g for g in truths if of_g[g, m] > tolerance]
        covered = sum((of_m[g, m] for g in parts), Fraction(0))
        if len(parts) >= 2 and covered > tolerance:
            average = (sum(of_g[g, m] for g in parts) / len(parts) + covered) / 2
            instances.append((-average, "under_segmented", parts, [m]))
    # Equal averages go by the names of the classes, which stand in the order that we chose.
    classes = {"correct": [], "over_segmented": [], "under_segmented": []}
    free_g, free_m = set(truths), set(predictions)
    for _, kind, gs, ms in sorted(instances):
        if free_g.issuperset(gs) and free_m.issuperset(ms):
            free_g -= set(gs)
            free_m -= set(ms)
            classes[kind].append((gs, ms))
    return {
        "correct": [{"truth": g, "prediction": m} for (g,), (m,) in sorted(classes["correct"])],
        "over_segmented": [{"truth": g, "predictions": ms} for (g,), ms in sorted(classes["over_segmented"])],
        "under_segmented": [{"prediction": m, "truths": gs}
                            for gs, (m,) in sorted(classes["under_segmented"], key=lambda pair: pair[1])],
        "missed": sorted(free_g),
        "noise": sorted(free_m),
    }


def synpeb(truth, correct):
    """f and k from the correct planes."""
    sizes = {g: int(np.count_nonzero(mask)) for g, mask in masks(truth).items()}
    if not sizes:
        return {"f": None, "k": None}
    found = [sizes[pair["truth"]] for pair in correct]
    return {"f": len(found) / len(sizes), "k": sum(found) / sum(sizes.values())}


def partition(truth, prediction):
    """RI, VOI and SC of two lists of labels, all from masks; None without a pixel."""
    names = ("rand_index", "variation_of_information", "segmentation_covering")
    if truth.size == 0:
        return dict.fromkeys(names)
    truths, predictions = list(masks(truth, none=True).values()), list(masks(prediction, none=True).values())
    joint = np.array([[np.count_nonzero(g & m) for m in predictions] for g in truths]) / truth.size

    def entropy(p):
        p = p[p > 0]
        return float(-(p * np.log2(p)).sum())

    rows, columns = joint.sum(1), joint.sum(0)
    information = entropy(rows) + entropy(columns) - entropy(joint)
    ious = np.array([[np.count_nonzero(g & m) / np.count_nonzero(g | m) for m in predictions] for g in truths])
    covering = ((rows * ious.max(1)).sum() + (columns * ious.max(0)).sum()) / 2
    return dict(zip(names, (rand_index(truth, prediction), entropy(rows) + entropy(columns) - 2 * information, covering)))


def rand_index(truth, prediction):
    """The share of pairs of pixels on which both agree, each pair looked at; in blocks of rows."""
    truth, prediction = truth.ravel(), prediction.ravel()
    pairs = truth.size * (truth.size - 1)
    if pairs == 0:
        return 1.0
    agreeing = -truth.size  # each pixel agrees with itself
    for start in range(0, truth.size, 512):
        block = slice(start, start + 512)
        together = truth[block, None] == truth[None, :]
        agreeing += int(np.count_nonzero(together == (prediction[block, None] == prediction[None, :])))
    return agreeing / pairs
