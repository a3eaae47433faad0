/* depthplanes finds planes in depth and disparity maps: floors, walls, tables, steps.
 *
 *     dp_detector *detector = dp_detector_new(NULL);
 *     dp_detection *detection = dp_detection_new();
 *     dp_detector_set_camera(detector, 525, 525, 319.5, 239.5);
 *     dp_map map = {pixels, DP_UINT16, 640, 480, 0};
 *     if (dp_detector_detect(detector, &map, detection) != DP_OK)
 *         fprintf(stderr, "%s\n", dp_error(detector));
 *
 * Texts are UTF-8. A detector and a detection are each used by one thread at a time, different ones by different threads at the
 * same time. No call ends the program or throws. depthplanes.hpp has the same for C++17. docs/c.md is the page about it.
 *
 * Made by cbindgen from the sources of depthplanes-c. MIT or Apache 2.0, as you like. */

#ifndef DEPTHPLANES_H
#define DEPTHPLANES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * What a call came to.
 */
typedef enum dp_status {
    /**
     * It did what it says.
     */
    DP_OK = 0,
    /**
     * A pointer is null that must not be.
     */
    DP_NULL_POINTER = 1,
    /**
     * A value that is not accepted: a size, a stride, a name, a number, a camera.
     */
    DP_INVALID_ARGUMENT = 2,
    /**
     * Metres are asked for, and the unit of the numbers or the camera is not known.
     */
    DP_NOT_METRIC = 3,
    /**
     * More planes than labels of 16 bits can name.
     */
    DP_TOO_MANY_PLANES = 4,
    /**
     * Memory that cannot be had.
     */
    DP_OUT_OF_MEMORY = 5,
    /**
     * A file that the system refuses.
     */
    DP_FILE = 6,
    /**
     * A fault of the library. The detector can be used further.
     */
    DP_INTERNAL = 7,
} dp_status;

/**
 * What a plane is to somebody who stands on the floor.
 */
typedef enum dp_plane_class {
    /**
     * None of the others.
     */
    DP_OTHER = 0,
    /**
     * The floor, or a piece of it.
     */
    DP_FLOOR = 1,
    /**
     * Level, faces down, at 1.8 m or higher.
     */
    DP_CEILING = 2,
    /**
     * Upright and at least a quarter of a square metre.
     */
    DP_WALL = 3,
    /**
     * Level, faces up, too high for a step: the top of a table, a seat, a shelf.
     */
    DP_TABLE = 4,
    /**
     * Faces up and slopes by at most 30 degrees.
     */
    DP_RAMP = 5,
    /**
     * Level, faces up, and no more than 25 cm above or below the floor or another step.
     */
    DP_STEP = 6,
} dp_plane_class;

/**
 * How a tracked plane stands in the newest frame.
 */
typedef enum dp_track_state {
    /**
     * Seen for the first time.
     */
    DP_NEW = 0,
    /**
     * Seen again.
     */
    DP_TRACKED = 1,
    /**
     * Not seen: hidden, out of the picture, or missed.
     */
    DP_LOST = 2,
    /**
     * Now part of another plane (`subsumed_by`); if they part again it gets its id back.
     */
    DP_SUBSUMED = 3,
} dp_track_state;

/**
 * The type of a map's pixels.
 */
typedef enum dp_pixel_type {
    /**
     * `uint8_t`: grey levels without a unit, unless one is stated.
     */
    DP_UINT8 = 0,
    /**
     * `uint16_t`: millimetres, unless a unit is stated.
     */
    DP_UINT16 = 1,
    /**
     * `float`: metres, unless a unit is stated.
     */
    DP_FLOAT32 = 2,
    /**
     * `double`: as `float`, to which it is converted.
     */
    DP_FLOAT64 = 3,
} dp_pixel_type;

/**
 * What was found in a map. What its functions return belongs to it, and is valid until the next detection is written to it
 * or it is freed. Threads may read one at the same time.
 */
typedef struct dp_detection dp_detection;

/**
 * Finds planes in the maps of one camera. Keep it for all frames: its memory is used again. One thread at a time may use a
 * detector; different detectors may be used at the same time.
 */
typedef struct dp_detector dp_detector;

/**
 * The ground of a map, and the memory that frames share. What its functions return belongs to it, and is valid until
 * `dp_detector_ground` writes to it again or it is freed. Threads may read one at the same time.
 */
