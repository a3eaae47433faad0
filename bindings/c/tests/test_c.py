"""The C library gives what the program gives, in C and in C++, without a leak or a wrong access; its page runs."""

import json
import os
import re
import shutil
import subprocess

import cv2
import numpy as np
import pytest
from conftest import ROOT, TARGET, run

C = ROOT / "bindings" / "c"
METHODS = ["planar", "ngaf", "ransac", "ppdfdm", "fpdidm", "hough", "normals", "mdl", "gradient"]
#: Methods that search all frames; the others take seconds for a large one.
FAST = ["planar", "ngaf", "normals", "gradient"]
FEW = 3
WRITERS = ["labels", "labels_cpp", "labels_static"]
#: What the examples print of their own maps.
SAYS = {
    "pcl": "plane 1: 51200 points within 1 mm, 2 m away\nplane 2: 25600 points within 1 mm, 1.5 m away\n",
    "opencv": "plane 1: 264000 pixels, 3 m away\nplane 2: 43200 pixels, 2 m away\n2 planes in the right half\n",
}


@pytest.fixture(scope="module")
def frames(data, tmp_path_factory):
    """(path, raw samples, what the C program is told of them, flags) of each recorded frame, the smallest first."""
    folder, found = tmp_path_factory.mktemp("raw"), []
    for path in sorted((data / "gt_real").glob("*.depth.png")):
        pixels = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        flags = json.loads(path.with_name(path.name.replace(".depth.png", ".json")).read_text())["flags"]
        raw = folder / f"{path.stem}.raw"
        pixels.tofile(raw)
        found.append((path, raw, [pixels.dtype.name, pixels.shape[1], pixels.shape[0]], flags))
    assert len(found) > 20
    return sorted(found, key=lambda frame: frame[2][1] * frame[2][2])


def settings(flags):
    """Flags of the program as settings of the library: NAME=VALUE."""
    words = [part for flag in flags for part in flag.split("=", 1)]
    assert len(words) % 2 == 0 and all(word.startswith("--") for word in words[::2]), flags
    return [f"{name[2:]}={value}" for name, value in zip(words[::2], words[1::2], strict=True)]


def labels_of(built, writer, raw, sizes, method, stated, folder):
    out = folder / "labels.raw"
    run(built / "plain" / writer, *sizes, raw, out, method, *stated)
    return np.fromfile(out, np.uint16).reshape(sizes[2], sizes[1])


def test_the_methods_are_the_programs(built, program, tmp_path):
    said = run(built / "plain" / "wrapper", cwd=tmp_path).stdout
    names = re.findall(r"^method (\w+)$", said, re.MULTILINE)
    assert names == METHODS and all(re.search(rf"^{name}\b", program("methods").stdout, re.MULTILINE) for name in names)
    assert f"version {program('--version').stdout.split()[1]}\n" in said


@pytest.mark.parametrize("method", METHODS)
def test_labels_of_recorded_frames_are_the_programs(built, frames, program, tmp_path, tell, method):
    chosen = frames if method in FAST else frames[:FEW]
    for path, raw, sizes, flags in chosen:
        program("detect", path, "--method", method, *flags, "--labels", tmp_path / "labels.npy")
        expected = np.load(tmp_path / "labels.npy")
        for writer in WRITERS if method == "planar" else WRITERS[:2]:
            assert np.array_equal(labels_of(built, writer, raw, sizes, method, settings(flags), tmp_path), expected), (path, writer)
    tell(f"{len(chosen)} recorded frames have the program's labels by {method}, in C and in C++:")


