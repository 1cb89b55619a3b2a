#include "demo/content/profile.h"
#include "demo/content/shapes.h"

namespace penumbra {

namespace {

// All metres. The wall is thick enough to hide the handle's ends: see addHandle.
constexpr float kRadius = 0.11f, kHeight = 0.26f, kWall = 0.012f;

void addCup(MeshBuilder& builder)
{
    Profile p({0, 0.007f}, 0.0115f);
    p.lineTo({0.078f, 0.007f}).lineTo({0.081f, 0}).lineTo({0.09f, 0}); // foot ring
    p.curveTo({0.106f, 0}, {kRadius, 0.012f}, {kRadius, 0.032f});      // outside
    p.lineTo({kRadius, kHeight - kWall / 2});                          //
    p.arcTo({kRadius - kWall / 2, kHeight - kWall / 2}, {kRadius - kWall / 2, kHeight}); // lip
    p.arcTo({kRadius - kWall / 2, kHeight - kWall / 2}, {kRadius - kWall, kHeight - kWall / 2});
    p.lineTo({kRadius - kWall, 0.045f}); // inside
    p.curveTo({kRadius - kWall, 0.025f}, {0.09f, 0.019f}, {0.075f, 0.019f}).lineTo({0, 0.019f});
    builder.addSkin(latheRings(p.points(), 56), false);
}

// An ear: oval rings along a Bézier curve in the plane z = 0, flared where it grows out of the
// wall. Both ends stop in the middle of the wall: at x = 0.104 and z = 0.018 (the flare) they are
// 0.1056 from the axis, between 0.098 and 0.110.
void addHandle(MeshBuilder& builder)
{
    constexpr int kSteps = 44, kSides = 18;
    constexpr float kStartX = kRadius - kWall / 2;
    constexpr vec2 kCurve[4] = {
        {kStartX, 0.205f}, {0.232f, 0.225f}, {0.218f, 0.045f}, {kStartX, 0.06f}};
    std::vector<Ring> rings;
    for (int i = 0; i <= kSteps; ++i) {
        const float t = static_cast<float>(i) / kSteps;
        const vec2 centre = cubicBezier(kCurve[0], kCurve[1], kCurve[2], kCurve[3], t);
        const vec2 tangent =
            normalize(cubicBezier(kCurve[1] - kCurve[0], kCurve[2] - kCurve[1],
                                  kCurve[2] - kCurve[1], kCurve[3] - kCurve[2], t));
        const float fromEnd = 1 - abs(2 * t - 1); // 0 at the ends, 1 in the middle
        const float flare = 1 + 0.4f * pow(max(0.0f, 1 - fromEnd / 0.35f), 2.0f);
        const bool atEnd = i == 0 || i == kSteps;
        // The last rings stand upright so that they stay inside the curved wall.
        const vec2 across = atEnd ? vec2(0, tangent.x < 0 ? -1 : 1) : vec2(-tangent.y, tangent.x);
        rings.push_back(ellipseRing(vec3(centre, 0), 0.0105f * flare * vec3(across, 0),
                                    vec3(0, 0, 0.0129f * flare), kSides));
    }
    rings.insert(rings.begin(), {vec3(kCurve[0], 0)});
    rings.push_back({vec3(kCurve[3], 0)});
    builder.addSkin(rings, false);
}

} // namespace

ContentMesh makeMug()
{
    MeshBuilder builder;
    addCup(builder);
    addHandle(builder);
    return builder.finish("mug", 50);
}

} // namespace penumbra
