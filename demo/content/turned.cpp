// Solids of revolution.
#include "demo/content/profile.h"
#include "demo/content/shapes.h"

#include <array>

namespace penumbra {

ContentMesh makeChessPawn()
{
    Profile p({0, 0}, 0.0085f);
    p.lineTo({0.1f, 0}).arcTo({0.1f, 0.008f}, {0.108f, 0.008f});
    p.lineTo({0.108f, 0.024f}).curveTo({0.108f, 0.04f}, {0.094f, 0.044f}, {0.09f, 0.05f}); // foot
    p.arcTo({0.086f, 0.061f}, {0.088f, 0.0728f});                                          // bead
    p.curveTo({0.06f, 0.088f}, {0.038f, 0.14f}, {0.034f, 0.226f});                         // stem
    p.lineTo({0.042f, 0.229f})
        .curveTo({0.068f, 0.235f}, {0.068f, 0.247f}, {0.042f, 0.254f}); // collar
    p.lineTo({0.0345f, 0.257f});
    constexpr vec2 kHead(0,
                         0.309f); // its sphere passes through the last point above: radius 0.0624
    const float radius = length(vec2(0.0345f, 0.257f) - kHead);
    p.arcTo(kHead, {0, kHead.y + radius});
    MeshBuilder builder;
    builder.addSkin(latheRings(p.points(), 48), false);
    return builder.finish("chess_pawn", 40);
}

ContentMesh makeBall()
{
    constexpr float kRadius = 0.18f;
    Profile p({0, -kRadius}, 0.0118f);
    p.arcTo({0, 0}, {kRadius, 0}).arcTo({0, 0}, {0, kRadius});
    MeshBuilder builder;
    builder.addSkin(latheRings(p.points(), 60), false);
    return builder.finish("ball", 40);
}

ContentMesh makeBowlingPin()
{
    // Diameter at height, inches: as the USBC specifies a ten-pin.
    constexpr std::array<vec2, 13> kPin{
        vec2(2.828f, 0.75f),  vec2(3.906f, 2.25f),   vec2(4.510f, 3.375f), vec2(4.766f, 4.5f),
        vec2(4.563f, 5.875f), vec2(3.703f, 7.25f),   vec2(2.472f, 8.625f), vec2(1.965f, 9.375f),
        vec2(1.797f, 10.0f),  vec2(1.870f, 10.875f), vec2(2.094f, 11.75f), vec2(2.406f, 12.625f),
        vec2(2.547f, 13.5f)};
    constexpr float kInch = 0.0254f;
    std::array<vec2, kPin.size()> knots;
    for (std::size_t i = 0; i < kPin.size(); ++i)
        knots[i] = kInch * vec2(kPin[i].x / 2, kPin[i].y);

    Profile p({0, 0}, 0.0055f);
    p.lineTo({1.0155f * kInch, 0}).splineTo(knots);
    const vec2 top(0, 15 * kInch); // the head is round: radius 1.273 inch
    p.curveTo(knots.back() + kInch * vec2(0.03f, 0.5f), top + kInch * vec2(0.76f, 0), top);
    MeshBuilder builder;
    builder.addSkin(latheRings(p.points(), 44), false);
    return builder.finish("bowling_pin", 40);
}

} // namespace penumbra
