// depthplanes for C++17: finds planes in depth and disparity maps. It wraps depthplanes.h; docs/c.md is the page about it.
//
//     depthplanes::Detector detector;
//     detector.camera(525, 525, 319.5, 239.5);
//     depthplanes::Detection found = detector.detect(depthplanes::Map(pixels, 640, 480));
//     for (const dp_plane &plane : found.planes())
//         std::cout << plane.distance_m << " m\n";
//
// What fails throws depthplanes::Error. MIT or Apache 2.0, as you like.
#ifndef DEPTHPLANES_HPP
#define DEPTHPLANES_HPP

#include "depthplanes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace depthplanes {

/// What failed, with the text of the library: what was given, what is accepted.
class Error : public std::runtime_error {
public:
    Error(dp_status status, const char *text) : std::runtime_error(text), status_(status) {}

    /// By whose fault it is.
    dp_status status() const noexcept { return status_; }

private:
    dp_status status_;
};

/// A text for C, which ends at its first zero byte: one within it is refused.
inline const char *text(const std::string &of) {
    if (of.find('\0') != std::string::npos)
        throw Error(DP_INVALID_ARGUMENT, ("`" + std::string(of.c_str()) + "...` has a zero byte in it; accepted: text").c_str());
    return of.c_str();
}

/// Values side by side in memory that somebody else owns, as std::span of C++20.
template <class T> class Span {
public:
    Span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}

    T *data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    T *begin() const noexcept { return data_; }
    T *end() const noexcept { return data_ + size_; }
    T &operator[](std::size_t at) const { return data_[at]; }

    T &at(std::size_t at) const {
        if (at >= size_)
            throw std::out_of_range("place " + std::to_string(at) + " of " + std::to_string(size_));
        return data_[at];
    }

private:
    T *data_;
    std::size_t size_;
};

/// A map in the caller's memory, row by row, top row first; it owns nothing. Pixels are of type std::uint8_t, std::uint16_t,
/// float or double.
class Map {
public:
    /// `stride_bytes` from the start of a row to the start of the next; 0 if there is no gap between them.
    template <class T>
    Map(const T *pixels, std::size_t width, std::size_t height, std::size_t stride_bytes = 0) noexcept
        : map_{pixels, static_cast<std::int32_t>(type_of<T>()), width, height, stride_bytes} {}

    /// Of pixels whose type is known only when the program runs.
    static Map of(dp_pixel_type type, const void *pixels, std::size_t width, std::size_t height, std::size_t stride_bytes = 0) {
        return Map(dp_map{pixels, static_cast<std::int32_t>(type), width, height, stride_bytes});
    }

    const dp_map *get() const noexcept { return &map_; }

private:
    explicit Map(const dp_map &map) noexcept : map_(map) {}

    template <class T> static constexpr dp_pixel_type type_of() {
        constexpr bool is_known = std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t> ||
                                  std::is_same_v<T, float> || std::is_same_v<T, double>;
        static_assert(is_known, "pixels are std::uint8_t, std::uint16_t, float or double");
        return sizeof(T) == 1 ? DP_UINT8 : sizeof(T) == 2 ? DP_UINT16 : sizeof(T) == 4 ? DP_FLOAT32 : DP_FLOAT64;
    }

    dp_map map_;
};

/// What was found in a map. What it lends is valid until the next detection is written to it, and as long as it lives.
class Detection {
public:
    Detection() : detection_(dp_detection_new()) {}

    std::size_t width() const noexcept { return dp_detection_width(get()); }
    std::size_t height() const noexcept { return dp_detection_height(get()); }

    /// The label image, row by row: 0 = no plane, k + 1 = plane k.
    Span<const std::uint16_t> labels() const noexcept { return {dp_detection_labels(get()), width() * height()}; }

    /// The label image of curved surfaces; empty unless they were asked for.
    Span<const std::uint16_t> curved_labels() const noexcept {
        const std::uint16_t *labels = dp_detection_curved_labels(get());
        return {labels, labels ? width() * height() : 0};
    }

    /// The planes, the largest first.
    Span<const dp_plane> planes() const noexcept { return {dp_detection_planes(get()), dp_detection_plane_count(get())}; }

    /// The plane with that label.
    const dp_plane &plane(std::uint16_t label) const {
        if (label == 0 || label > planes().size()) {
            const std::string there = std::to_string(planes().size());
            throw Error(DP_INVALID_ARGUMENT, ("there is no plane " + std::to_string(label) + "; there are " + there).c_str());
        }
        return planes()[std::size_t{label} - 1];
    }

    /// Places in the label image of the pixels of a plane, in order, as the indices of an organised point cloud.
    std::vector<int> indices(std::uint16_t label) const {
        std::vector<int> indices;
        indices.reserve(plane(label).pixel_count);
        const Span<const std::uint16_t> all = labels();
        for (std::size_t at = 0; at < all.size(); ++at)
            if (all[at] == label)
                indices.push_back(static_cast<int>(at));
        return indices;
    }

