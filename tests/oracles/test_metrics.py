"""`depthplanes score` gives the numbers of evops, of SegComp's definition and of the partition measures'."""

import json
import math
import subprocess
from fractions import Fraction

import cv2
import numpy as np
import pytest

import measures

RANDOM_PAIRS = 1000
TOLERANCES = ["0.8", "0.51", "0.66", "0.95"]
ABW_TRUTHS = 10


def score(program, truth, prediction, *flags):
    ran = subprocess.run([program, "score", truth, prediction, "--json", *flags], capture_output=True, check=True)
    return json.loads(ran.stdout)["pairs"]


def same(ours, theirs, where):
    assert ours.keys() == theirs.keys(), where
    for name, value in theirs.items():
        equal = ours[name] is None if value is None else math.isclose(ours[name], value, rel_tol=1e-12, abs_tol=1e-12)
        assert equal, f"{where}: {name} is {ours[name]}, theirs {value}"


def check_segcomp(pair, truth, prediction, tolerance, where):
    theirs = measures.segcomp(truth, prediction, Fraction(tolerance))
    assert pair["classes"] == theirs, f"{where} at {tolerance}"
    assert pair["segcomp"] == {kind: len(instances) for kind, instances in theirs.items()}, where
    same(pair["synpeb"], measures.synpeb(truth, theirs["correct"]), where)
    return theirs


def check_partition(pair, truth, prediction, where):
    same(pair["partition"], measures.partition(truth, prediction), where)
    on_planes = truth != 0
    same(pair["on_planes"], measures.partition(truth[on_planes], prediction[on_planes]), f"{where} on planes")


def patches(rng, shape, count):
    labels = np.zeros(shape, np.uint16)
    for label in rng.permutation(np.arange(1, 60))[:count]:
        (top, bottom), (left, right) = (sorted(rng.integers(0, side + 1, 2)) for side in shape)
        labels[top:bottom, left:right] = label
    return labels


