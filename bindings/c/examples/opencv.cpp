// Planes of a cv::Mat, without a copy in either direction.
#include <depthplanes.hpp>
#include <iostream>
#include <opencv2/core.hpp>

/// A cv::Mat of one channel, or a part of one, as a map.
depthplanes::Map map_of(const cv::Mat &mat) {
    const auto type = mat.type() == CV_8UC1    ? DP_UINT8
                      : mat.type() == CV_16UC1 ? DP_UINT16
                      : mat.type() == CV_32FC1 ? DP_FLOAT32
                      : mat.type() == CV_64FC1 ? DP_FLOAT64
                                               : throw std::invalid_argument("a map is CV_8UC1, CV_16UC1, CV_32FC1 or CV_64FC1");
    return depthplanes::Map::of(type, mat.data, static_cast<std::size_t>(mat.cols), static_cast<std::size_t>(mat.rows), mat.step);
}

/// The label image, CV_16UC1; the detection owns its memory and has to outlive it.
cv::Mat labels_of(const depthplanes::Detection &found) {
    auto *labels = const_cast<std::uint16_t *>(found.labels().data());
    return cv::Mat(static_cast<int>(found.height()), static_cast<int>(found.width()), CV_16UC1, labels);
}

/// A wall, 3 m away, with a box in front of it; take cv::imread("depth.png", cv::IMREAD_UNCHANGED).
cv::Mat synthetic() {
    cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(3000));
    depth(cv::Rect(200, 150, 240, 180)).setTo(2000);
    return depth;
}

int main() {
    depthplanes::Detector detector;
    detector.camera(580, 580, 319.5, 239.5);
    const cv::Mat depth = synthetic();
    const depthplanes::Detection found = detector.detect(map_of(depth));
    const cv::Mat labels = labels_of(found);
    for (const dp_plane &plane : found.planes()) {
        const cv::Mat mask = labels == plane.label; // CV_8UC1, 255 on the plane
        std::cout << "plane " << plane.label << ": " << cv::countNonZero(mask) << " pixels, " << plane.distance_m << " m away\n";
    }
    const cv::Mat right = depth(cv::Rect(320, 0, 320, 480)); // rows of it lie 640 pixels apart
    std::cout << detector.detect(map_of(right)).planes().size() << " planes in the right half\n";
}