typedef struct dp_ground dp_ground;

/**
 * Follows planes from frame to frame. What its functions return belongs to it, and is valid until the next frame or until it is
 * freed. Threads may read one at the same time.
 */
typedef struct dp_tracker dp_tracker;

/**
 * A closed ring of an outline; its last point is joined to the first.
 */
typedef struct dp_ring {
    /**
     * Its points (u, v) in pixels, centres of pixels at whole numbers.
     */
    const double (*points_px)[2];
    /**
     * The same points on the plane, metres in camera coordinates; null if these are not known.
     */
    const double (*points_m)[3];
    /**
     * How many points there are, 3 or more.
     */
    size_t point_count;
    /**
     * Whether it is a hole in the last ring before it that is none. Outer rings run counter-clockwise seen from the camera,
     * holes clockwise.
     */
    bool is_hole;
} dp_ring;

/**
 * A plane. What is in metres is in camera coordinates: x right, y down, z forward. It is NaN unless `is_metric`.
 */
typedef struct dp_plane {
    /**
     * Its value in the label image: k + 1 of the plane at place k.
     */
    uint16_t label;
    /**
     * Whether what is in metres is known: the unit of the numbers and the camera are, and no pixel lies at infinity.
     */
    bool is_metric;
    /**
     * Pixels that carry the label.
     */
    size_t pixel_count;
    /**
     * `pixel_count` as a share (0 to 1) of the map's valid pixels.
     */
    double share_of_valid;
    /**
     * Leftmost column of its pixels.
     */
    uint32_t u_min;
    /**
     * Topmost row.
     */
    uint32_t v_min;
    /**
     * Rightmost column, inclusive.
     */
    uint32_t u_max;
    /**
     * Bottom row, inclusive.
     */
    uint32_t v_max;
    /**
     * Mean (u, v) of its pixels.
     */
    double centroid_px[2];
    /**
     * (a, b, c) of value = a u + b v + c in map units, by least squares; NaN if its pixels lie in one row or one column.
     */
    double fit[3];
    /**
     * Root mean square residual of that fit, map units; NaN as `fit`.
     */
    double fit_rms;
    /**
     * Unit normal, towards the camera.
     */
    double normal[3];
    /**
     * Distance of the camera from the plane, perpendicular, metres, never below 0.
     */
    double distance_m;
    /**
     * (a, b, c, d) of a x + b y + c z + d = 0: normal and distance.
     */
    double plane_model[4];
    /**
     * Root mean square distance of its points from the plane, metres.
     */
    double rms_m;
    /**
     * Mean of its points, metres.
     */
    double centroid_m[3];
    /**
     * Area of what is seen of it, square metres; NaN also where it reaches infinity.
     */
    double area_m2;
    /**
     * Covariance of (nx, ny, nz, distance), row by row, from the noise of the sensor.
     */
    double covariance[4][4];
    /**
     * The rings of its outline, each outer ring followed by its holes; null unless outlines are made
     * (`dp_detector_set_outlines`).
     */
    const struct dp_ring *rings;
    /**
     * How many rings there are.
     */
    size_t ring_count;
} dp_plane;

/**
 * A depth or disparity map in the caller's memory, row by row, top row first. 0, NaN and infinity mean "not measured".
 *
 * Pixels of type `uint8_t`, `uint16_t` and `float` are read where they lie if they are aligned as their type asks for; all
 * else is copied once. They must not be written to during a call.
 */
typedef struct dp_map {
    /**
     * The first pixel of the first row.
     */
    const void *pixels;
    /**
     * The type of the pixels, a `dp_pixel_type`.
     */
    int32_t pixel_type;
    /**
     * Columns, 1 to 65535.
     */
    size_t width;
    /**
     * Rows, 1 to 65535; 2^30 pixels at most.
     */
    size_t height;
    /**
     * Bytes from the start of a row to the start of the next; 0 if there is no gap between them.
     */
    size_t stride_bytes;
} dp_map;

/**
 * The floor, and how the camera stands above it. Standard deviations follow from the noise of the sensor.
 */
