/* Every wrong use of the interface is an error that says what was given and what is accepted, and the next right use works. */
#include "check.h"
#include <math.h>

enum { WIDTH = 64, HEIGHT = 48 };

static uint16_t pixels[WIDTH * HEIGHT];
static const dp_map wall = {pixels, DP_UINT16, WIDTH, HEIGHT, 0};

static void creation(void)
{
    CHECK(dp_detector_new("frob") == NULL);
    CHECK(strstr(dp_error(NULL), "there is no method `frob`; there are: planar, ngaf"));
    CHECK(dp_detector_new("\xff") == NULL && strstr(dp_error(NULL), "UTF-8"));
    dp_detector_free(NULL);
    dp_detection_free(NULL);
}

static void nulls(dp_detector *detector, dp_detection *detection)
{
    const dp_map nothing = {NULL, DP_UINT16, WIDTH, HEIGHT, 0};
    const char *text = NULL;
    double point[1][3];
    REFUSED(NULL, dp_detector_detect(NULL, &wall, detection), DP_NULL_POINTER, "`detector`");
    REFUSED(NULL, dp_detector_set(NULL, "threads", 1), DP_NULL_POINTER, "`detector`");
    REFUSED(detector, dp_detector_detect(detector, NULL, detection), DP_NULL_POINTER, "`map`");
    REFUSED(detector, dp_detector_detect(detector, &wall, NULL), DP_NULL_POINTER, "`detection`");
    REFUSED(detector, dp_detector_detect(detector, &nothing, detection), DP_NULL_POINTER, "`map.pixels`");
    REFUSED(detector, dp_detector_set(detector, NULL, 1), DP_NULL_POINTER, "`name`");
    REFUSED(detector, dp_detector_set_text(detector, "threads", NULL), DP_NULL_POINTER, "`value`");
    REFUSED(detector, dp_detector_set_sensor(detector, NULL), DP_NULL_POINTER, "`sensor`");
    REFUSED(detector, dp_detector_set_unit(detector, NULL), DP_NULL_POINTER, "`unit`");
    REFUSED(detector, dp_detector_set_camera_file(detector, NULL), DP_NULL_POINTER, "`path`");
    REFUSED(detector, dp_detector_explain(detector, &wall, 0, 0, NULL), DP_NULL_POINTER, "`text`");
    REFUSED(detector, dp_detector_explain(detector, NULL, 0, 0, &text), DP_NULL_POINTER, "`map`");
    REFUSED(detector, dp_detector_points(detector, &wall, NULL, 1, point, 1), DP_NULL_POINTER, "`detection`");
    REFUSED(detector, dp_detector_points(detector, &wall, detection, 1, NULL, 1), DP_NULL_POINTER, "`points`");
    CHECK(dp_detection_width(NULL) == 0 && dp_detection_height(NULL) == 0 && dp_detection_plane_count(NULL) == 0);
    CHECK(!dp_detection_labels(NULL) && !dp_detection_curved_labels(NULL) && !dp_detection_planes(NULL));
    CHECK(!strcmp(dp_detection_notes(NULL), ""));
}

static void maps(dp_detector *detector, dp_detection *detection)
{
    const dp_map wrong[] = {
        {pixels, 9, WIDTH, HEIGHT, 0},          {pixels, -1, WIDTH, HEIGHT, 0},
        {pixels, DP_UINT16, 0, HEIGHT, 0},      {pixels, DP_UINT16, WIDTH, 0, 0},
        {pixels, DP_UINT16, 70000, HEIGHT, 0},  {pixels, DP_UINT16, 65535, 65535, 0},
        {pixels, DP_UINT16, WIDTH, HEIGHT, 127}, {pixels, DP_UINT16, WIDTH, HEIGHT, (size_t)-2},
    };
    const char *const words[] = {"the pixel type is 9", "the pixel type is -1", "the map is 0 x 48", "the map is 64 x 0",
                                 "70000 x 48",          "65535 x 65535",        "127 bytes",         "fits in memory"};
    for (size_t at = 0; at < sizeof wrong / sizeof *wrong; at++) {
        CHECK(dp_detector_detect(detector, &wall, detection) == DP_OK && dp_detection_plane_count(detection) == 1);
        REFUSED(detector, dp_detector_detect(detector, &wrong[at], detection), DP_INVALID_ARGUMENT, words[at]);
        CHECK(dp_detection_width(detection) == 0 && dp_detection_plane_count(detection) == 0 && !dp_detection_labels(detection));
    }
}

