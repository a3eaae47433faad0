// As labels.c, by the wrapper.
#include "check.h"
#include <depthplanes.hpp>
#include <fstream>
#include <iterator>

int main(int argc, char **argv) {
    CHECK(argc >= 7);
    std::ifstream file(argv[4], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    depthplanes::Detector detector(argv[6]);
    for (int at = 7; at < argc; ++at)
        CHECK(state_flag(detector.get(), argv[at]) == DP_OK);
    const auto map = depthplanes::Map::of(pixel_type(argv[1]), bytes.data(), std::stoul(argv[2]), std::stoul(argv[3]));
    const depthplanes::Detection found = detector.detect(map);
    const auto labels = found.labels();
    std::ofstream(argv[5], std::ios::binary)
        .write(reinterpret_cast<const char *>(labels.data()), static_cast<std::streamsize>(labels.size() * sizeof labels[0]));
}