typedef struct dp_floor {
    /**
     * Label of its largest piece, whose plane it is.
     */
    uint16_t label;
    /**
     * Pixels of all pieces.
     */
    size_t pixel_count;
    /**
     * Its unit normal, up, camera coordinates.
     */
    double normal[3];
    /**
     * Direction of view along the floor, of length 1, camera coordinates.
     */
    double ahead[3];
    /**
     * To the right of `ahead` along the floor, of length 1.
     */
    double right[3];
    /**
     * Height of the camera above it, metres.
     */
    double height_m;
    /**
     * Standard deviation of `height_m`.
     */
    double height_sd_m;
    /**
     * How far the camera looks down, degrees: 0 along the floor, 90 straight down, below 0 upwards.
     */
    double tilt_deg;
    /**
     * Standard deviation of `tilt_deg`.
     */
    double tilt_sd_deg;
    /**
     * Turn about the optical axis, degrees; above 0 where the camera's right side is lower.
     */
    double roll_deg;
    /**
     * Standard deviation of `roll_deg`.
     */
    double roll_sd_deg;
    /**
     * How sure it is that this is the floor, 0 to 1; below 0.5 look at the picture.
     */
    double confidence;
} dp_floor;

/**
 * A plane, by where it is above the floor.
 */
typedef struct dp_classified_plane {
    /**
     * Its label.
     */
    uint16_t label;
    /**
     * What it is.
     */
    enum dp_plane_class plane_class;
    /**
     * Height of its middle above the floor, metres; NaN if its place is not known.
     */
    double height_m;
    /**
     * Angle between its normal and the floor's, degrees: 0 of level planes that face up, 90 of upright ones, 180 of ceilings.
     */
    double slope_deg;
} dp_classified_plane;

/**
 * Something that a wheel does not pass: a thing on the floor, or a hole in it.
 */
typedef struct dp_obstacle {
    /**
     * Whether the floor falls here instead of something standing on it.
     */
    bool is_drop;
    /**
     * Distance of its nearest point along the floor, from the point below the camera, metres. Of a drop: to its near edge.
     */
    double distance_m;
    /**
     * Degrees to the right of the direction of view, of that point.
     */
    double bearing_deg;
    /**
     * Extent across the direction of view, metres.
     */
    double width_m;
    /**
     * Height of its highest point above the floor, metres; of a drop that of its lowest, below 0.
     */
    double height_m;
    /**
     * Leftmost column of its pixels.
     */
    uint32_t u_min;
    /**
     * Topmost row.
     */
    uint32_t v_min;
    /**
     * Rightmost column, inclusive.
     */
    uint32_t u_max;
    /**
     * Bottom row, inclusive.
     */
    uint32_t v_max;
} dp_obstacle;

/**
 * A range of bearings, and how far the floor is free in it.
 */
typedef struct dp_sector {
    /**
     * Its left end, degrees to the right of the direction of view.
     */
    double from_deg;
    /**
     * Its right end.
     */
    double to_deg;
    /**
     * Metres along the floor from the point below the camera to the nearest obstacle or drop, or to the farthest floor that is
     * seen; 0 where no floor is.
     */
    double free_m;
    /**
     * Whether an obstacle or a drop ends it. Otherwise nothing is known of what comes after `free_m`.
     */
    bool is_blocked;
} dp_sector;

/**
 * A step up from the floor, or down from it.
 */
typedef struct dp_step {
    /**
     * Label of its tread.
     */
    uint16_t label;
    /**
     * 1 for the first step up from the floor, then 2, ...; -1 for the first one down.
     */
    int32_t order;
    /**
     * Height of the tread above the floor, metres; below 0 of steps down.
     */
    double height_m;
    /**
     * Height from the level before, metres; below 0 of steps down.
     */
    double rise_m;
    /**
     * Distance from the near edge of the step before to its own, metres; NaN of the first.
     */
    double run_m;
    /**
     * Distance of the near edge from the point below the camera, metres, along the direction of the stair.
     */
    double distance_m;
} dp_step;

/**
 * A parameter of a method.
 */
typedef struct dp_parameter {
    /**
     * The name.
     */
    const char *name;
    /**
     * One sentence: what it does.
     */
    const char *about;
    /**
     * Its unit; may be empty.
     */
    const char *unit;
    /**
     * The values that are accepted, in words.
     */
    const char *accepted;
    /**
     * Its value unless one is stated.
     */
    double default_value;
} dp_parameter;

/**
 * A method.
 */
