// Machine parts that lie flat: a loop of stations (bore, top, outline, bottom) carried around the y
// axis.
#include "demo/content/mesh_builder.h"
#include "demo/content/shapes.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

// Adds the closed loop whose upper half is `upper`, from the bore at y = 0 to the outline at y = 0.
void closeLoop(std::vector<Ring>& rings, std::span<const Ring> upper)
{
    rings.assign(upper.begin(), upper.end());
    for (std::size_t i = upper.size() - 2; i > 0; --i) {
        Ring mirrored = upper[i];
        for (vec3& point : mirrored)
            point.y = -point.y;
        rings.push_back(std::move(mirrored));
    }
}

Ring circle(float radius, float y, std::span<const float> angles)
{
    Ring ring;
    for (const float angle : angles)
        ring.push_back(vec3(radius * cos(angle), y, radius * sin(angle)));
    return ring;
}

// `outline` moved inwards by `inset`, at height y.
Ring insetRing(std::span<const vec2> outline, float inset, float y)
{
    Ring ring;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const vec2 before = outline[(i + outline.size() - 1) % outline.size()];
        const vec2 after = outline[(i + 1) % outline.size()];
        const vec2 along =
            normalize(normalize(after - outline[i]) + normalize(outline[i] - before));
        const vec2 moved = outline[i] - inset * vec2(along.y, -along.x);
        ring.push_back(vec3(moved.x, y, moved.y));
    }
    return ring;
}

} // namespace

ContentMesh makeGear()
{
    constexpr int kTeeth = 12;
    constexpr float kRoot = 0.168f, kTip = 0.21f; // radii, metres
    // Half a tooth's width in pitches falls as 0.29 - 0.17 u² from root (u = 0) to tip (1): a
    // bulging flank, much like an involute.
    struct Sample {
        float pitch, height; // -0.5..0.5 across the tooth; 0 root, 1 tip
    };
    constexpr Sample kTooth[] = {{-0.5f, 0},       {-0.4f, 0},       {-0.29f, 0}, {-0.2683f, 0.36f},
                                 {-0.2067f, 0.7f}, {-0.12f, 1},      {0, 1},      {0.12f, 1},
                                 {0.2067f, 0.7f},  {0.2683f, 0.36f}, {0.29f, 0},  {0.4f, 0}};
    std::vector<vec2> outline;
    std::vector<float> angles;
    for (int tooth = 0; tooth < kTeeth; ++tooth) {
        for (const Sample& sample : kTooth) {
            const float angle =
                glm::two_pi<float>() * (static_cast<float>(tooth) + sample.pitch) / kTeeth;
            angles.push_back(angle);
            outline.push_back(mix(kRoot, kTip, sample.height) * vec2(cos(angle), sin(angle)));
        }
    }
    constexpr float kHub = 0.05f, kWeb = 0.02f, kRim = 0.04f,
                    kChamfer = 0.006f; // half heights and bevel, metres
    const std::vector<Ring> upper{
        circle(0.046f, 0, angles),
        circle(0.046f, kHub - kChamfer, angles), // bore
        circle(0.052f, kHub, angles),            // hub
        circle(0.075f, kHub, angles),
        circle(0.081f, kWeb, angles), // web
        circle(0.106f, kWeb, angles),
        circle(0.131f, kWeb, angles),
        circle(0.137f, kRim, angles), // rim
        circle(0.151f, kRim, angles),
        insetRing(outline, kChamfer, kRim),
        insetRing(outline, 0, kRim - kChamfer),
        insetRing(outline, 0, 0),
    };
    std::vector<Ring> rings;
    closeLoop(rings, upper);
    MeshBuilder builder;
    builder.addSkin(rings, true);
    return builder.finish("gear", 35);
}

// A hexagon whose corners a 30-degree cone cuts off above and below, with a thread of true helical
// shape: the bore's radius is a cosine of (height in pitches - turns).
ContentMesh makeHexNut()
{
    constexpr float kApothem = 0.13f, kBore = 0.076f, kHalfHeight = 0.06f; // metres
    constexpr float kCone = 0.577f;                                        // tan 30 degrees
    constexpr float kFlat = 0.125f; // radius where the cone begins
    constexpr int kSides = 6, kPerSide = 14, kThreads = 5, kRowsPerThread = 6;
    std::vector<float> angles, outline;
    for (int i = 0; i < kSides * kPerSide; ++i) {
        const float inSide = static_cast<float>(i % kPerSide) / kPerSide - 0.5f; // -0.5 is a corner
        const float local = inSide * glm::two_pi<float>() / kSides;
        const auto sideIndex = i / kPerSide;
        angles.push_back(local + glm::two_pi<float>() * static_cast<float>(sideIndex) / kSides);
        outline.push_back(kApothem / cos(local));
    }
    const auto ring = [&](auto radiusAndHeight) {
        Ring points;
        for (std::size_t i = 0; i < angles.size(); ++i) {
            const vec2 p = radiusAndHeight(i);
            points.push_back(vec3(p.x * cos(angles[i]), p.y, p.x * sin(angles[i])));
        }
        return points;
    };
    const auto cone = [&](float radius) { return kHalfHeight - kCone * max(0.0f, radius - kFlat); };

    std::vector<Ring> rings;
    constexpr int kRows = kThreads * kRowsPerThread;
    for (int row = 0; row <= kRows; ++row) { // bore, bottom to top
        const float s = 2 * static_cast<float>(row) / kRows - 1;
        const float depth = 0.005f * min(1.0f, 4 * (1 - abs(s))); // runs out at both ends
        rings.push_back(ring([&](std::size_t i) {
            const float phase = glm::pi<float>() * kThreads * s - angles[i];
            return vec2(kBore - depth * cos(phase), (kHalfHeight - 0.008f) * s);
        }));
    }
    const auto circleAt = [&](float radius, float y) {
        return ring([=](std::size_t) { return vec2(radius, y); });
    };
    const auto coneAt = [&](float part, float sign) {
        return ring([&, part, sign](std::size_t i) {
            const float radius = mix(kFlat, outline[i], part);
            return vec2(radius, sign * cone(radius));
        });
    };
    rings.push_back(circleAt(kBore + 0.01f, kHalfHeight)); // countersink, top, cone
    rings.push_back(circleAt(0.105f, kHalfHeight));
    rings.push_back(coneAt(0, 1));
    rings.push_back(coneAt(0.5f, 1));
    constexpr int kSideRows = 6;
    for (int row = 0; row <= kSideRows; ++row) {
        const float s = 1 - 2 * static_cast<float>(row) / kSideRows;
        rings.push_back(
            ring([&](std::size_t i) { return vec2(outline[i], s * cone(outline[i])); }));
    }
    rings.push_back(coneAt(0.5f, -1));
    rings.push_back(coneAt(0, -1));
    rings.push_back(circleAt(0.105f, -kHalfHeight));
    rings.push_back(circleAt(kBore + 0.01f, -kHalfHeight));
    MeshBuilder builder;
    builder.addSkin(rings, true);
    return builder.finish("hex_nut", 25);
}

} // namespace penumbra
