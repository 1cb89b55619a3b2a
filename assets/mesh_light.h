// A light that the source file places beside its mesh (KHR_lights_punctual).
#pragma once

#include "shaders/shared/interop.h"

#include <string>

namespace penumbra {

enum class LightType : std::uint8_t { Directional, Point, Spot };

struct MeshLight {
    LightType type = LightType::Point;
    std::string name;
    vec3 color{1};       // linear Rec. 709, 0 to 1
    float intensity = 1; // lux of a directional light, candela of the others
    float range = 0;     // metres, of point and spot; 0: without end
    float innerCone = 0, outerCone = 0.78539816f; // radians from the axis, of a spot
    vec3 position{0};                             // object space, metres
    vec3 direction{0, 0, -1};                     // unit, object space: where the light goes
    bool operator==(const MeshLight&) const = default;
};

PENUMBRA_CONST std::uint32_t kMaxMeshLights = 256;
PENUMBRA_CONST float kMaxLightIntensity = 1e12f;

} // namespace penumbra
