"""What `eval` says of real cameras: surfaces of partial truths, and planes from frame to frame, written anew from docs/metrics.md.

The labels are those that the program writes; masks and sets instead of a table of counts.
"""

import json
import subprocess

import cv2
import numpy as np
import pytest

METHODS = ["planar", "ngaf", "normals"]
FRAMES = 26
FAMILIES = {"surfaces": 1, "surfaces_3000": 3000, "surfaces_10000": 10000}
NOT_PLANAR = 65535
COLUMNS = {
    "correct %": ("correct", "all", 100),
    "by px %": ("correct_pixels", "pixels", 100),
    "merged %": ("merged", "all", 100),
    "split %": ("split", "all", 100),
    "missed %": ("missed", "all", 100),
    "pieces": ("pieces", "all", 1),
}


@pytest.fixture(scope="module")
def report(program, data, tmp_path_factory):
    """(folder, rows, tables by title) of one evaluation."""
    folder = tmp_path_factory.mktemp("real")
    command = [program, "eval", "real", "7scenes", "tsdf", "--data", data, "--methods", ",".join(METHODS),
               "--repeat", "1", "--report", folder]
    subprocess.run(command, check=True, capture_output=True)
    tables = {table["title"]: table for table in json.loads((folder / "tables.json").read_text())}
    return folder, json.loads((folder / "rows.json").read_text()), tables


def lines(table):
    """A table's rows as dictionaries by heading."""
    return [dict(zip(table["head"], row, strict=True)) for row in table["rows"]]


def image(path):
    labels = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert labels.dtype == np.uint16
    return labels


def of_method(rows, dataset, method):
    return [row for row in rows if row["dataset"] == dataset and row["method"] == method]


def surfaces(truth, found, coplanar):
    """(pixels, class, pieces) of each labelled surface."""
    labelled = truth != 0
    for label in np.unique(truth[labelled & (truth != NOT_PLANAR)]):
        surface = truth == label
        same = {int(label)}.union(*(group for group in coplanar if label in group))
        size = int(np.count_nonzero(surface))
        whole, parts, pieces = None, np.zeros_like(surface), 0
        for plane in np.unique(found[surface & (found > 0)]):
            mask = (found == plane) & labelled
            on = np.count_nonzero(mask & surface)
            pieces += on >= size / 20
            if on * 5 >= size * 4:
                whole = mask
            if on * 2 >= np.count_nonzero(mask):
                parts |= mask & surface
        if whole is not None:
            belongs = np.count_nonzero(whole & np.isin(truth, sorted(same)))
            kind = "correct" if belongs * 5 >= np.count_nonzero(whole) * 4 else "merged"
        else:
            kind = "split" if np.count_nonzero(parts) * 5 >= size * 4 else "missed"
        yield size, kind, pieces


def counts(found, least):
    chosen = [one for one in found if one[0] >= least]
    kinds = {name: sum(kind == name for _, kind, _ in chosen) for name in ("correct", "merged", "split", "missed")}
    return kinds | {
        "all": len(chosen),
        "pieces": int(sum(pieces for *_, pieces in chosen)),
        "pixels": sum(size for size, *_ in chosen),
        "correct_pixels": sum(size for size, kind, _ in chosen if kind == "correct"),
    }


@pytest.mark.parametrize("method", METHODS)
def test_surfaces_of_real_frames_are_classified_as_defined(report, data, tell, method):
    folder, rows, tables = report
    own = of_method(rows, "real", method)
    assert len(own) == FRAMES
    pooled, not_planar = [], np.zeros(2, int)
    for row in own:
        truth = image(data / "gt_real" / f"{row['map']}.labels.png")
        about = json.loads((data / "gt_real" / f"{row['map']}.json").read_text())
        outcome = row["outcome"]["found"]
        found = image(folder / outcome["labels"])
        here = list(surfaces(truth, found, about["coplanar"]))
        bent = truth == NOT_PLANAR
        covered = np.count_nonzero(bent), np.count_nonzero(bent & (found > 0))
        expected = {f"{family}.{name}": value for family, least in FAMILIES.items()
                    for name, value in counts(here, least).items()}
        expected |= {"not_planar.pixels": covered[0], "not_planar.covered": covered[1]}
        assert outcome["scores"] == expected, f"{row['map']} by {method}"
        pooled += here
        not_planar += covered
    (line,) = [line for line in lines(tables["real"]) if line["method"] == method]
    for family, least in FAMILIES.items():
        start = {1: "", 3000: "3k ", 10000: "10k "}[least]
        of_family = counts(pooled, least)
        assert line[start.strip() or "surfaces"] == str(of_family["all"])
        for head, (part, whole, times) in COLUMNS.items():
            if start + head in line:
                value = times * of_family[part] / of_family[whole]
                assert abs(float(line[start + head]) - value) <= (0.0501 if times == 100 else 0.00501), start + head
    assert abs(float(line["not planar %"]) - 100 * not_planar[1] / not_planar[0]) <= 0.0501
    tell(f"{len(own)} real frames, {method}, {counts(pooled, 1)}:")


def test_every_class_of_surfaces_occurs(report):
    _, rows, _ = report
    seen = {name: sum(row["outcome"]["found"]["scores"][f"surfaces.{name}"] for row in rows if row["dataset"] == "real")
            for name in ("correct", "merged", "split", "missed")}
    assert min(seen.values()) > 0, seen


@pytest.mark.parametrize("dataset, frames", [("7scenes", 40), ("tsdf", 50)])
@pytest.mark.parametrize("method", ["planar", "ngaf"])
def test_planes_of_sequences_are_followed_as_defined(report, tell, dataset, frames, method):
    folder, rows, tables = report
    own = sorted(of_method(rows, dataset, method), key=lambda row: row["map"])
    assert len(own) == frames
    labels = [image(folder / row["outcome"]["found"]["labels"]) for row in own]
    best = []
    for before, after in zip(labels, labels[1:]):
        for plane in range(1, int(before.max()) + 1):
            mask = before == plane
            if np.count_nonzero(mask) >= 5000:
                others = [after == other for other in np.unique(after[mask]) if other > 0]
                best.append(max((np.count_nonzero(mask & one) / np.count_nonzero(mask | one) for one in others), default=0))
    planes = [len(np.unique(frame[frame > 0])) for frame in labels]
    expected = {
        "pairs of frames": frames - 1,
        "large planes": len(best),
        "IoU": np.mean(best) if best else None,
        "IoU > 0.75 %": 100 * np.mean(np.array(best) > 0.75) if best else None,
        "planes": np.mean(planes),
        "sd of change": np.std(np.diff(planes)),
    }
    (line,) = [line for line in lines(tables[f"{dataset}, from frame to frame"]) if line["method"] == method]
    for head, value in expected.items():
        digits = len(line[head].partition(".")[2])
        assert line[head] == "-" if value is None else abs(float(line[head]) - value) <= 0.501 * 10**-digits, head
    tell(f"{dataset}, {frames} frames, {method}, {line}:")
