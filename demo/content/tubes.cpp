// Tubes around curves.
#include "demo/content/mesh_builder.h"
#include "demo/content/shapes.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

// The (2,3) torus knot p(t) = ((R + r cos 3t) cos 2t, r sin 3t, (R + r cos 3t) sin 2t). The tube's
// frame leans on the normal of the torus that carries the knot, so it closes without a twist.
ContentMesh makeTorusKnot()
{
    constexpr float kMajor = 0.115f, kMinor = 0.062f,
                    kTube = 0.039f; // strands are 2 kMinor apart: a clear gap
    constexpr int kSteps = 240, kSides = 20;
    std::vector<Ring> rings;
    for (int i = 0; i < kSteps; ++i) {
        const float t = glm::two_pi<float>() * static_cast<float>(i) / kSteps;
        const float c3 = cos(3 * t), s3 = sin(3 * t), c2 = cos(2 * t), s2 = sin(2 * t);
        const vec3 out(c3 * c2, s3, c3 * s2); // torus normal
        const vec3 centre = kMajor * vec3(c2, 0, s2) + kMinor * out;
        const float ring = kMajor + kMinor * c3;
        const vec3 tangent = normalize(vec3(-3 * kMinor * s3 * c2 - 2 * ring * s2, 3 * kMinor * c3,
                                            -3 * kMinor * s3 * s2 + 2 * ring * c2));
        const vec3 axisX = normalize(out - dot(out, tangent) * tangent);
        rings.push_back(ellipseRing(centre, kTube * axisX, kTube * cross(tangent, axisX), kSides));
    }
    MeshBuilder builder;
    builder.addSkin(rings, true);
    return builder.finish("torus_knot", 40);
}

// A compression spring: the pitch falls to one wire per turn at both ends, as in a spring with
// closed ends.
ContentMesh makeSpring()
{
    constexpr float kRadius = 0.1f, kWire = 0.017f, kTurns = 5, kRise = 0.29f;
    constexpr int kStepsPerTurn = 44, kSides = 16, kCapSteps = 4;
    constexpr int kSteps = static_cast<int>(kTurns) * kStepsPerTurn;
    // Height by turn: slope a little over one wire's thickness near the ends, steep between.
    const auto height = [](float s) { // s in 0..1
        constexpr float kEndSlope = kTurns * 2.04f * kWire / kRise;
        const float eased = s * s * (3 - 2 * s); // slope 0 at both ends
        return kRise * mix(eased, s, kEndSlope);
    };
    std::vector<Ring> rings;
    vec3 centre, tangent, axisX, axisY;
    const auto frame = [&](float s) {
        const float angle = glm::two_pi<float>() * kTurns * s;
        const vec3 out(cos(angle), 0, sin(angle));
        const float slope = (height(s + 1e-3f) - height(s - 1e-3f)) / 2e-3f;
        centre = kRadius * out + vec3(0, height(s), 0);
        tangent = normalize(glm::two_pi<float>() * kTurns * kRadius * vec3(-out.z, 0, out.x) +
                            vec3(0, slope, 0));
        axisX = kWire * out;
        axisY = kWire * cross(tangent, out);
    };
    const auto addCap =
        [&](float direction) { // a round end; -1: from its pole to the wire, +1: back
            for (int i = 0; i < kCapSteps; ++i) {
                const int step = direction < 0 ? i : kCapSteps - i;
                const int from = direction < 0 ? step : step - 1; // 0 is the pole
                const float a = glm::half_pi<float>() * static_cast<float>(from) / kCapSteps;
                const vec3 middle = centre + direction * kWire * cos(a) * tangent;
                rings.push_back(from == 0
                                    ? Ring{middle}
                                    : ellipseRing(middle, sin(a) * axisX, sin(a) * axisY, kSides));
            }
        };
    frame(0);
    addCap(-1);
    for (int i = 0; i <= kSteps; ++i) {
        frame(static_cast<float>(i) / kSteps);
        rings.push_back(ellipseRing(centre, axisX, axisY, kSides));
    }
    addCap(1);
    MeshBuilder builder;
    builder.addSkin(rings, false);
    return builder.finish("spring", 40);
}

} // namespace penumbra
