// What the wrapper, and the interface below it, give for maps whose planes are known.
#include "check.h"
#include <cmath>
#include <cstring>
#include <depthplanes.hpp>
#include <fstream>
#include <iostream>
#include <string_view>

namespace {

constexpr std::size_t WIDTH = 160, HEIGHT = 120, SIZE = WIDTH * HEIGHT;
using Labels = std::vector<std::uint16_t>;

/// A wall of 3 m with a box of 2 m in front, in millimetres; nothing was measured in the first row.
std::vector<std::uint16_t> boxed() {
    std::vector<std::uint16_t> depth(SIZE, 3000);
    for (std::size_t at = 0; at < SIZE; ++at) {
        const std::size_t u = at % WIDTH, v = at / WIDTH;
        if (v == 0)
            depth[at] = 0;
        else if (u >= 40 && u < 100 && v >= 30 && v < 90)
            depth[at] = 2000;
    }
    return depth;
}

depthplanes::Detector detector() {
    depthplanes::Detector detector;
    detector.camera(150, 150, 79.5, 59.5);
    return detector;
}

Labels copied(const depthplanes::Detection &found) { return {found.labels().begin(), found.labels().end()}; }

void planes_are_those_of_the_map() {
    const auto depth = boxed();
    const depthplanes::Map map(depth.data(), WIDTH, HEIGHT);
    auto finder = detector();
    const auto found = finder.outlines().detect(map);
    CHECK(found.width() == WIDTH && found.height() == HEIGHT && found.planes().size() == 2);
    const dp_plane &wall = found.plane(1), &box = found.plane(2);
    CHECK(wall.label == 1 && wall.is_metric && wall.pixel_count == SIZE - WIDTH - 3600 && box.pixel_count == 3600);
    CHECK(std::abs(wall.distance_m - 3) < 1e-3 && std::abs(box.distance_m - 2) < 1e-3 && std::abs(box.normal[2] + 1) < 1e-3);
    CHECK(box.plane_model[2] == box.normal[2] && box.plane_model[3] == box.distance_m);
    CHECK(box.u_min == 40 && box.u_max == 99 && box.v_min == 30 && box.v_max == 89);
    CHECK(std::abs(box.centroid_px[0] - 69.5) < 1e-9 && std::abs(box.centroid_px[1] - 59.5) < 1e-9);
    CHECK(std::abs(box.area_m2 - 0.64) < 1e-3 && std::abs(box.centroid_m[2] - 2) < 1e-3 && std::abs(box.fit[2] - 2000) < 1);
    CHECK(box.rms_m < 1e-3 && box.fit_rms < 1e-3 && box.covariance[3][3] >= 0 && box.share_of_valid > 0.18);
    CHECK(found.labels()[0] == 0 && found.labels()[WIDTH] == 1 && found.labels()[40 * WIDTH + 50] == 2);
    CHECK(found.indices(2).size() == 3600 && found.indices(2)[0] == 30 * static_cast<int>(WIDTH) + 40);
    CHECK(found.curved_labels().empty());

    const auto points = finder.points(map, found, 2);
    CHECK(points.size() == 3600 && std::abs(points[0][0] - (40 - 79.5) / 150 * 2) < 1e-9 && points[0][2] == 2);
    CHECK(finder.explain(map, 50, 40).find("plane 2") != std::string::npos);
    CHECK(finder.explain(map, 0, 0).find("nothing was measured") != std::string::npos);

    CHECK(depthplanes::rings(wall).size() == 2 && !depthplanes::rings(wall)[0].is_hole && depthplanes::rings(wall)[1].is_hole && depthplanes::rings(box).size() == 1);
    const dp_ring &hole = depthplanes::rings(wall)[1], &around = depthplanes::rings(box)[0];
    CHECK(hole.point_count == 4 && around.point_count == 4);
    double twice = 0; // the area of the box in pixels, by its corners
    for (std::size_t at = 0; at < 4; ++at) {
        const double *here = around.points_px[at], *next = around.points_px[(at + 1) % 4];
        twice += here[0] * next[1] - here[1] * next[0];
        CHECK(std::abs(around.points_m[at][2] - 2) < 1e-3);
    }
    CHECK(std::abs(twice) == 2 * 3600);
}

/// Every way to hand over the same numbers gives the same labels.
void pixels_are_taken_from_anywhere() {
    const auto depth = boxed();
    const Labels expected = copied(detector().detect({depth.data(), WIDTH, HEIGHT}));
    auto finder = detector();
    const std::size_t stride = WIDTH + 7;
    std::vector<std::uint16_t> wide(stride * HEIGHT, 9999);
    std::vector<unsigned char> odd(2 * SIZE + 1), bytes((2 * WIDTH + 1) * HEIGHT);
    std::vector<float> metres(SIZE);
    std::vector<double> doubles(SIZE);
    for (std::size_t at = 0; at < SIZE; ++at) {
        wide[at / WIDTH * stride + at % WIDTH] = depth[at];
        std::memcpy(&odd[2 * at + 1], &depth[at], 2);
        std::memcpy(&bytes[at / WIDTH * (2 * WIDTH + 1) + 2 * (at % WIDTH)], &depth[at], 2);
        doubles[at] = depth[at] / 1000.0;
        metres[at] = depth[at] == 0 ? NAN : static_cast<float>(doubles[at]);
    }
    for (int time = 0; time < 2; ++time) { // the first of a size and type is copied, later ones are not
        CHECK(copied(finder.detect({wide.data(), WIDTH, HEIGHT, 2 * stride})) == expected);
        CHECK(copied(finder.detect(depthplanes::Map::of(DP_UINT16, &odd[1], WIDTH, HEIGHT))) == expected);
        CHECK(copied(finder.detect(depthplanes::Map::of(DP_UINT16, bytes.data(), WIDTH, HEIGHT, 2 * WIDTH + 1))) == expected);
        CHECK(copied(finder.detect({metres.data(), WIDTH, HEIGHT})) == expected);
        CHECK(copied(finder.detect({doubles.data(), WIDTH, HEIGHT})) == expected);
    }
    CHECK(copied(finder.set("threads", 2).detect({depth.data(), WIDTH, HEIGHT})) == expected);
}

void what_is_stated_counts() {
    const auto depth = boxed();
    const depthplanes::Map map(depth.data(), WIDTH, HEIGHT);
    CHECK(detector().set("min-pixels", 5000).detect(map).planes().size() == 1);
    CHECK(detector().set_text("min-pixels", "5000").detect(map).planes().size() == 1);
    CHECK(detector().valid_range(2500, 3500).detect(map).planes().size() == 1);
    CHECK(std::abs(detector().unit("tum").detect(map).plane(2).distance_m - 0.4) < 1e-3);
    CHECK(std::abs(detector().set("scale", 500).detect(map).plane(2).distance_m - 4) < 1e-3);
    CHECK(detector().set("missing", 2000).detect(map).planes().size() == 1);
    CHECK(detector().sensor("kinect1").detect(map).planes().size() == 2);
    CHECK(detector().set("curved", 1).detect(map).curved_labels().size() == SIZE);
    CHECK(!depthplanes::Detector().detect(map).plane(1).is_metric);
    std::ofstream("cameras.txt") << "1 PINHOLE 160 120 150 150 80 60\n"; // as COLMAP writes it, whose centres are at 0.5
    const auto by_file = depthplanes::Detector().camera_file("cameras.txt").detect(map);
    CHECK(by_file.plane(2).centroid_m[0] == detector().detect(map).plane(2).centroid_m[0]);
    const auto rig = detector().unit("disparity").set("focal", 150).set("baseline", 40).detect(map); // 3000 pixels of disparity are 2 m
    CHECK(std::abs(rig.plane(1).distance_m - 2) < 1e-3);
    std::vector<std::uint16_t> walls(SIZE, 3000); // a wall on both sides of a column
    for (std::size_t at = 0; at < SIZE; ++at)
        if (at % WIDTH >= 60 && at % WIDTH < 90)
            walls[at] = 2000;
    const depthplanes::Map pieces(walls.data(), WIDTH, HEIGHT);
    CHECK(detector().detect(pieces).planes().size() == 3 && detector().merge_coplanar().detect(pieces).planes().size() == 2);
}

void notes_say_what_looks_wrong() {
    std::vector<float> millimetres(SIZE, 2000.0f);
    auto finder = detector();
    depthplanes::Detection found;
    CHECK(!finder.explain({millimetres.data(), WIDTH, HEIGHT}, 0, 0).empty()); // it is not said there
    finder.detect({millimetres.data(), WIDTH, HEIGHT}, found);
    CHECK(std::string_view(found.notes()).find("--encoding") != std::string_view::npos);
    finder.detect({millimetres.data(), WIDTH, HEIGHT}, found);
    CHECK(std::string_view(found.notes()).empty()); // it was said
    auto other = detector(); // cameras often begin with a blank frame
    const std::vector<float> blank(SIZE, 0.0f);
    other.detect({blank.data(), WIDTH, HEIGHT}, found);
    other.detect({millimetres.data(), WIDTH, HEIGHT}, found);
    CHECK(std::string_view(found.notes()).find("--encoding") != std::string_view::npos);
}

/// What is refused, by the status and a part of the text.
template <class Act> void refused(Act act, dp_status status, std::string_view part) {
    try {
        act();
        CHECK(!"it was refused");
    } catch (const depthplanes::Error &error) {
        CHECK(error.status() == status && std::string_view(error.what()).find(part) != std::string_view::npos);
    }
}

/// As a point cloud of PCL.
struct Cloud {
    struct Point {
        float z;
    };
    std::uint32_t width, height;
    std::vector<Point> points;
};

void what_fails_throws() {
    depthplanes::Detection found;
    auto finder = detector();
    refused([] { depthplanes::Detector("frob"); }, DP_INVALID_ARGUMENT, "planar");
    refused([&] { finder.detect({static_cast<const float *>(nullptr), WIDTH, HEIGHT}, found); }, DP_NULL_POINTER, "pixels");
    refused([&] { found.plane(0); }, DP_INVALID_ARGUMENT, "no plane 0; there are 0");
    refused([&] { finder.set(std::string("min-pixels\0junk", 15), 10); }, DP_INVALID_ARGUMENT, "zero byte");
    refused([] { depthplanes::Ground().up(0, 0, 0); }, DP_INVALID_ARGUMENT, "up");
    refused([] { depthplanes::depth_of(Cloud{1000, 1, std::vector<Cloud::Point>(1000)}); }, DP_INVALID_ARGUMENT, "not organised");
    refused([] { depthplanes::depth_of(Cloud{40, 30, std::vector<Cloud::Point>(7)}); }, DP_INVALID_ARGUMENT, "not organised");
    const depthplanes::Detection moved = std::move(found);
    CHECK(moved.planes().empty() && found.planes().empty() && found.labels().empty());
}

void tables_have_rows_with_texts() {
    CHECK(depthplanes::methods().size() > 5 && depthplanes::sensors().size() > 5 && depthplanes::units().size() > 5);
    for (const dp_method &method : depthplanes::methods()) {
        std::cout << "method " << method.name << '\n';
        for (const dp_parameter &of : depthplanes::Span<const dp_parameter>(method.parameters, method.parameter_count)) {
            CHECK(*of.about && *of.accepted && std::isfinite(of.default_value));
            depthplanes::Detector(method.name).set(of.name, of.default_value);
        }
    }
    for (const dp_name &sensor : depthplanes::sensors())
        detector().sensor(sensor.name);
    for (const dp_name &unit : depthplanes::units())
        detector().unit(unit.name);
    CHECK(dp_methods(nullptr) == depthplanes::methods().data());
}

} // namespace

int main() {
    planes_are_those_of_the_map();
    pixels_are_taken_from_anywhere();
    what_is_stated_counts();
    notes_say_what_looks_wrong();
    what_fails_throws();
    tables_have_rows_with_texts();
    std::cout << "version " << dp_version() << '\n';
}
