// walk FOLDER WIDTH HEIGHT FX,FY,CX,CY LABELS: follows the frames FOLDER/0.raw, 1.raw, .. of a camera, millimetres, with the poses
// FOLDER/0.pose, .. if they are there. Prints a line of JSON for each frame, and writes the label images with held borders one after
// the other.
#include "check.h"
#include <depthplanes.hpp>
#include <fstream>
#include <iostream>

namespace {

/// What is known of the frame's ground.
void print(const depthplanes::Ground &ground, std::size_t pixels) {
    if (const dp_floor *floor = ground.floor()) {
        std::cout << "\"floor\": [" << floor->label << ", " << floor->height_m << ", " << floor->tilt_deg << ", " << floor->roll_deg << "], ";
        std::size_t marked = 0;
        for (std::size_t at = 0; at < pixels; ++at)
            marked += ground.marks()[at] == 1;
        std::cout << "\"floor_pixels\": " << marked << ", ";
    }
    std::cout << "\"classes\": [-1";
    for (const dp_classified_plane &plane : ground.planes())
        std::cout << ", " << plane.plane_class;
    std::cout << "], \"obstacles\": [-1";
    for (const dp_obstacle &obstacle : ground.obstacles())
        std::cout << ", " << obstacle.distance_m;
    std::cout << "], \"free\": [-1";
    for (const dp_sector &sector : ground.sectors())
        std::cout << ", " << sector.free_m;
    std::cout << "], \"steps\": " << ground.steps().size();
}

} // namespace

int main(int argc, char **argv) {
    CHECK(argc == 6);
    const std::string folder = argv[1];
    const std::size_t width = std::stoul(argv[2]), height = std::stoul(argv[3]);
    depthplanes::Detector detector;
    CHECK(state_flag(detector.get(), ("intrinsics=" + std::string(argv[4])).c_str()) == DP_OK);
    depthplanes::Detection found;
    depthplanes::Ground ground;
    depthplanes::Tracker tracker;
    std::vector<std::uint16_t> pixels(width * height);
    std::ofstream labels(argv[5], std::ios::binary);
    std::cout.precision(12);
    for (int frame = 0;; ++frame) {
        std::ifstream raw(folder + "/" + std::to_string(frame) + ".raw", std::ios::binary);
        if (!raw.read(reinterpret_cast<char *>(pixels.data()), static_cast<std::streamsize>(2 * pixels.size())))
            return frame == 0;
        std::ifstream file(folder + "/" + std::to_string(frame) + ".pose");
        depthplanes::Pose pose{};
        for (auto &row : pose)
            for (double &number : row)
                file >> number;
        const depthplanes::Map map(pixels.data(), width, height);
        detector.detect(map, found);
        detector.ground(map, found, ground);
        detector.track(map, found, tracker, file ? &pose : nullptr);
        std::cout << "{\"ids\": [-1";
        for (const dp_plane &plane : found.planes())
            std::cout << ", " << tracker.id(plane.label);
        std::cout << "], \"lost\": [-1";
        for (const dp_track &track : tracker.tracks())
            if (track.state == DP_LOST)
                std::cout << ", " << track.id;
        std::cout << "], \"distances\": [-1";
        for (const dp_track &track : tracker.tracks())
            if (track.label)
                std::cout << ", " << track.distance_m;
        std::cout << "], ";
        print(ground, pixels.size());
        std::cout << "}\n";
        labels.write(reinterpret_cast<const char *>(tracker.labels()), static_cast<std::streamsize>(2 * pixels.size()));
    }
}
