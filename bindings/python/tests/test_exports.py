"""Planes in the forms of other packages, held against these packages' own arithmetic."""

import numpy as np
import pytest

import depthplanes


@pytest.fixture(scope="module")
def some(planes):
    """Large ones and small ones."""
    return planes[:20]


def test_pandas(some):
    pytest.importorskip("pandas")
    table = some.to_dataframe()
    assert table.index.tolist() == list(range(1, 21))
    assert np.allclose(table[["normal_x", "normal_y", "normal_z"]], some.normals) and np.allclose(table.area_m2, some.areas)


@pytest.mark.filterwarnings("ignore:__array__ implementation")  # of pycocotools
def test_coco(some):
    coco_module = pytest.importorskip("pycocotools.coco")
    coco = coco_module.COCO()
    coco.dataset = some.to_coco(source="room.png")
    coco.createIndex()
    assert coco.imgs[1]["file_name"] == "room.png"
    for k, annotation in enumerate(coco.loadAnns(coco.getAnnIds())):
        assert annotation["id"] == k + 1
        assert np.array_equal(coco.annToMask(annotation).astype(bool), some.mask(k))
        u0, v0, u1, v1 = some.xyxy[k].tolist()
        assert annotation["bbox"] == [u0, v0, u1 - u0, v1 - v0] and annotation["area"] == some.pixel_counts[k]
        assert annotation["plane"] == some.plane_model(k).tolist()


def test_geojson(some):
    shapely = pytest.importorskip("shapely")
    collection = some.to_geojson(outlines=0)
    assert len(collection["features"]) == len(some)
    for k, feature in enumerate(collection["features"]):
        shape = shapely.geometry.shape(feature["geometry"])
        assert shape.area == some.pixel_counts[k] and feature["properties"]["distance_m"] == some.distances[k]
        assert all(part.exterior.is_ccw and not any(hole.is_ccw for hole in part.interiors) for part in shape.geoms)


def test_supervision(some):
    supervision = pytest.importorskip("supervision")
    detections = some.to_supervision()
    assert isinstance(detections, supervision.Detections) and len(detections) == len(some)
    assert all(np.array_equal(detections.mask[k], some.mask(k)) for k in range(len(some)))
    large = detections[detections.data["area"] > 1]
    assert len(large) == np.count_nonzero(some.areas > 1)
    drawn = supervision.MaskAnnotator().annotate(np.zeros((480, 640, 3), np.uint8), detections)
    assert (drawn.any(axis=2) == (some.labels > 0)).mean() > 0.99


def test_matplotlib(some, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.close("all")
    axes = some.plot()
    legend = axes.get_legend()
    assert "perpendicular" in legend.get_title().get_text() and legend.get_texts()[0].get_text() == "1:  1.55 m"
    axes.figure.savefig(tmp_path / "plot.png")
    assert len(axes.images) == 1 and axes.texts[0].get_text() == "1"
    picture = axes.images[0].get_window_extent()
    assert picture.width > 0.75 * axes.figure.bbox.width, "the picture fills the figure but for the legend"
    places = np.array([text.get_position() for text in axes.texts])
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1))
    assert len(places) > 5 and apart[~np.eye(len(places), dtype=bool)].min() > 20, "no number lies on another"
    own = pyplot.figure().gca()
    assert some.plot(own) is own is some.plot()
    pyplot.close("all")


@pytest.mark.filterwarnings("ignore")
def test_rerun(some, tmp_path):
    rerun = pytest.importorskip("rerun")
    recording = rerun.RecordingStream("depthplanes")
    recording.save(str(tmp_path / "planes.rrd"))
    some.to_rerun("room", recording=recording)
    recording.flush()
    del recording
    assert (tmp_path / "planes.rrd").stat().st_size > 100_000


def test_ros(some):
    typesys = pytest.importorskip("rosbags.typesys")
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    messages = some.to_ros("optical", (12, 34), store)
    image = messages["labels"]
    again = store.deserialize_cdr(store.serialize_cdr(image, image.__msgtype__), image.__msgtype__)
    assert (again.header.frame_id, again.header.stamp.sec, again.encoding, again.step) == ("optical", 12, "16UC1", 1280)
    assert np.array_equal(again.data.view(np.uint16).reshape(480, 640), some.labels)
    for k, plane in enumerate(messages["planes"]):
        again = store.deserialize_cdr(store.serialize_cdr(plane, plane.__msgtype__), plane.__msgtype__)
        assert again.coef.tolist() == some.plane_model(k).tolist()
    assert some.to_ros()["labels"].height == 480
