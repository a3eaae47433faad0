/* What examples/pcl.cpp takes of the Point Cloud Library, with the same members at the same places: that is 300 MB to install, and
 * the tests do without it. */
#pragma once

namespace pcl {
struct alignas(16) PointXYZ {
    float x = 0, y = 0, z = 0;
};
} // namespace pcl