    /// What looks wrong, a line for each note; of the first map of each size and type alone.
    const char *notes() const noexcept { return dp_detection_notes(get()); }

    dp_detection *get() const noexcept { return detection_.get(); }

private:
    struct Free {
        void operator()(dp_detection *detection) const noexcept { dp_detection_free(detection); }
    };
    std::unique_ptr<dp_detection, Free> detection_;
};

/// The rings of a plane's outline, each outer ring followed by its holes.
inline Span<const dp_ring> rings(const dp_plane &plane) noexcept { return {plane.rings, plane.ring_count}; }

/// Values that the library lends, with their number.
template <class Row, class Of> Span<const Row> lent(const Row *(*rows)(const Of *, std::size_t *), const Of *of) noexcept {
    std::size_t count = 0;
    const Row *first = rows(of, &count);
    return {first, count};
}

/// The floor of a map, and what stands on it. What it lends is valid until it is written to again, and as long as it lives.
class Ground {
public:
    Ground() : ground_(dp_ground_new()) {}

    /// The direction that is up, camera coordinates, of any length: what an accelerometer at rest measures.
    Ground &up(double x, double y, double z) { return done(dp_ground_set_up(get(), x, y, z)); }

    /// Height of the camera above the floor that it stands on, metres: of several levels the one nearest to it is the floor.
    Ground &camera_height(double height_m) { return done(dp_ground_set_camera_height(get(), height_m)); }

    /// The floor; null if there is none.
    const dp_floor *floor() const noexcept { return dp_ground_floor(get()); }

    /// What each pixel is, width x height of the detection: 0 not known, 1 floor, 2 obstacle, 4 drop, 8 overhead. Null without a floor.
    const std::uint8_t *marks() const noexcept { return dp_ground_marks(get()); }

    /// What each plane of the detection is; empty without a floor.
    Span<const dp_classified_plane> planes() const noexcept { return lent(dp_ground_planes, get()); }

    /// What stands on the floor and where it falls, the nearest first.
    Span<const dp_obstacle> obstacles() const noexcept { return lent(dp_ground_obstacles, get()); }

    /// How far the floor is free, from left to right.
    Span<const dp_sector> sectors() const noexcept { return lent(dp_ground_sectors, get()); }

    /// Steps up from the floor, then steps down.
    Span<const dp_step> steps() const noexcept { return lent(dp_ground_steps, get()); }

    const dp_ground *get() const noexcept { return ground_.get(); }
    dp_ground *get() noexcept { return ground_.get(); }

private:
    struct Free {
        void operator()(dp_ground *ground) const noexcept { dp_ground_free(ground); }
    };

    Ground &done(dp_status status) {
        if (status != DP_OK)
            throw Error(status, dp_error(nullptr));
        return *this;
    }

    std::unique_ptr<dp_ground, Free> ground_;
};

/// Where a camera is: the first three rows of the matrix that takes camera coordinates to those of the world, metres.
using Pose = std::array<std::array<double, 4>, 3>;

/// Planes that keep their ids from frame to frame. What it lends is valid until the next frame, and as long as it lives.
class Tracker {
public:
    /// The id of a plane that is not seen is kept for so many frames.
    explicit Tracker(std::uint32_t kept_frames = 30) : tracker_(dp_tracker_new(kept_frames)) {}

    /// The planes that are followed, by id: those of the newest frame, and those that are lost or subsumed.
    Span<const dp_track> tracks() const noexcept { return lent(dp_tracker_tracks, get()); }

    /// The id of a label of the newest frame; 0 if there is no such label.
    std::uint32_t id(std::uint16_t label) const noexcept { return dp_tracker_id(get(), label); }

    /// The newest frame's label image with borders that do not flicker, width x height of the detection; null before the first.
    const std::uint16_t *labels() const noexcept { return dp_tracker_labels(get()); }

    const dp_tracker *get() const noexcept { return tracker_.get(); }
    dp_tracker *get() noexcept { return tracker_.get(); }

private:
    struct Free {
        void operator()(dp_tracker *tracker) const noexcept { dp_tracker_free(tracker); }
    };
    std::unique_ptr<dp_tracker, Free> tracker_;
};

/// Finds planes in the maps of one camera. Keep it for all frames. One thread at a time may use it.
class Detector {
public:
    /// Of the usual method, which needs no parameter.
    Detector() : Detector(dp_detector_new(nullptr)) {}

    /// Of the method of that name (`methods`).
    explicit Detector(const std::string &method) : Detector(dp_detector_new(text(method))) {}

    /// A number by name: a parameter of the method, or what `dp_detector_set` lists.
    Detector &set(const std::string &name, double value) { return done(dp_detector_set(get(), text(name), value)); }