static void statements(dp_detector *detector)
{
    REFUSED(detector, dp_detector_set_camera(detector, NAN, 500, 0, 0), DP_INVALID_ARGUMENT, "fx is NaN");
    REFUSED(detector, dp_detector_set_camera(detector, 500, 0, 0, 0), DP_INVALID_ARGUMENT, "fy is 0");
    REFUSED(detector, dp_detector_set_camera(detector, 500, 500, INFINITY, 0), DP_INVALID_ARGUMENT, "cx is inf");
    REFUSED(detector, dp_detector_set_sensor(detector, "frob"), DP_INVALID_ARGUMENT, "kinect1");
    REFUSED(detector, dp_detector_set_unit(detector, "frob"), DP_INVALID_ARGUMENT, "millimetre");
    REFUSED(detector, dp_detector_set(detector, "frob", 1), DP_INVALID_ARGUMENT, "min-pixels");
    REFUSED(detector, dp_detector_set(detector, "min-pixels", -1), DP_INVALID_ARGUMENT, "parameter `min-pixels` is -1; accepted");
    REFUSED(detector, dp_detector_set(detector, "min-pixels", NAN), DP_INVALID_ARGUMENT, "NaN");
    REFUSED(detector, dp_detector_set(detector, "threads", 0), DP_INVALID_ARGUMENT, "whole number from 1");
    REFUSED(detector, dp_detector_set(detector, "curved", 2), DP_INVALID_ARGUMENT, "0 for no");
    REFUSED(detector, dp_detector_set_text(detector, "min-pixels", "many"), DP_INVALID_ARGUMENT, "`min-pixels` is `many`");
    REFUSED(detector, dp_detector_set_text(detector, "focal", "long"), DP_INVALID_ARGUMENT, "`focal` is `long`");
    REFUSED(detector, dp_detector_set_text(detector, "frob", "1"), DP_INVALID_ARGUMENT, "there is no parameter `frob`");
    REFUSED(detector, dp_detector_set_text(detector, "\xff", "1"), DP_INVALID_ARGUMENT, "UTF-8");
    REFUSED(detector, dp_detector_set_valid_range(detector, 2, 1), DP_INVALID_ARGUMENT, "2 to 1");
    REFUSED(detector, dp_detector_set_valid_range(detector, NAN, 1), DP_INVALID_ARGUMENT, "NaN to 1");
    REFUSED(detector, dp_detector_set_merge_coplanar(detector, 91, 0.1), DP_INVALID_ARGUMENT, "from 0 to 90");
    REFUSED(detector, dp_detector_set_outlines(detector, -1, 0), DP_INVALID_ARGUMENT, "from 0 up");
    REFUSED(detector, dp_detector_set_camera_file(detector, "/nothing/there.yaml"), DP_FILE, "/nothing/there.yaml");
}

/* What cannot be told before there is a map. */
static void together(void)
{
    dp_detection *detection = dp_detection_new();
    dp_detector *detector = dp_detector_new(NULL);
    CHECK(dp_detector_set_merge_coplanar(detector, 3, 0.03) == DP_OK);
    REFUSED(detector, dp_detector_detect(detector, &wall, detection), DP_NOT_METRIC, "merge-coplanar");
    dp_detector_free(detector);
    detector = dp_detector_new("ransac");
    CHECK(dp_detector_set(detector, "curved", 1) == DP_OK);
    REFUSED(detector, dp_detector_detect(detector, &wall, detection), DP_INVALID_ARGUMENT, "does not tell curved surfaces");
    dp_detector_free(detector);
    detector = dp_detector_new(NULL);
    CHECK(dp_detector_set(detector, "focal", 500) == DP_OK);
    REFUSED(detector, dp_detector_detect(detector, &wall, detection), DP_INVALID_ARGUMENT, "--baseline");
    CHECK(dp_detector_set(detector, "baseline", 0.1) == DP_OK);
    CHECK(dp_detector_detect(detector, &wall, detection) == DP_OK);
    dp_detector_free(detector);
    dp_detection_free(detection);
}

