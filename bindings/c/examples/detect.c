/* detect [MAP.pgm]: prints the planes of a map of 16 bits, in millimetres, that a camera of 580 pixels focal length saw. Without a
 * map it makes one: a slanted wall above a floor, 0.6 m below the camera. */
#include <depthplanes.h>
#include <stdio.h>
#include <stdlib.h>

struct image {
    size_t width, height;
    uint16_t *pixels;
};

static struct image synthetic(void)
{
    struct image image = {640, 480, malloc(640 * 480 * sizeof(uint16_t))};
    for (size_t at = 0; image.pixels && at < 640 * 480; at++) {
        double below = ((double)(at / 640) - 239.5) / 580; /* y of the ray whose z is 1 */
        double floor = below > 0.05 ? 600 / below : 1e9, wall = 3000 / (1 + (double)(at % 640) / 6400);
        image.pixels[at] = (uint16_t)(floor < wall ? floor : wall);
    }
    return image;
}

/* Pixels of PGM files have their high byte first. */
static struct image read_pgm(const char *path)
{
    struct image image = {0, 0, NULL};
    FILE *file = fopen(path, "rb");
    unsigned most = 0;
    if (file && fscanf(file, "P5 %zu %zu %u", &image.width, &image.height, &most) == 3 && fgetc(file) != EOF && most > 255 &&
        image.width <= 65535 && image.height <= 65535)
        image.pixels = calloc(image.width * image.height, sizeof(uint16_t));
    for (size_t at = 0; image.pixels && at < image.width * image.height; at++) {
        int high = fgetc(file), low = fgetc(file);
        image.pixels[at] = (uint16_t)(low == EOF ? 0 : high << 8 | low);
    }
    if (file)
        fclose(file);
    return image;
}

static void print(const dp_detection *detection)
{
    const dp_plane *planes = dp_detection_planes(detection);
    for (size_t k = 0; k < dp_detection_plane_count(detection); k++)
        printf("plane %d: %zu pixels, %.3f m away, %.2f m2, normal %.3f %.3f %.3f\n", planes[k].label, planes[k].pixel_count,
               planes[k].distance_m, planes[k].area_m2, planes[k].normal[0], planes[k].normal[1], planes[k].normal[2]);
    if (*dp_detection_notes(detection)) /* what looks wrong with the map */
        printf("%s\n", dp_detection_notes(detection));
}

int main(int argc, char **argv)
{
    struct image image = argc > 1 ? read_pgm(argv[1]) : synthetic();
    dp_map map = {image.pixels, DP_UINT16, image.width, image.height, 0};
    dp_detector *detector = dp_detector_new(NULL);
    dp_detection *detection = dp_detection_new();
    dp_status status = dp_detector_set_camera(detector, 580, 580, 319.5, 239.5);
    if (status == DP_OK)
        status = dp_detector_detect(detector, &map, detection);
    if (status == DP_OK)
        print(detection);
    else
        fprintf(stderr, "error: %s\n", dp_error(detector));
    dp_detection_free(detection);
    dp_detector_free(detector);
    free(image.pixels);
    return status;
}
