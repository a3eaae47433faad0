"""How well the method `planar` does on recorded maps with truth, one setting for each set."""

import json
import subprocess

import cv2
import numpy as np
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


@pytest.mark.parametrize("setting, least", [(["--preset", "structured-light"], 16.6), ([], 16.0)])
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


@pytest.mark.parametrize("setting, least", [([], 0.86), (["--lateral-noise", "0.3"], 0.86), (["--lateral-noise", "0.05"], 0.5)])
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


def test_the_ray_of_a_scan_turned_into_a_picture_is_seen_and_planar_and_noise_agree_on_it(program, data):
    depth = data / "gt_synpeb/ppe_test_500.pinhole_depth.png"
    command = [program, "noise", depth, "--encoding", "tum", "--json"]
    noise = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["all"]
    command = [program, "explain", depth, "--encoding", "tum", "--at", "250,250", "--json"]
    told = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    # A place anywhere within a pixel is off by 1 / sqrt(12); the estimate keeps on the safe side of clutter.
    assert 0.1 < noise["lateral_noise_px"] < 12**-0.5
    (finding,) = (one for one in json.loads(told)["findings"] if one["subject"] == "lateral noise")
    assert finding["quantities"][0]["value"] == pytest.approx(noise["lateral_noise_px"], rel=0.15)


@pytest.mark.parametrize("setting, least", [([], 0.44), (["--noise", "0.004"], 0.42)])
def test_evops_icl(program, data, tell, tmp_path, setting, least):
    (depth,) = rows(data, "gt_evops/icl_0.depth")
    reading = ["--encoding", "tum", "--intrinsics", ",".join(depth[7].split()[:4]), *setting]
    truth = data / depth[0].replace(".depth.", ".labels.")
    found = [score(program, tmp_path, data / depth[0], truth, reading)]
    tell_mean(tell, f"EVOPS ICL-NUIM, 1 frame, planar {' '.join(setting)}", found)
    assert mean(found, "f_score") >= least


# Grey that falls by one with each unit of depth: of the T in T - grey, 350 leaves truth planes the flattest.
NYU_FARTHEST = 350


@pytest.mark.parametrize("setting, least", [([], 2.4), (["--min-pixels", "1000"], 2.9)])
def test_nyu_dpd(program, data, tell, tmp_path, setting, least):
    reading = ["--encoding", "millimetre", "--noise-growth", "0.075"]
    found = []
    for depth in sorted(data.glob("gt_nyu_dpd/depth/*.png")):
        grey = cv2.imread(str(depth), cv2.IMREAD_UNCHANGED)
        source = tmp_path / "depth.npy"
        np.save(source, np.where(grey == 0, 0, NYU_FARTHEST - grey.astype(np.uint16)))
        truth = data / "gt_nyu_dpd" / "labels" / depth.name
        found.append(score(program, tmp_path, source, truth, [*reading, *setting]))
    tell_mean(tell, f"NYU (DPD), {len(found)} images, planar {' '.join([*reading[2:], *setting])}", found)
    assert len(found) == 22
    assert mean(found, "correct") >= least


def test_sr4000_dpd(program, data, tell, tmp_path):
    found = []
    for colours in sorted(data.glob("gt_sr4000_dpd/Scene?_GT*.bmp")):
        truth = tmp_path / "truth.png"
        cv2.imwrite(str(truth), regions_of(cv2.imread(str(colours))))
        source = colours.with_name(colours.name[: len("Scene1")] + ".bmp")
        found.append(score(program, tmp_path, source, truth, ["--encoding", "grey", "--noise", "1"]))
    tell_mean(tell, f"SR4000 (DPD), {len(found)} images, planar --noise 1", found)
    assert len(found) == 5
    assert mean(found, "correct") >= 3.6


def regions_of(colours):
    """Labels of the colours of at least 100 pixels; white edges and shades of black are no planes."""
    codes = colours.astype(np.int32) @ [1, 256, 65536]
    labels = np.zeros(codes.shape, np.uint8)
    for code, pixels in zip(*np.unique(codes, return_counts=True)):
        if pixels >= 100 and code != 0xFFFFFF and max(int(code).to_bytes(3)) > 20:
            labels[codes == code] = labels.max() + 1
    return labels


def mean(found, name):
    return sum(one[name] for one in found) / len(found)


def tell_mean(tell, what, found):
    names = ["correct", "over_segmented", "under_segmented", "missed", "noise", "f_score"]
    tell(f"{what}: " + ", ".join(f"{name} {mean(found, name):.2f}" for name in names))