static void many_planes(void)
{
    enum { SIDE = 300 };
    static uint16_t speckles[SIDE * SIDE];
    for (int at = 0; at < SIDE * SIDE; at++)
        speckles[at] = (uint16_t)(1000 + 100 * (at % SIDE % 3) + 500 * (at / SIDE % 3));
    const dp_map map = {speckles, DP_UINT16, SIDE, SIDE, 0};
    dp_detector *detector = dp_detector_new("ngaf");
    dp_detection *detection = dp_detection_new();
    CHECK(dp_detector_set(detector, "min-pixels", 0) == DP_OK);
    REFUSED(detector, dp_detector_detect(detector, &map, detection), DP_TOO_MANY_PLANES, "90000 planes");
    CHECK(dp_detection_plane_count(detection) == 0);
    dp_detection_free(detection);
    dp_detector_free(detector);
}

static void after_detection(dp_detector *detector, dp_detection *detection)
{
    static double points[WIDTH * HEIGHT][3];
    const dp_map half = {pixels, DP_UINT16, WIDTH, HEIGHT / 2, 0};
    const size_t room = WIDTH * HEIGHT;
    const char *text = NULL;
    CHECK(dp_detector_detect(detector, &half, detection) == DP_OK);
    REFUSED(detector, dp_detector_points(detector, &wall, detection, 1, points, room), DP_INVALID_ARGUMENT, "not of this map");
    CHECK(dp_detector_detect(detector, &wall, detection) == DP_OK);
    REFUSED(detector, dp_detector_points(detector, &wall, detection, 0, points, room), DP_INVALID_ARGUMENT, "no plane 0");
    REFUSED(detector, dp_detector_points(detector, &wall, detection, 2, points, room), DP_INVALID_ARGUMENT, "there are 1");
    REFUSED(detector, dp_detector_points(detector, &wall, detection, 1, points, 7), DP_INVALID_ARGUMENT, "room for 7");
    REFUSED(detector, dp_detector_points(detector, &wall, detection, 1, points, room), DP_NOT_METRIC, "points");
    REFUSED(detector, dp_detector_explain(detector, &wall, WIDTH, 0, &text), DP_INVALID_ARGUMENT, "columns 0 to 63");
    CHECK(text == NULL);
    static float metres[WIDTH * HEIGHT];
    for (size_t at = 0; at < WIDTH * HEIGHT; at++)
        metres[at] = 7;
    const dp_map other = {metres, DP_FLOAT32, WIDTH, HEIGHT, 0};
    dp_detector *metric = dp_detector_new("ngaf");
    CHECK(dp_detector_set_camera(metric, 50, 50, 31.5, 23.5) == DP_OK && dp_detector_detect(metric, &wall, detection) == DP_OK);
    CHECK(dp_detector_points(metric, &wall, detection, 1, points, room) == DP_OK && points[0][2] == 2);
    REFUSED(metric, dp_detector_points(metric, &other, detection, 1, points, room), DP_INVALID_ARGUMENT, "mean something else");
    dp_detector_free(metric);
    dp_detector *of_other_unit = dp_detector_new("ngaf");
    CHECK(dp_detector_set_unit(of_other_unit, "tum") == DP_OK);
    REFUSED(of_other_unit, dp_detector_points(of_other_unit, &wall, detection, 1, points, room), DP_INVALID_ARGUMENT, "mean something else");
    dp_detector_free(of_other_unit);
    dp_detection *empty = dp_detection_new();
    REFUSED(detector, dp_detector_points(detector, &wall, empty, 1, points, room), DP_INVALID_ARGUMENT, "not of this map");
    CHECK(dp_detection_width(empty) == 0 && !dp_detection_labels(empty) && !dp_detection_planes(empty));
    dp_detection_free(empty);
}