    /// The same as text, as on a command line.
    Detector &set_text(const std::string &name, const std::string &value) {
        return done(dp_detector_set_text(get(), text(name), text(value)));
    }

    /// The sensor by name (`sensors`): unit, nominal camera, noise.
    Detector &sensor(const std::string &name) { return done(dp_detector_set_sensor(get(), text(name))); }

    /// What the numbers mean, by name (`units`).
    Detector &unit(const std::string &name) { return done(dp_detector_set_unit(get(), text(name))); }

    /// Focal lengths and principal point, pixels.
    Detector &camera(double fx, double fy, double cx, double cy) {
        return done(dp_detector_set_camera(get(), fx, fy, cx, cy));
    }

    /// A camera file of any program that is known.
    Detector &camera_file(const std::string &path) { return done(dp_detector_set_camera_file(get(), text(path))); }

    /// Only values from `low` to `high`, in map units, are measurements.
    Detector &valid_range(double low, double high) { return done(dp_detector_set_valid_range(get(), low, high)); }

    /// Joins pieces of one plane within an angle and a distance.
    Detector &merge_coplanar(double angle_deg = 3, double distance_m = 0.03) {
        return done(dp_detector_set_merge_coplanar(get(), angle_deg, distance_m));
    }

    /// Makes outlines of all planes from now on.
    Detector &outlines(double tolerance_px = 1.5, std::size_t min_hole_px = 0) {
        return done(dp_detector_set_outlines(get(), tolerance_px, min_hole_px));
    }

    /// The planes of a map.
    Detection detect(const Map &map) {
        Detection detection;
        detect(map, detection);
        return detection;
    }

    /// The planes of a map, written to a detection whose memory is used again.
    void detect(const Map &map, Detection &detection) { done(dp_detector_detect(get(), map.get(), detection.get())); }

    /// The floor of the map that the detection is of, and what stands on it.
    void ground(const Map &map, const Detection &detection, Ground &ground) {
        done(dp_detector_ground(get(), map.get(), detection.get(), ground.get()));
    }

    /// Gives what was found in the next frame to a tracker, with the camera's pose if it is known.
    void track(const Map &map, const Detection &detection, Tracker &tracker, const Pose *pose = nullptr) {
        done(dp_detector_track(get(), map.get(), detection.get(), pose ? pose->front().data() : nullptr, tracker.get()));
    }

    /// The points of a plane as they were measured, metres, of the map that the detection is of.
    std::vector<std::array<double, 3>> points(const Map &map, const Detection &detection, std::uint16_t label) {
        std::vector<std::array<double, 3>> points(detection.plane(label).pixel_count);
        auto *first = reinterpret_cast<double(*)[3]>(points.data());
        done(dp_detector_points(get(), map.get(), detection.get(), label, first, points.size()));
        return points;
    }

    /// Why the pixel in column u, row v has a plane or none, and what to change.
    std::string explain(const Map &map, std::size_t u, std::size_t v) {
        const char *text = nullptr;
        done(dp_detector_explain(get(), map.get(), u, v, &text));
        return text;
    }

    dp_detector *get() const noexcept { return detector_.get(); }

private:
    struct Free {
        void operator()(dp_detector *detector) const noexcept { dp_detector_free(detector); }
    };

    explicit Detector(dp_detector *made) : detector_(made) {
        if (!detector_)
            throw Error(DP_INVALID_ARGUMENT, dp_error(nullptr));
    }

    Detector &done(dp_status status) {
        if (status != DP_OK)
            throw Error(status, dp_error(get()));
        return *this;
    }

    std::unique_ptr<dp_detector, Free> detector_;
};

/// A row of `table`, which is one of dp_methods, dp_sensors and dp_units, for each thing there is.
template <class Row> Span<const Row> rows(const Row *(*table)(std::size_t *)) {
    std::size_t count = 0;
    const Row *first = table(&count);
    return {first, count};
}

/// All methods, the usual one first.
inline Span<const dp_method> methods() { return rows(dp_methods); }

/// All sensors that `Detector::sensor` knows.
inline Span<const dp_name> sensors() { return rows(dp_sensors); }

/// All units that `Detector::unit` knows.
inline Span<const dp_name> units() { return rows(dp_units); }

/// The depth of an organised point cloud, metres along z, for a Map of floats: of pcl::PointCloud and whatever else has
/// `width`, `height` and `points[i].z`.
template <class Cloud> std::vector<float> depth_of(const Cloud &cloud) {
    if (cloud.height < 2 || cloud.points.size() != std::size_t{cloud.width} * cloud.height)
        throw Error(DP_INVALID_ARGUMENT, "the cloud is not organised; accepted: width x height points of a camera, row by row");
    std::vector<float> depth;
    depth.reserve(cloud.points.size());
    for (const auto &point : cloud.points)
        depth.push_back(static_cast<float>(point.z));
    return depth;
}

} // namespace depthplanes

#endif