def disturbed(rng, truth):
    """What a detector might make of it: planes renamed, cut, joined, lost, grown, moved, speckled."""
    found = np.where(truth > 0, truth + 100, 0).astype(np.uint16)
    for _ in range(rng.integers(0, 5)):
        planes = np.unique(found[found > 0])
        if planes.size == 0:
            break
        one, other = rng.choice(planes, 2)
        kind = rng.integers(0, 6)
        if kind == 0:  # a cut, straight across
            v, u = np.nonzero(found == one)
            along = [u, v][rng.integers(0, 2)]
            far = along >= np.quantile(along, rng.choice([0.04, 0.1, 0.3, 0.5, 0.9]))
            found[v[far], u[far]] = found.max() + 1
        elif kind == 1:
            found[found == one] = other
        elif kind == 2:
            found[found == one] = 0
        elif kind == 3:
            found = np.roll(found, rng.integers(-3, 4), rng.integers(0, 2))
        elif kind == 4:
            grown = cv2.dilate((found == one).astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
            found[grown] = one
        else:
            speckles = rng.random(found.shape) < rng.choice([0.01, 0.1, 0.3])
            found[speckles] = rng.choice([0, other])
    return found


def random_pair(number):
    rng = np.random.default_rng([number, 7])
    shape = tuple(rng.integers(1, 41, 2))
    truth = patches(rng, shape, rng.integers(0, 16))
    kind = number % 20
    if kind == 0:
        return truth, np.zeros_like(truth)
    if kind == 1:
        return np.zeros_like(truth), truth
    if kind == 2:
        return truth, np.full_like(truth, 5)
    if kind == 3:
        return truth, patches(rng, shape, rng.integers(0, 9))
    if kind == 4:
        return rng.integers(0, 4, (2, *shape)).astype(np.uint16)
    return truth, disturbed(rng, truth)


@pytest.fixture(scope="module")
def random_pairs(tmp_path_factory):
    """(folder, pairs): the label images in the folders `truth` and `found`, and in memory."""
    folder = tmp_path_factory.mktemp("pairs")
    pairs = [random_pair(number) for number in range(RANDOM_PAIRS)]
    for at, name in enumerate(("truth", "found")):
        (folder / name).mkdir()
        for number, pair in enumerate(pairs):
            np.save(folder / name / f"{number}.npy", pair[at])
    return folder, pairs


def test_random_pairs_score_as_evops(program, random_pairs, tell):
    folder, pairs = random_pairs
    ours = score(program, folder / "truth", folder / "found")
    assert len(ours) == len(pairs) == RANDOM_PAIRS
    matched, split, lost = 0, 0, 0
    for number, (pair, (truth, prediction)) in enumerate(zip(ours, pairs)):
        theirs = measures.evops(truth, prediction)
        same(pair["evops"], theirs, f"pair {number}")
        matched += theirs["precision"] > 0
        split += theirs["usr"] > 0 or theirs["osr"] > 0
        lost += 0 < theirs["missed"] < 1
    tell(f"{len(pairs)} random pairs against evops, {matched} with matches, {split} with split planes:")
    assert matched > 400 and split > 150 and lost > 150


def test_random_pairs_score_as_segcomp_is_defined(program, random_pairs, tell):
    folder, pairs = random_pairs
    seen = dict.fromkeys(["correct", "over_segmented", "under_segmented", "missed", "noise"], 0)
    for tolerance in TOLERANCES:
        ours = score(program, folder / "truth", folder / "found", "--tolerance", tolerance)
        for number, (pair, (truth, prediction)) in enumerate(zip(ours, pairs, strict=True)):
            theirs = check_segcomp(pair, truth, prediction, tolerance, f"pair {number}")
            for kind, instances in theirs.items():
                seen[kind] += len(instances)
    tell(f"{len(pairs)} random pairs at {len(TOLERANCES)} tolerances against SegComp's definition, {seen}:")
    assert min(seen.values()) > 200


def test_random_pairs_have_the_partition_measures_of_all_pairs_of_pixels(program, random_pairs):
    folder, pairs = random_pairs
    for number, (pair, (truth, prediction)) in enumerate(zip(score(program, folder / "truth", folder / "found"), pairs)):
        check_partition(pair, truth, prediction, f"pair {number}")


def test_truth_labels_below_the_lowest_count_as_no_plane(program, random_pairs):
    folder, pairs = random_pairs
    for number, (pair, (truth, prediction)) in enumerate(
            zip(score(program, folder / "truth", folder / "found", "--truth-from", "20"), pairs)):
        planes = np.where(truth < 20, 0, truth)
        check_segcomp(pair, planes, prediction, "0.8", f"pair {number}")
        check_partition(pair, planes, prediction, f"pair {number}")


def test_a_detection_in_icl_nuim_scores_as_evops(program, data, tmp_path, tell):
    found = tmp_path / "found.npy"
    detect = [program, "detect", data / "gt_evops/icl_0.depth.png", "--encoding", "tum", "--method", "ngaf",
              "--theta", "12", "--min-pixels", "1500", "--labels", found]
    subprocess.run(detect, capture_output=True, check=True)
    truth_file = data / "gt_evops/icl_0.labels.png"
    truth, prediction = cv2.imread(str(truth_file), cv2.IMREAD_UNCHANGED), np.load(found)
    (pair,) = score(program, truth_file, found)
    theirs = measures.evops(truth, prediction)
    same(pair["evops"], theirs, "icl_0")
    check_segcomp(pair, truth, prediction, "0.8", "icl_0")
    few = slice(None, None, 8), slice(None, None, 8)  # the partition oracle looks at each pair of pixels
    thin = tmp_path / "thin_truth.npy", tmp_path / "thin_found.npy"
    for file, labels in zip(thin, (truth, prediction)):
        np.save(file, labels[few])
    check_partition(score(program, *thin)[0], truth[few], prediction[few], "icl_0, each eighth pixel")
    tell(f"ICL-NUIM: {pair['planes']}, {pair['segcomp']}, panoptic {theirs['panoptic_iou']:.3f}:")
    assert theirs["precision"] > 0


def test_disturbed_truths_of_segcomp_score_as_defined(program, data, tmp_path, tell):
    files = sorted((data / "gt_segcomp_abw").glob("*.labels.png"))
    assert len(files) == ABW_TRUTHS
    seen = dict.fromkeys(["correct", "over_segmented", "under_segmented", "missed", "noise"], 0)
    rng = np.random.default_rng(11)
    predictions = []
    for file in files:
        truth = cv2.imread(str(file), cv2.IMREAD_UNCHANGED).astype(np.uint16)
        truth[truth < 10] = 0
        prediction = truth
        for _ in range(4):
            prediction = disturbed(rng, prediction)
        np.save(tmp_path / file.name.replace(".png", ".npy"), prediction)
        predictions.append((truth, prediction))
    # The folder of the truth holds depth maps as well.
    ours = score(program, data / "gt_segcomp_abw", tmp_path, "--truth-from", "10")
    perfect = score(program, files[0], files[0])[0]["segcomp"]
    assert (perfect["missed"], perfect["noise"]) == (0, 0)
    for file, pair, (truth, prediction) in zip(files, ours, predictions, strict=True):
        assert pair["truth"] == str(file)
        for kind, instances in check_segcomp(pair, truth, prediction, "0.8", file.name).items():
            seen[kind] += len(instances)
    tell(f"{len(ours)} disturbed truths of ABW, {seen}:")
    assert min(seen.values()) > 0
