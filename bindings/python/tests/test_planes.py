"""The result: its tables agree with each other, with the record, and with other people's arithmetic."""

import itertools

import numpy as np
import pytest

import depthplanes


def test_the_tables_are_those_of_the_record(planes):
    record = planes.to_dict()["planes"]
    assert len(planes) == len(record) == len(list(planes)) > 50
    for k, row in enumerate(record):
        assert row["label"] == k + 1 and row["pixel_count"] == planes.pixel_counts[k]
        box = row["bounding_box"]
        assert planes.xyxy[k].tolist() == [box["u_min"], box["v_min"], box["u_max"] + 1, box["v_max"] + 1]
        assert planes.centroids_px[k].tolist() == row["centroid_px"]
        metric = row["metric"]
        assert planes.normals[k].tolist() == metric["normal"] and planes.distances[k] == metric["distance_m"]
        assert planes.rms[k] == metric["rms_m"] and planes.centroids[k].tolist() == metric["centroid_m"]
        assert planes.areas[k] == (np.nan if metric["area_m2"] is None else metric["area_m2"])
        assert planes.covariances[k].tolist() == metric["covariance"]
        assert planes.fits[k].tolist() == [*row["fit"]["gradient"], row["fit"]["offset"], row["fit"]["rms"]]


def test_types_and_shapes(planes):
    count = len(planes)
    shapes = {
        "labels": ((480, 640), np.uint16), "normals": ((count, 3), np.float64), "distances": ((count,), np.float64),
        "areas": ((count,), np.float64), "rms": ((count,), np.float64), "pixel_counts": ((count,), np.int64),
        "xyxy": ((count, 4), np.int64), "centroids": ((count, 3), np.float64), "centroids_px": ((count, 2), np.float64),
        "covariances": ((count, 4, 4), np.float64), "fits": ((count, 4), np.float64),
    }  # fmt: skip
    for name, (shape, type_) in shapes.items():
        array = getattr(planes, name)
        assert (array.shape, array.dtype) == (shape, type_), name
    with pytest.warns(depthplanes.ReadingWarning, match="missing"):
        nothing = depthplanes.detect(np.zeros((30, 40), np.uint16))
    assert len(nothing) == 0 and list(nothing) == [] and not nothing.labels.any()
    assert nothing.normals.shape == (0, 3) and nothing.covariances.shape == (0, 4, 4)


