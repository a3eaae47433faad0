#pragma once
#include <vector>

namespace pcl {
struct ModelCoefficients {
    std::vector<float> values;
};
} // namespace pcl
