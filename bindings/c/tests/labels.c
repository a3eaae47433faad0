/* labels TYPE WIDTH HEIGHT MAP LABELS METHOD [FLAG=VALUE..]: finds the planes of a map of raw samples and writes the label image as
 * raw samples of 16 bits. The map is searched twice: first as a copy, then where it lies, with the memory of the first. */
#include "check.h"

int main(int argc, char **argv)
{
    CHECK(argc >= 7);
    const size_t width = strtoul(argv[2], NULL, 10), height = strtoul(argv[3], NULL, 10);
    const dp_pixel_type type = pixel_type(argv[1]);
    const size_t bytes = width * height * ((size_t)1 << type);
    void *pixels = malloc(bytes);
    FILE *file = fopen(argv[4], "rb");
    CHECK(pixels && file && fread(pixels, 1, bytes, file) == bytes && fgetc(file) == EOF);
    fclose(file);

    dp_detector *detector = dp_detector_new(argv[6]);
    CHECK(detector);
    for (int at = 7; at < argc; at++)
        if (state_flag(detector, argv[at]) != DP_OK) {
            fprintf(stderr, "%s: %s\n", argv[at], dp_error(detector));
            return 1;
        }
    const dp_map map = {pixels, (int32_t)type, width, height, 0};
    dp_detection *detection = dp_detection_new();
    uint16_t *first = malloc(width * height * sizeof *first);
    for (int time = 0; time < 2; time++) {
        if (dp_detector_detect(detector, &map, detection) != DP_OK) {
            fprintf(stderr, "%s\n", dp_error(detector));
            return 1;
        }
        CHECK(dp_detection_width(detection) == width && dp_detection_height(detection) == height);
        if (time == 0)
            memcpy(first, dp_detection_labels(detection), width * height * sizeof *first);
    }
    CHECK(!memcmp(first, dp_detection_labels(detection), width * height * sizeof *first));
    file = fopen(argv[5], "wb");
    CHECK(file && fwrite(dp_detection_labels(detection), sizeof *first, width * height, file) == width * height);
    CHECK(!fclose(file));
    free(first);
    free(pixels);
    dp_detection_free(detection);
    dp_detector_free(detector);
    return 0;
}