def test_masks_and_boxes_are_those_of_the_labels(planes):
    for k in range(len(planes)):
        mask = planes.mask(k)
        rows, columns = np.nonzero(mask)
        assert len(rows) == planes.pixel_counts[k]
        assert planes.xyxy[k].tolist() == [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
        assert np.allclose(planes.centroids_px[k], [columns.mean(), rows.mean()])


def test_points_lie_on_their_plane(planes, room):
    fx, fy, cx, cy = room.camera
    for k in range(10):
        points = planes.points(k)
        rows, columns = np.nonzero(planes.mask(k))
        z = room.depth[rows, columns] / 1000
        assert np.allclose(points, np.column_stack([(columns - cx) / fx * z, (rows - cy) / fy * z, z]), atol=1e-6)
        a, b, c, d = planes.plane_model(k)
        assert np.isclose(a * a + b * b + c * c, 1) and d >= 0 and np.array([a, b, c]) @ points.mean(0) < 0
        off = points @ [a, b, c] + d
        assert np.isclose(np.sqrt(np.mean(off**2)), planes.rms[k], rtol=1e-3, atol=1e-7)


@pytest.mark.parametrize(
    "index",
    [slice(3, 40, 2), [5, 1, 30], np.array([2, -1]), "mask", [], slice(None, None, -1)],
    ids=["slice", "places", "from the end", "mask", "none", "reversed"],
)
def test_a_selection_is_planes_again(planes, index):
    index = planes.areas > 0.5 if isinstance(index, str) else index
    places = np.arange(len(planes))[index]
    some = planes[index]
    assert isinstance(some, depthplanes.Planes) and len(some) == len(places)
    assert np.array_equal(some.areas, planes.areas[index], equal_nan=True)
    assert some.indices.tolist() == places.tolist() and some[:1].indices.tolist() == places[:1].tolist()
    assert np.array_equal(some.normals, planes.normals[index])
    for k, place in enumerate(places):
        assert np.array_equal(some.mask(k), planes.mask(place))
    assert np.count_nonzero(some.labels) == planes.pixel_counts[index].sum()
    assert [row["label"] for row in some.to_dict()["planes"]] == list(range(1, len(places) + 1))
    if len(places):
        assert np.array_equal(some.points(0), planes.points(places[0]))
        assert len(some.polygons(0)) == len(planes.polygons(places[0]))
        assert len(some[0:1]) == 1, "a selection can be selected from"


def test_one_plane_is_its_row(planes):
    plane = planes[4]
    assert isinstance(plane, depthplanes.Plane) and plane.label == 5
    assert plane.area == planes.areas[4] and plane.pixel_count == planes.pixel_counts[4]
    assert np.array_equal(plane.mask, planes.mask(4)) and np.array_equal(plane.model, planes.plane_model(4))
    assert np.array_equal(plane.points, planes.points(4)) and np.array_equal(plane.hull(), planes.hull(4))
    rings = [ring for of in (plane, planes[[4]][0]) for part in of.polygons(metric=True, tolerance=1) for ring in (part.outer, *part.holes)]
    theirs = [ring for part in planes.polygons(4, metric=True, tolerance=1) for ring in (part.outer, *part.holes)] * 2
    assert len(rings) == len(theirs) and all(np.array_equal(ring, other) for ring, other in zip(rings, theirs, strict=True))
    assert np.array_equal(plane.rectangle(metric=True).sides, planes.rectangle(4, metric=True).sides)
    assert planes[-1].label == len(planes) and "Plane(label=5" in repr(plane)
    for wrong in (len(planes), -len(planes) - 1):
        with pytest.raises(IndexError):
            planes[wrong]
        with pytest.raises(IndexError):
            planes.mask(wrong)
    with pytest.raises(depthplanes.InputError, match="asked for twice"):
        planes[[1, 1]]
    with pytest.raises(IndexError):
        planes[np.ones(3, bool)]


def test_polygons_enclose_the_pixels(planes):
    shapely = pytest.importorskip("shapely")
    for k in range(20):
        exact = planes.polygons(k, tolerance=0)
        area = sum(shapely.Polygon(part.outer, part.holes).area for part in exact)
        assert area == planes.pixel_counts[k]
        space = planes.polygons(k, metric=True)
        assert all(np.abs(part.outer @ planes.normals[k] + planes.distances[k]).max() < 1e-9 for part in space)
        assert shapely.Polygon(planes.hull(k)).covers(shapely.MultiPoint(np.concatenate([part.outer for part in exact])))


def test_rectangles_are_around_the_plane(planes):
    for k, metric in itertools.product(range(10), (False, True)):
        rectangle = planes.rectangle(k, metric=metric)
        hull = planes.hull(k, metric=metric)
        assert np.allclose(rectangle.axes @ rectangle.axes.T, np.eye(2)) and rectangle.sides[0] >= rectangle.sides[1]
        inside = np.abs((hull - rectangle.centre) @ rectangle.axes.T) <= rectangle.sides / 2 + 1e-6
        assert inside.all()
        assert np.allclose(np.linalg.norm(rectangle.corners[1] - rectangle.corners[0]), rectangle.sides[0])


def test_what_needs_the_camera_says_so(room):
    planes = depthplanes.detect(room.depth)
    assert np.isnan(planes.distances).all() and planes.camera is None and planes.pixel_counts[0] > 1000
    with pytest.raises(depthplanes.InputError, match=r"state camera=\(fx, fy, cx, cy\)"):
        planes.points(0)
    with pytest.raises(depthplanes.InputError, match="unit and camera"):
        planes.polygons(0, metric=True)
    assert planes.polygons(0)


def test_pictures(planes, room):
    picture = planes.draw()
    assert picture.shape == (480, 640, 3) and picture.dtype == np.uint8
    photo = np.full((480, 640, 3), 255, np.uint8)
    over = planes[:1].draw(photo)
    assert (over[~planes.mask(0)] == 255).all() and (over[planes.mask(0)] != 255).any(axis=1).all()
    assert (photo == 255).all(), "the picture is not drawn into"
    assert np.array_equal(planes[:1].draw(photo[..., 0]), over), "grey is the same as three equal channels"
    assert np.array_equal(planes[:1].draw(np.asfortranarray(photo)), over)
    for wrong in (photo[:100], photo[..., :2]):
        with pytest.raises(depthplanes.InputError, match=r"image is an array of uint8, shape .*accepted: .*\(480, 640, 3\)"):
            planes.draw(wrong)


def test_curved_surfaces_and_joined_planes():
    frame = depthplanes.scene("curved:sensor=clean_mm")
    planes = depthplanes.detect(frame, curved=True)
    assert planes.curved.max() > 0 and not (planes.curved[planes.labels > 0] > 0).any()
    assert depthplanes.detect(frame).curved is None
    room = depthplanes.scene("room:sensor=clean_mm")
    joined = depthplanes.detect(room, merge_coplanar=(3, 0.02))
    assert len(joined) < len(depthplanes.detect(room))
    assert any("parts" in row for row in joined[:20].to_dict()["planes"])


def test_an_explanation_names_what_helps(room):
    planes = depthplanes.detect(room)
    rows, columns = np.nonzero((planes.labels == 0) & (room.depth > 0))
    why = planes.explain(int(columns[0]), int(rows[0]))
    assert why.verdict != "plane" and str(why).startswith("No plane here")
    assert planes.explain(320, 400).verdict == "plane"
    with pytest.raises(depthplanes.InputError, match="u is 640; accepted: a whole number from 0 to 639"):
        planes.explain(640, 0)


def test_a_video_keeps_its_ids_and_a_pose_helps():
    detector, tracker = depthplanes.Detector(), depthplanes.Tracker(kept_frames=5)
    for frame in depthplanes.video("scene:boxes:sensor=kinect,size=320x240,frames=4"):
        planes = detector(frame)
        tracks = tracker(planes, frame.pose)
    assert len(tracks.ids) == len(planes) and frame.time == pytest.approx(0.1)
    # Planes get back pixels at their borders, and lose none but to each other.
    assert (tracks.labels[planes.labels > 0] > 0).all() and set(np.unique(tracks.labels)) <= {0, *tracks.ids.tolist()}
    own = np.concatenate([[0], tracks.ids])[planes.labels]
    assert 0 < np.count_nonzero(tracks.labels != own) < 0.1 * own.size
    seen = [plane for plane in tracks.planes if plane.label is not None]
    assert {plane.id for plane in seen} == set(tracks.ids.tolist())
    oldest = max(seen, key=lambda plane: plane.age)
    assert oldest.age == 4 and oldest.state == "tracked" and oldest.normal.shape == (3,)


def test_a_pose_is_a_matrix_of_4_x_4_as_well():
    frames = list(depthplanes.video("scene:boxes:sensor=kinect,size=320x240,frames=3"))
    answers = []
    for of in (lambda pose: pose, lambda pose: (pose.rotation.tolist(), list(pose.translation)), lambda pose: matrix(pose), lambda pose: matrix(pose).tolist()):
        tracker = depthplanes.Tracker()
        for frame in frames:
            tracks = tracker(depthplanes.detect(frame), pose=of(frame.pose))
        answers.append([(plane.id, plane.age, plane.distance) for plane in tracks.planes])
    assert all(answer == answers[0] for answer in answers)
    all_of = depthplanes.detect(frames[0])
    assert len(depthplanes.Tracker()(all_of[all_of.pixel_counts > 0]).ids) == len(all_of), "all of them are no selection"
    with pytest.raises(depthplanes.InputError, match=r"selection of 2 planes.*tracks.ids\[selection.indices\]"):
        depthplanes.Tracker()(all_of[:2])


def matrix(pose):
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = pose
    return whole


def test_the_ground_of_a_frame(planes):
    frame = depthplanes.scene("robot:sensor=kinect")
    ground = depthplanes.floor(frame)
    assert ground.floor["label"] >= 1 and ground.height > 0.1 and len(ground.classes) == len(ground.planes)
    assert ground.marks.shape == (480, 640) and (ground.marks == depthplanes.Ground.FLOOR).sum() > 10_000
    cells, origin = ground.grid(0.1)
    assert set(np.unique(cells)) <= {-1, 0, 100} and cells.ndim == 2 and origin.shape == (2,)
    same = depthplanes.floor(depthplanes.detect(frame), up=ground.up)
    assert same.height == pytest.approx(ground.height, abs=0.02)
    wall = depthplanes.floor(np.full((240, 320), 2000, np.uint16), unit="mm", camera=(262, 262, 159.5, 119.5))
    assert wall.floor is None and np.isnan(wall.height) and wall.marks is None and wall.classes == []


def test_notes_of_a_selection_are_those_of_the_whole_result():
    planes = depthplanes.detect(depthplanes.scene("room:sensor=kinect"))
    for selection in (planes[planes.areas > 100], planes[:1], planes[3:][:0]):
        assert selection.notes == planes.notes
    fresh = depthplanes.detect(depthplanes.scene("room:sensor=kinect"))
    assert fresh[:0].notes == planes.notes, "they need not be asked for before"


@pytest.mark.filterwarnings("ignore::depthplanes.ReadingWarning")
def test_curved_surfaces_are_written(room, tmp_path):
    planes = depthplanes.detect(room, curved=True)
    planes.write(curved=tmp_path / "curved.png")
    assert np.array_equal(depthplanes.read(tmp_path / "curved.png", unit="grey").depth, planes.curved)
    with pytest.raises(depthplanes.Error, match="curved"):
        depthplanes.detect(room).write(curved=tmp_path / "none.png")
    assert not (tmp_path / "none.png").exists()