/* What a ground and a tracker refuse; a ground that failed holds nothing, a tracker stays as it was. */
static void grounds_and_trackers(dp_detector *detector, dp_detection *detection)
{
    const dp_map half = {pixels, DP_UINT16, WIDTH, HEIGHT / 2, 0};
    const double mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, still[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    dp_ground *ground = dp_ground_new();
    dp_tracker *tracker = dp_tracker_new(0);
    size_t count = 7;
    CHECK(dp_detector_detect(detector, &wall, detection) == DP_OK);
    CHECK(!dp_ground_floor(ground) && !dp_ground_marks(ground) && !dp_ground_planes(ground, &count) && count == 0);
    CHECK(!dp_ground_obstacles(NULL, NULL) && !dp_ground_sectors(ground, NULL) && !dp_ground_steps(ground, NULL));
    CHECK(!dp_tracker_tracks(tracker, &count) && !dp_tracker_labels(tracker) && dp_tracker_id(tracker, 1) == 0 && dp_tracker_id(NULL, 0) == 0);
    REFUSED(detector, dp_detector_ground(detector, &wall, detection, ground), DP_NOT_METRIC, "floor");
    REFUSED(detector, dp_detector_ground(detector, &half, detection, ground), DP_INVALID_ARGUMENT, "not of this map");
    REFUSED(detector, dp_detector_ground(detector, &wall, detection, NULL), DP_NULL_POINTER, "ground");
    REFUSED(detector, dp_detector_ground(detector, NULL, detection, ground), DP_NULL_POINTER, "map");
    REFUSED(detector, dp_detector_track(detector, &wall, NULL, NULL, tracker), DP_NULL_POINTER, "detection");
    REFUSED(detector, dp_detector_track(detector, &wall, detection, NULL, NULL), DP_NULL_POINTER, "tracker");
    CHECK(dp_detector_track(detector, &wall, detection, still, tracker) == DP_OK && dp_tracker_id(tracker, 1) == 1);
    REFUSED(detector, dp_detector_track(detector, &wall, detection, mirror, tracker), DP_INVALID_ARGUMENT, "mirrors");
    REFUSED(detector, dp_detector_track(detector, &half, detection, NULL, tracker), DP_INVALID_ARGUMENT, "not of this map");
    CHECK(dp_tracker_tracks(tracker, &count)->age == 1 && count == 1 && dp_tracker_labels(tracker)[0] == 1);
    CHECK(dp_detector_track(detector, &wall, detection, NULL, tracker) == DP_OK && dp_tracker_tracks(tracker, NULL)->age == 2);
    REFUSED((dp_detector *)NULL, dp_ground_set_up(ground, 0, 0, 0), DP_INVALID_ARGUMENT, "not all 0");
    REFUSED((dp_detector *)NULL, dp_ground_set_camera_height(ground, -1), DP_INVALID_ARGUMENT, "above 0");
    REFUSED((dp_detector *)NULL, dp_ground_set_up(NULL, 0, -1, 0), DP_NULL_POINTER, "ground");
    CHECK(dp_ground_set_up(ground, 0, -1, 0) == DP_OK && dp_ground_set_camera_height(ground, 1.2) == DP_OK);
    dp_tracker_free(tracker);
    dp_tracker_free(NULL);
    dp_ground_free(ground);
    dp_ground_free(NULL);
}

int main(void)
{
    for (size_t at = 0; at < WIDTH * HEIGHT; at++)
        pixels[at] = 2000;
    dp_detector *detector = dp_detector_new("ngaf"); /* see test_c.py: valgrind works out other numbers of `planar` */
    dp_detection *detection = dp_detection_new();
    CHECK(!strcmp(dp_error(detector), ""));
    creation();
    nulls(detector, detection);
    maps(detector, detection);
    statements(detector);
    after_detection(detector, detection);
    grounds_and_trackers(detector, detection);
    together();
    many_planes();
    /* Nothing of what was refused is left. */
    CHECK(dp_detector_detect(detector, &wall, detection) == DP_OK);
    CHECK(dp_detection_planes(detection)[0].pixel_count == WIDTH * HEIGHT && !dp_detection_planes(detection)[0].is_metric);
    dp_detection_free(detection);
    dp_detector_free(detector);
    puts("errors: all refused");
    return 0;
}