@pytest.mark.parametrize("dtype", ["uint8", "float32", "float64"])
def test_pixels_of_every_type_have_the_programs_labels(built, frames, program, tmp_path, dtype):
    _, raw, (_, width, height), _ = frames[-1]
    pixels = np.fromfile(raw, np.uint16).reshape(height, width)
    pixels = (pixels // 32).astype(dtype) if dtype == "uint8" else (pixels / 1000).astype(dtype)
    np.save(tmp_path / "map.npy", pixels)
    pixels.tofile(tmp_path / "map.raw")
    program("detect", tmp_path / "map.npy", "--labels", tmp_path / "labels.npy")
    found = labels_of(built, "labels", tmp_path / "map.raw", [dtype, width, height], "planar", [], tmp_path)
    assert found.max() > 0 and np.array_equal(found, np.load(tmp_path / "labels.npy"))


#: Classes of planes as the program names them, in the order of `dp_plane_class`.
CLASSES = ["other", "floor", "ceiling", "wall", "table", "ramp", "step"]


@pytest.mark.parametrize("with_poses", [True, False])
@pytest.mark.parametrize("build, most", [("plain", 40), ("sanitized", 4)])
def test_a_recorded_walk_has_the_programs_floor_and_ids(built, data, program, tmp_path, tell, build, most, with_poses):
    video = data / "video_7scenes"
    for frame, path in enumerate(sorted(video.glob("*.depth.png"))[:most]):
        pixels = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        pixels[pixels == 65535] = 0  # not measured; the program finds that out, and the library at its first map
        pixels.tofile(tmp_path / f"{frame}.raw")
        if with_poses:
            shutil.copy(path.with_name(path.name.replace(".depth.png", ".pose.txt")), tmp_path / f"{frame}.pose")
    camera = "585,585,320,240"
    words = ["--intrinsics", camera, "--floor", "--frames", str(most), "--out", tmp_path / "t.jsonl", "--labels", tmp_path / "ids"]
    program("track", video, *words, *([] if with_poses else ["--ignore-poses"]))
    expected = [json.loads(line) for line in (tmp_path / "t.jsonl").read_text().splitlines()]
    said = run(built / build / "walk", tmp_path, 640, 480, camera, tmp_path / "labels").stdout
    found = [json.loads(line) for line in said.splitlines()]
    labels = np.fromfile(tmp_path / "labels", np.uint16).reshape(-1, 480, 640)
    assert len(found) == len(expected) == len(labels) == most
    for frame, (mine, line) in enumerate(zip(found, expected, strict=True)):
        planes, ground = sorted(line["planes"], key=lambda plane: plane["label"]), line["ground"]
        assert mine["ids"][1:] == [plane["id"] for plane in planes] and mine["lost"][1:] == [plane["id"] for plane in line["lost"]]
        by_id = sorted(planes, key=lambda plane: plane["id"])
        assert np.allclose(mine["distances"][1:], [plane["distance_m"] for plane in by_id], rtol=1e-9)
        floor = ground["floor"]
        assert np.allclose(mine["floor"], [floor[name] for name in ("label", "height_m", "tilt_deg", "roll_deg")], rtol=1e-9)
        assert mine["floor_pixels"] > 0.5 * floor["pixel_count"] and mine["steps"] == len(ground["steps"])
        assert mine["classes"][1:] == [CLASSES.index(plane["class"]) for plane in ground["planes"]]
        assert np.allclose(mine["obstacles"][1:], [obstacle["distance_m"] for obstacle in ground["obstacles"]])
        assert np.allclose(mine["free"][1:], [sector["free_m"] for sector in ground["sectors"]])
        ids = np.array(mine["ids"], np.int64)
        ids[0] = 0
        assert np.array_equal(ids[labels[frame]], cv2.imread(str(tmp_path / "ids" / f"{frame:06}.png"), cv2.IMREAD_UNCHANGED))
    tell(f"{most} recorded frames have the program's floor, obstacles, ids and held borders{' with poses' if with_poses else ''}:")


@pytest.mark.parametrize("build", ["plain", "sanitized"])
@pytest.mark.parametrize("name", ["errors", "wrapper", "threads", "detect", "pcl", "opencv"])
def test_programs_end_well(built, tmp_path, build, name):
    said = run(built / build / name, cwd=tmp_path).stdout
    assert said == SAYS.get(name, said)


#: What valgrind is to look for. Its numbers are not those of the processor: of AVX2 it works out NaN where there is none, and
#: `planar` then finds nothing. So it runs what does not rest on planes of `planar`.
VALGRIND = ["valgrind", "--quiet", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect", "--error-exitcode=9"]


@pytest.mark.parametrize("name", ["errors", "detect"])
def test_valgrind_finds_nothing(built, tmp_path, name):
    run(*VALGRIND, built / "plain" / name, cwd=tmp_path)


@pytest.mark.parametrize("method", ["planar", "ngaf"])
def test_valgrind_finds_nothing_with_a_recorded_frame(built, frames, tmp_path, method):
    _, raw, sizes, flags = frames[0]
    run(*VALGRIND, built / "plain" / "labels", *sizes, raw, tmp_path / "labels", method, *settings(flags))


def test_recorded_frames_are_searched_without_a_wrong_access(built, frames, tmp_path):
    _, raw, sizes, flags = frames[0]
    for method in METHODS:
        run(built / "sanitized" / "labels", *sizes, raw, tmp_path / "out", method, *settings(flags))


def test_a_leak_and_a_wrong_access_would_be_found(built, tmp_path):
    """The sanitizer sees what the library allocates, and pixels that are not there."""
    source = tmp_path / "wrong.c"
    source.write_text(
        "#include <depthplanes.h>\n#include <stdlib.h>\nint main(int n, char **words) {\n"
        "  uint16_t *few = calloc(64 * 47, 2);\n  dp_map map = {few, DP_UINT16, 64, 48, 0};\n"
        "  dp_detector *detector = dp_detector_new(NULL);\n  dp_detection *detection = dp_detection_new();\n"
        "  if (n > 1) { map.height = 47; dp_detector_detect(detector, &map, detection); detector = NULL; detection = NULL; }\n"
        "  else dp_detector_detect(detector, &map, detection);\n"
        "  dp_detection_free(detection); dp_detector_free(detector); free(few); return words == NULL;\n}\n"
    )
    flags = flags_of(built, "--cflags", "--libs")
    run("cc", "-std=c99", "-fsanitize=address", source, "-o", tmp_path / "leaks", *flags)
    leaks = subprocess.run([tmp_path / "leaks", "once"], capture_output=True, text=True, env=environment(built))
    assert leaks.returncode != 0 and "detected memory leaks" in leaks.stderr
    run("cc", "-std=c99", "-g", source, "-o", tmp_path / "reads", *flags)
    reads = subprocess.run(["valgrind", "--error-exitcode=9", tmp_path / "reads"], capture_output=True, text=True, env=environment(built))
    assert reads.returncode == 9 and "Invalid read" in reads.stderr


def environment(built):
    prefix = built / "prefix"
    more = {"PKG_CONFIG_PATH": str(prefix / "lib" / "pkgconfig"), "LD_LIBRARY_PATH": str(prefix / "lib")}
    return {**os.environ, **more}


def flags_of(built, *wanted):
    return run("pkg-config", *wanted, "depthplanes", env=environment(built)).stdout.split()


@pytest.mark.parametrize("language, standard", [("c", "c99"), ("c", "c17"), ("c++", "c++11"), ("c++", "c++17"), ("c++", "c++20")])
def test_the_headers_compile_without_a_warning(built, tmp_path, language, standard):
    header = "depthplanes.hpp" if standard in ("c++17", "c++20") else "depthplanes.h"
    (tmp_path / "all").write_text(f"#include <{header}>\nint main(void) {{ return dp_version() == nullptr_; }}\n".replace("nullptr_", "0"))
    words = ["-std=" + standard, "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only"]
    run("c++" if language == "c++" else "cc", "-x", language, *words, *flags_of(built, "--cflags"), tmp_path / "all")


def test_the_library_exports_its_functions_alone(built):
    header = (C / "include" / "depthplanes.h").read_text()
    declared = set(re.findall(r"\b(dp_\w+)\(", re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)))
    said = run("nm", "--dynamic", "--defined-only", built / "prefix" / "lib" / "libdepthplanes.so").stdout
    assert {line.split()[-1] for line in said.splitlines()} == declared and len(declared) > 20


def test_every_function_is_called_by_a_test():
    header = (C / "include" / "depthplanes.h").read_text()
    called = "".join(path.read_text() for path in [*(C / "tests").glob("*.c*"), *(C / "tests").glob("*.h"), C / "include" / "depthplanes.hpp"])
    for name in set(re.findall(r"\b(dp_\w+)\(", header)):
        assert f"{name}(" in called or f"({name})" in called, name


def test_an_installed_folder_has_what_it_should(built):
    prefix = built / "prefix"
    found = {str(path.relative_to(prefix)) for path in prefix.rglob("*") if not path.is_dir()}
    version = run(TARGET / "release" / "depthplanes", "--version").stdout.split()[1]
    short = version.rsplit(".", 1)[0]
    assert found == {
        "include/depthplanes.h",
        "include/depthplanes.hpp",
        "lib/libdepthplanes.a",
        "lib/libdepthplanes.so",
        f"lib/libdepthplanes.so.{short}",
        f"lib/libdepthplanes.so.{version}",
        "lib/pkgconfig/depthplanes.pc",
        "lib/cmake/depthplanes/depthplanes-config.cmake",
        "lib/cmake/depthplanes/depthplanes-config-version.cmake",
        "share/doc/depthplanes-c/LICENSE-APACHE",
        "share/doc/depthplanes-c/LICENSE-MIT",
        "share/doc/depthplanes-c/THIRD-PARTY",
    }
    said = run("readelf", "--dynamic", prefix / "lib" / "libdepthplanes.so").stdout
    assert f"[libdepthplanes.so.{short}]" in said
    assert run("pkg-config", "--modversion", "depthplanes", env=environment(built)).stdout.strip() == version


@pytest.mark.parametrize("wanted, is_there", [("0.1", True), ("0.1.0", True), ("0.2", False), ("0.1.1", False), ("1.0", False)])
def test_cmake_takes_versions_that_go_together(built, tmp_path, wanted, is_there):
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.16)\nproject(test C)\nfind_package(depthplanes {wanted} REQUIRED)\n"
    )
    words = ["cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={built / 'prefix'}"]
    assert (subprocess.run(words, capture_output=True).returncode == 0) == is_there


