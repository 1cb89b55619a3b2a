// Shared by compute_test.cpp and round_trip.comp: a struct whose std430 layout would differ from
// C++.
#ifndef PENUMBRA_TESTS_RUNTIME_VK_ROUND_TRIP_H
#define PENUMBRA_TESTS_RUNTIME_VK_ROUND_TRIP_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

struct RoundTripItem {
    vec3 position; // scalar layout: 12 bytes, `weight` follows at once
    float weight;
    mat3 frame; // 36 bytes
    uint texel; // index into the texel buffer
};

PENUMBRA_END
#endif