typedef struct dp_method {
    /**
     * The name.
     */
    const char *name;
    /**
     * One sentence: what it finds, and whose it is.
     */
    const char *about;
    /**
     * Its parameters, in the order of the table.
     */
    const struct dp_parameter *parameters;
    /**
     * How many there are.
     */
    size_t parameter_count;
} dp_method;

/**
 * A name that is accepted, and what it means.
 */
typedef struct dp_name {
    /**
     * The name.
     */
    const char *name;
    /**
     * One line about it.
     */
    const char *about;
} dp_name;

/**
 * A plane over frames.
 */
typedef struct dp_track {
    /**
     * Its lasting number, from 1; never given twice.
     */
    uint32_t id;
    /**
     * How it stands in this frame.
     */
    enum dp_track_state state;
    /**
     * Its label in this frame's detection; 0 if it is lost or subsumed.
     */
    uint16_t label;
    /**
     * Frames since it was first seen, this one included.
     */
    uint32_t age;
    /**
     * Frames in which it was seen.
     */
    uint32_t seen;
    /**
     * Frames since it was last seen; 0 while it is.
     */
    uint32_t unseen;
    /**
     * Id of the plane that it is part of now; 0 if of none.
     */
    uint32_t subsumed_by;
    /**
     * Id of the plane that it was part of before; 0 if of none.
     */
    uint32_t split_from;
    /**
     * Unit normal, this frame's camera coordinates, filtered over the frames; NaN where metres are not known.
     */
    double normal[3];
    /**
     * Distance of the camera from the plane, perpendicular, metres; NaN where metres are not known.
     */
    double distance_m;
    /**
     * Covariance of (nx, ny, nz, distance), row by row.
     */
    double covariance[4][4];
} dp_track;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * A detection of no map, to be written to by `dp_detector_detect`. Keep it for all frames: its memory is used again.
 */
struct dp_detection *dp_detection_new(void);

/**
 * Frees a detection; null is none.
 */
void dp_detection_free(struct dp_detection *detection);

/**
 * Columns of the map, and of the label image; 0 if nothing was found out: before the first detection, after one that
 * failed, of null.
 */
size_t dp_detection_width(const struct dp_detection *detection);

/**
 * Rows of the map, and of the label image; 0 as `dp_detection_width`.
 */
size_t dp_detection_height(const struct dp_detection *detection);

/**
 * The label image, row by row without gaps, width x height: 0 = no plane, k + 1 = plane k. Null if the width is 0.
 */
const uint16_t *dp_detection_labels(const struct dp_detection *detection);

/**
 * The label image of curved surfaces, which are no planes: 0 = none, 1 and up one surface each, the largest first. Null
 * unless the detector was asked for them (`curved` of `dp_detector_set`).
 */
const uint16_t *dp_detection_curved_labels(const struct dp_detection *detection);

/**
 * How many planes there are.
 */
size_t dp_detection_plane_count(const struct dp_detection *detection);

/**
 * The planes, the largest first; null if there are none.
 */
const struct dp_plane *dp_detection_planes(const struct dp_detection *detection);

/**
 * What looks wrong with the map or with what was found, a line for each note, with what to state instead; `--x` in them is
 * the setting `x`. Only the first map of each size and type is looked at; of the others it is empty.
 */
const char *dp_detection_notes(const struct dp_detection *detection);

/**
 * A detector of the method of that name (`dp_methods`), null for the usual one, which needs no parameter. Null if there is
 * no such method; `dp_error(NULL)` then says which there are.
 */
struct dp_detector *dp_detector_new(const char *method);

/**
 * Frees a detector; null is none. What it has found stays.
 */
void dp_detector_free(struct dp_detector *detector);

/**
 * The text of the last error of a detector: what was given, what is accepted. Of null: of the last call of this thread that
 * failed without a detector, such as `dp_detector_new`. It is empty if there was none, and valid until the next error.
 */
const char *dp_error(const struct dp_detector *detector);

/**
 * Finds the planes of a map and writes them to a detection, whatever it held before. If that fails, it holds nothing.
 */
enum dp_status dp_detector_detect(struct dp_detector *detector,
                                  const struct dp_map *map,
                                  struct dp_detection *detection);

/**
 * Writes the points of a plane as they were measured, metres in camera coordinates, row by row: `pixel_count` of them, NaN where
 * nothing was measured. There is room for `capacity` of them. The map is read again; it has to be the one that the detection
 * is of. Needs unit and camera.
 */
