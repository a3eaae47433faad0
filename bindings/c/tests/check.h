/* What the tests in C and in C++ share. */
#ifndef CHECK_H
#define CHECK_H

#include <depthplanes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ends the program with the line if something does not hold. */
#define CHECK(holds)                                                                                                             \
    do {                                                                                                                         \
        if (!(holds)) {                                                                                                          \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #holds);                                                          \
            exit(1);                                                                                                             \
        }                                                                                                                        \
    } while (0)

/* That a call failed so, with a text that holds some words. */
#define REFUSED(detector, call, expected, words)                                                                                 \
    do {                                                                                                                         \
        CHECK((call) == (expected));                                                                                             \
        if (!strstr(dp_error(detector), (words))) {                                                                              \
            fprintf(stderr, "%s:%d: \"%s\" is not in: %s\n", __FILE__, __LINE__, (words), dp_error(detector));                   \
            exit(1);                                                                                                             \
        }                                                                                                                        \
    } while (0)

/* States a flag of the program, NAME=VALUE. */
static inline dp_status state_flag(dp_detector *detector, const char *flag)
{
    const char *value = strchr(flag, '=');
    char name[32] = "";
    double number[4];
    if (!value || value - flag >= (long)sizeof name)
        return DP_INVALID_ARGUMENT;
    memcpy(name, flag, (size_t)(value - flag));
    value++;
    if (!strcmp(name, "preset"))
        return dp_detector_set_sensor(detector, value);
    if (!strcmp(name, "encoding"))
        return dp_detector_set_unit(detector, value);
    if (!strcmp(name, "camera"))
        return dp_detector_set_camera_file(detector, value);
    if (!strcmp(name, "intrinsics") && sscanf(value, "%lf,%lf,%lf,%lf", number, number + 1, number + 2, number + 3) == 4)
        return dp_detector_set_camera(detector, number[0], number[1], number[2], number[3]);
    return dp_detector_set_text(detector, name, value);
}

/* The type of pixels of that name in numpy's words. */
static inline dp_pixel_type pixel_type(const char *name)
{
    CHECK(!strcmp(name, "uint8") || !strcmp(name, "uint16") || !strcmp(name, "float32") || !strcmp(name, "float64"));
    return !strcmp(name, "uint8") ? DP_UINT8 : !strcmp(name, "uint16") ? DP_UINT16 : !strcmp(name, "float32") ? DP_FLOAT32 : DP_FLOAT64;
}

#endif
