// What `assetc light` reads: docs/light_spec.md.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/json_input.h"
#include "shaders/shared/interop.h"

#include <filesystem>
#include <string>

namespace penumbra {

enum class EmitterShape { Sphere, Rectangle, Disc, Spot, Mesh };
enum class EmissionUnit { Radiance, Power, Intensity };

struct LightSpec {
    EmitterShape shape = EmitterShape::Sphere;
    EmissionUnit unit = EmissionUnit::Radiance;
    vec3 emission{0};                    // RGB: W/(m² sr), W, or W/sr
    float radius = 0;                    // sphere, disc, spot: metres
    vec2 size{0};                        // rectangle: metres along x and y
    float innerAngle = 0;                // spot: degrees from +z
    float outerAngle = 0;                // spot: degrees, above innerAngle
    bool twoSided = false;               // rectangle, disc, mesh
    float reach = 0;                     // metres to the last shell; 0: kLightOuterRadius
    std::filesystem::path texture, mesh; // existing files in the spec's folder, or empty
};

PENUMBRA_CONST float kMaxRadiance = 1e7f; // W/(m² sr); the field's band scales end at 1e6
PENUMBRA_CONST float kMinEmitterSize = 1e-4f, kMaxEmitterSize = 1e4f; // metres
// Degrees. From 90 on a spot would light its own plane; below 1 it is narrower than a cell of any
// grid.
PENUMBRA_CONST float kMinOuterAngle = 1, kMaxOuterAngle = 89, kMinFalloffAngle = 0.1f;

const char* shapeName(EmitterShape shape); // as in the description
const char* unitName(EmissionUnit unit);   // "W/(m² sr)"

// None: `problems` gets all of the file with their places; unknown members are problems too.
// `asked`, if any, gets the files that the spec names.
std::optional<LightSpec> readLightSpec(const std::filesystem::path& path, JsonProblems& problems,
                                       std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
