// Planes of an organised cloud of the Point Cloud Library, as the indices and coefficients that its filters take.
#include <algorithm>
#include <cmath>
#include <depthplanes.hpp>
#include <iostream>
#include <pcl/ModelCoefficients.h>
#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

/// The camera that the cloud is of; drivers of cameras publish it beside the cloud.
constexpr double FOCAL = 290, CX = 159.5, CY = 119.5;

/// The points of a plane.
pcl::PointIndices indices_of(const depthplanes::Detection &found, const dp_plane &plane) {
    pcl::PointIndices inliers;
    inliers.indices = found.indices(plane.label);
    return inliers;
}

/// a, b, c, d of a x + b y + c z + d = 0.
pcl::ModelCoefficients coefficients_of(const dp_plane &plane) {
    pcl::ModelCoefficients model;
    model.values.assign(plane.plane_model, plane.plane_model + 4);
    return model;
}

/// A wall, 2 m away, and a step in front of it.
pcl::PointCloud<pcl::PointXYZ> synthetic() {
    pcl::PointCloud<pcl::PointXYZ> cloud(320, 240);
    for (std::size_t at = 0; at < cloud.points.size(); ++at) {
        const double u = static_cast<double>(at % 320), v = static_cast<double>(at / 320), z = v < 160 ? 2.0 : 1.5;
        cloud.points[at].x = static_cast<float>((u - CX) / FOCAL * z);
        cloud.points[at].y = static_cast<float>((v - CY) / FOCAL * z);
        cloud.points[at].z = static_cast<float>(z);
    }
    return cloud;
}

int main() {
    const pcl::PointCloud<pcl::PointXYZ> cloud = synthetic();
    const std::vector<float> depth = depthplanes::depth_of(cloud);
    depthplanes::Detector detector;
    detector.camera(FOCAL, FOCAL, CX, CY);
    const depthplanes::Detection found = detector.detect(depthplanes::Map(depth.data(), cloud.width, cloud.height));
    for (const dp_plane &plane : found.planes()) {
        const pcl::ModelCoefficients model = coefficients_of(plane);
        double worst = 0;
        for (const int at : indices_of(found, plane).indices) {
            const pcl::PointXYZ &point = cloud.points[static_cast<std::size_t>(at)];
            const double off = model.values[0] * point.x + model.values[1] * point.y + model.values[2] * point.z + model.values[3];
            worst = std::max(worst, std::abs(off));
        }
        std::cout << "plane " << plane.label << ": " << plane.pixel_count << " points within " << (worst < 0.001 ? "1 mm" : "more")
                  << ", " << model.values[3] << " m away\n";
    }
}