def test_the_page_runs(built, tmp_path, tell):
    """Programs and commands of docs/c.md, in order: a block that follows the name of a file in backticks is that file."""
    page = (ROOT / "docs" / "c.md").read_text()
    (tmp_path / ".local").symlink_to(built / "prefix")
    make = tmp_path / "bin" / "make"  # `make install-c` was done by scripts/c
    make.parent.mkdir()
    make.write_text(f"#!/bin/sh\n[ \"$1\" = install-c ] && [ \"$2\" = \"PREFIX={tmp_path}/.local\" ] || exec {shutil.which('make')} \"$@\"\n")
    make.chmod(0o755)
    path = f"{make.parent}{os.pathsep}{os.environ['PATH']}"
    plain = {name: value for name, value in os.environ.items() if name not in ("PKG_CONFIG_PATH", "LD_LIBRARY_PATH")}
    ran = 0
    blocks = re.findall(r"(?:`([\w.]+)`:\n\n)?^```(\w+)\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    for name, language, text in blocks:
        if name:
            (tmp_path / name).write_text(text)
        elif language == "sh":
            run("sh", "-euc", text, cwd=tmp_path, env={**plain, "HOME": str(tmp_path), "PATH": path})
        else:
            assert language == "console", f"a block of {language} has no name"
            for command, expected in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.MULTILINE):
                said = run("sh", "-euc", command, cwd=tmp_path, env={**plain, "HOME": str(tmp_path), "PATH": path})
                assert said.stdout == expected, command
        ran += 1
    assert ran >= 7
    tell(f"{ran} blocks of docs/c.md run:")


def test_sizes_and_costs(built, frames, tell):
    """Prints what the library weighs."""
    sizes = {name: (built / "prefix" / "lib" / name).stat().st_size for name in ("libdepthplanes.so", "libdepthplanes.a")}
    tell(", ".join(f"{name}: {size / 1e6:.1f} MB" for name, size in sizes.items()))
    assert sizes["libdepthplanes.so"] < 8e6
