// Detectors of several threads run at the same time, threads read one detection at the same time, and texts of errors are each
// thread's and each detector's own.
#include "check.h"
#include <atomic>
#include <depthplanes.hpp>
#include <functional>
#include <thread>

namespace {

constexpr std::size_t WIDTH = 160, HEIGHT = 120;
constexpr int THREADS = 4, FRAMES = 25;

/// A wall with a step of its own in each frame.
std::vector<std::uint16_t> frame(int number) {
    std::vector<std::uint16_t> depth(WIDTH * HEIGHT, 3000);
    for (std::size_t at = 0; at < depth.size(); ++at)
        if (at % WIDTH < 40 + static_cast<std::size_t>(number))
            depth[at] = 2000;
    return depth;
}

std::vector<std::size_t> counts(const depthplanes::Detection &found) {
    std::vector<std::size_t> counts;
    for (const dp_plane &plane : found.planes())
        counts.push_back(plane.pixel_count);
    return counts;
}

void work(int number, const depthplanes::Detection &shared, const std::vector<std::size_t> &expected, std::atomic<int> &done) {
    depthplanes::Detector detector(number % 2 == 0 ? "planar" : "ngaf");
    depthplanes::Detection found;
    for (int at = 0; at < FRAMES; ++at) {
        const auto depth = frame(number + at);
        detector.detect({depth.data(), WIDTH, HEIGHT}, found);
        const std::size_t near = HEIGHT * (40 + static_cast<std::size_t>(number + at));
        CHECK(found.planes().size() == 2 && found.plane(2).pixel_count + found.plane(1).pixel_count == WIDTH * HEIGHT);
        CHECK(found.plane(1).pixel_count == near || found.plane(2).pixel_count == near);
        CHECK(counts(shared) == expected);
        const std::string name = "frob" + std::to_string(number);
        CHECK(dp_detector_new(name.c_str()) == nullptr);
        CHECK(dp_detector_set(detector.get(), name.c_str(), 1) == DP_INVALID_ARGUMENT);
        CHECK(strstr(dp_error(nullptr), name.c_str()) && strstr(dp_error(detector.get()), name.c_str()));
        ++done;
    }
}

} // namespace

int main() {
    const auto depth = frame(0);
    const auto shared = depthplanes::Detector().detect({depth.data(), WIDTH, HEIGHT});
    const auto expected = counts(shared);
    std::atomic<int> done{0};
    std::vector<std::thread> threads;
    for (int number = 0; number < THREADS; ++number)
        threads.emplace_back(work, number, std::cref(shared), std::cref(expected), std::ref(done));
    for (auto &thread : threads)
        thread.join();
    CHECK(done == THREADS * FRAMES);
    // A detector and its detection may go from thread to thread.
    auto moved = depthplanes::Detector();
    std::thread([&] { CHECK(moved.detect({depth.data(), WIDTH, HEIGHT}).planes().size() == 2); }).join();
    CHECK(moved.detect({depth.data(), WIDTH, HEIGHT}).planes().size() == 2);
}
