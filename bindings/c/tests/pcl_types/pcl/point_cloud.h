#pragma once
#include <cstdint>
#include <vector>

namespace pcl {
template <class Point> struct PointCloud {
    PointCloud(std::uint32_t columns, std::uint32_t rows) : points(columns * rows), width(columns), height(rows) {}

    std::vector<Point> points;
    std::uint32_t width, height;
};
} // namespace pcl