enum dp_status dp_detector_points(struct dp_detector *detector,
                                  const struct dp_map *map,
                                  const struct dp_detection *detection,
                                  uint16_t label,
                                  double (*points)[3],
                                  size_t capacity);

/**
 * Finds the floor of a map by what was found in it, what stands on it, and what each plane is, and writes it to a ground,
 * whatever it held before. If that fails, it holds nothing. The map is read again; it has to be the one that the detection is of.
 * Needs unit and camera.
 */
enum dp_status dp_detector_ground(struct dp_detector *detector,
                                  const struct dp_map *map,
                                  const struct dp_detection *detection,
                                  struct dp_ground *ground);

/**
 * Gives what was found in the next frame of a camera to a tracker, by which planes keep their ids. `pose` is null, or the camera's
 * pose if it is known: 12 numbers, row by row the first three rows of the matrix that takes camera coordinates to those of a
 * world that stays the same, metres; of a matrix of 4 x 4 in row-major order they are the first 12. Without it the motion is
 * estimated from the planes. The map is read again; it has to be the one that the
 * detection is of. If it fails, the tracker stays as it was.
 */
enum dp_status dp_detector_track(struct dp_detector *detector,
                                 const struct dp_map *map,
                                 const struct dp_detection *detection,
                                 const double *pose,
                                 struct dp_tracker *tracker);

/**
 * Says why the pixel in column u, row v of a map has a plane or none: a sentence, and a line for each parameter that helps, with
 * its value. Runs the method several times. What `text` is set to is valid until the next call of it with this detector.
 */
enum dp_status dp_detector_explain(struct dp_detector *detector,
                                   const struct dp_map *map,
                                   size_t u,
                                   size_t v,
                                   const char **text);

/**
 * A ground of no map, to be written to by `dp_detector_ground`. Keep it for all frames of a camera: its memory is used again.
 */
struct dp_ground *dp_ground_new(void);

/**
 * Frees a ground; null is none.
 */
void dp_ground_free(struct dp_ground *ground);

/**
 * States the direction that is up, in camera coordinates (x right, y down, z forward), of any length: what an accelerometer at
 * rest measures, turned into the camera's axes. It may change from frame to frame. Without it up is estimated from the planes, for
 * a camera that is upright to within 60 degrees. The text of an error is that of `dp_error(NULL)`.
 */
enum dp_status dp_ground_set_up(struct dp_ground *ground,
                                double x,
                                double y,
                                double z);

/**
 * States the camera's height above the floor that it stands on, metres: of several levels the one nearest to it is the floor.
 * Without it the lowest is. The text of an error is that of `dp_error(NULL)`.
 */
enum dp_status dp_ground_set_camera_height(struct dp_ground *ground,
                                           double height_m);

/**
 * The floor; null if there is none in view, none that can be told from a wall, or nothing was looked for.
 */
const struct dp_floor *dp_ground_floor(const struct dp_ground *ground);

/**
 * What each pixel is, row by row without gaps: 0 not known, 1 floor, 2 obstacle, 4 drop, 8 overhead (above 2 m). Null without
 * a floor.
 */
const uint8_t *dp_ground_marks(const struct dp_ground *ground);

/**
 * What each plane of the detection is, in its order. Their number is written to `count`, unless that is null. Null without a floor.
 */
const struct dp_classified_plane *dp_ground_planes(const struct dp_ground *ground,
                                                   size_t *count);

/**
 * What stands on the floor and where it falls, the nearest first. Their number is written to `count`, unless that is null. Null if
 * there is nothing.
 */
const struct dp_obstacle *dp_ground_obstacles(const struct dp_ground *ground,
                                              size_t *count);

/**
 * How far the floor is free, from left to right across the picture. Their number is written to `count`, unless that is null.
 * Null without a floor.
 */
const struct dp_sector *dp_ground_sectors(const struct dp_ground *ground,
                                          size_t *count);

/**
 * Steps up from the floor, then steps down. Their number is written to `count`, unless that is null. Null if there are none.
 */
const struct dp_step *dp_ground_steps(const struct dp_ground *ground,
                                      size_t *count);

