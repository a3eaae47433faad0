"""How well the method `planar` does on recorded maps with truth, one setting for each set."""

import json
import subprocess

import pytest


def rows(data, start):
    """The manifest's rows whose path begins so, as lists of cells."""
    lines = (data / "MANIFEST.tsv").read_text(encoding="utf-8").splitlines()
    return [line.split("\t") for line in lines if line.startswith(start)]


def score(program, folder, source, truth, reading, lowest=1):
    """Detects, and scores the labels against the truth."""
    labels = folder / "labels.png"
    detect = [program, "detect", source, "--labels", labels, *reading]
    subprocess.run(detect, check=True, capture_output=True)
    command = [program, "score", truth, labels, "--json", "--truth-from", str(lowest)]
    (pair,) = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["pairs"]
    return pair["segcomp"] | {"f_score": pair["evops"]["f_score"], "f": pair["synpeb"]["f"]}


@pytest.mark.parametrize("setting, least", [(["--preset", "structured-light"], 15.8), ([], 15.6)])
def test_segcomp_abw(program, data, tell, tmp_path, setting, least):
    found = []
    for depth in rows(data, "gt_segcomp_abw/abw.test."):
        if depth[0].endswith(".depth.png"):
            camera = ",".join(depth[7].split()[:4])
            truth = data / depth[0].replace(".depth.", ".labels.")
            reading = ["--scale", "10000", "--intrinsics", camera, *setting]
            found.append(score(program, tmp_path, data / depth[0], truth, reading, lowest=10))
    tell_mean(tell, f"SegComp ABW, {len(found)} images, planar {' '.join(setting)}", found)
    assert len(found) == 10
    assert mean(found, "correct") >= least
    assert mean(found, "over_segmented") + mean(found, "under_segmented") <= 1.0


def test_middlebury(program, data, tell, tmp_path):
    found = []
    for truth in sorted(data.glob("middlebury/*/derived_planes_disp2.png")):
        (source,) = truth.parent.glob("disp2.p*")
        found.append(score(program, tmp_path, source, truth, ["--disparity"]))
    tell_mean(tell, f"Middlebury, {len(found)} maps, planar", found)
    assert len(found) == 5
    assert all(one["f_score"] >= 0.95 for one in found)


@pytest.mark.parametrize("setting, least", [([], 0.6), (["--ray", "0.3"], 0.88)])
def test_synpeb(program, data, tell, tmp_path, setting, least):
    found = []
    for depth in sorted(data.glob("gt_synpeb/*.pinhole_depth.png")):
        truth = depth.with_name(depth.name.replace("_depth.", "_labels."))
        reading = ["--encoding", "tum", "--intrinsics", "400,400,279.5,229.5", *setting]
        found.append(score(program, tmp_path, depth, truth, reading))
    share = sum(one["f"] for one in found) / len(found)
    tell_mean(tell, f"SynPEB, {len(found)} scans, planar {' '.join(setting)}, f {share:.2f}", found)
    assert len(found) == 2
    assert share >= least


def mean(found, name):
    return sum(one[name] for one in found) / len(found)


def tell_mean(tell, what, found):
    names = ["correct", "over_segmented", "under_segmented", "missed", "noise", "f_score"]
    tell(f"{what}: " + ", ".join(f"{name} {mean(found, name):.2f}" for name in names))