/**
 * States a number by name: a parameter of the method (`dp_methods`), or
 *
 * - `scale`, `depth-scale`: map units per metre, or metres per map unit
 * - `missing`: a value that means "not measured", beside 0, NaN and infinity
 * - `focal` (pixels), `baseline` (metres), `doffs` (pixels): the stereo rig; the numbers are then disparities
 * - `disparity`, `ray-distance`: 1 if the numbers are disparities, or distances along the rays
 * - `curved`: 1 if curved surfaces are wanted as well
 * - `threads`: 1 and up; the answer is the same for any number
 */
enum dp_status dp_detector_set(struct dp_detector *detector, const char *name, double value);

/**
 * As `dp_detector_set`, of a number that is written as text, as on a command line.
 */
enum dp_status dp_detector_set_text(struct dp_detector *detector, const char *name, const char *value);

/**
 * States the sensor by name (`dp_sensors`), such as "kinect1": its unit, its nominal camera and its noise.
 */
enum dp_status dp_detector_set_sensor(struct dp_detector *detector, const char *sensor);

/**
 * States what the numbers mean, by name (`dp_units`): "mm", "m", "tum", "disparity" and others. Without it 16-bit numbers are
 * millimetres, floats are metres, and 8-bit numbers are grey levels without a unit.
 */
enum dp_status dp_detector_set_unit(struct dp_detector *detector,
                                    const char *unit);

/**
 * States the camera: focal lengths and principal point in pixels, centres of pixels at whole numbers. Without a camera planes
 * have labels and no metres.
 */
enum dp_status dp_detector_set_camera(struct dp_detector *detector,
                                      double fx,
                                      double fy,
                                      double cx,
                                      double cy);

/**
 * States the camera, its lens and its stereo rig by a file of ROS, OpenCV, RealSense, COLMAP, KITTI and many more programs.
 */
enum dp_status dp_detector_set_camera_file(struct dp_detector *detector,
                                           const char *path);

/**
 * States that only values from `low` to `high`, in map units, are measurements.
 */
enum dp_status dp_detector_set_valid_range(struct dp_detector *detector, double low, double high);

/**
 * Joins pieces of one plane whose normals differ by no more than that and that lie within that distance of one plane. Needs
 * unit and camera.
 */
enum dp_status dp_detector_set_merge_coplanar(struct dp_detector *detector,
                                              double angle_deg,
                                              double distance_m);

/**
 * Makes outlines of all planes from now on, which takes time: rings within `tolerance_px` pixels of the planes' borders (1.5
 * makes lines of the steps along straight edges, 0 keeps every corner), without holes of fewer than `min_hole_px` pixels.
 */
enum dp_status dp_detector_set_outlines(struct dp_detector *detector,
                                        double tolerance_px,
                                        size_t min_hole_px);

/**
 * All methods, the usual one first. Their number is written to `count`, unless that is null.
 */
const struct dp_method *dp_methods(size_t *count);

/**
 * All sensors that `dp_detector_set_sensor` knows. Their number is written to `count`, unless that is null.
 */
const struct dp_name *dp_sensors(size_t *count);

/**
 * All units that `dp_detector_set_unit` knows. Their number is written to `count`, unless that is null.
 */
const struct dp_name *dp_units(size_t *count);

/**
 * The version of the library.
 */
const char *dp_version(void);

/**
 * A tracker that keeps the id of a plane that is not seen for `kept_frames` frames; 0 for the usual number, 30.
 */
struct dp_tracker *dp_tracker_new(uint32_t kept_frames);

/**
 * Frees a tracker; null is none.
 */
void dp_tracker_free(struct dp_tracker *tracker);

/**
 * The planes that are followed, by id: those of this frame, and those that are lost or subsumed. Their number is written to
 * `count`, unless that is null. Null if there are none.
 */
const struct dp_track *dp_tracker_tracks(const struct dp_tracker *tracker,
                                         size_t *count);

/**
 * The id of a label of this frame; 0 if there is no such label.
 */
uint32_t dp_tracker_id(const struct dp_tracker *tracker, uint16_t label);

/**
 * This frame's label image with borders that do not flicker, row by row without gaps: where planes meet, pixels that lie on both
 * are of the one that they were of before. Labels are those of the detection. Null before the first frame.
 */
const uint16_t *dp_tracker_labels(const struct dp_tracker *tracker);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* DEPTHPLANES_H */
