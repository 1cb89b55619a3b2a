// Martin Newell's teapot ("The Utilization of Procedure Models in Digital Image Synthesis", 1975),
// public domain: 32 bicubic Bézier patches, here in the form that their symmetry allows.
//   24 patches (rim, body, bottom, knob, lid) are a profile turned about the axis in quarters.
//   8 patches (handle, spout) are ribs: each rib a loop of two mirrored Bézier halves, blended
//   along the length.
// Differs: quarters are true circles (Newell's, 0.56 r, bulge by 0.4 %); the gap between lid and
// rim is closed by a ring; handle and spout run on into the body, where their ends are closed, and
// the spout gets a short inside.
#include "demo/content/profile.h"
#include "demo/content/shapes.h"

#include <array>

namespace penumbra {

namespace {

constexpr float kMetres = 0.072f; // per unit of Newell's, 6.43 units wide: 0.46 m
constexpr int kRibSides = 20;
constexpr int kRibSteps = 12; // per patch, along the length

// Newell's points in the plane of symmetry (x, height), and how far the two between them stand out
// of it.
struct Rib {
    vec2 a = vec2(0), b = vec2(0);
    float halfWidth = 0;
};
using Ribs = std::array<Rib, 4>;

constexpr std::array kHandle{
    Ribs{{{{-1.6f, 2.025f}, {-1.5f, 2.25f}, 0.3f},
          {{-2.3f, 2.025f}, {-2.5f, 2.25f}, 0.3f},
          {{-2.7f, 2.025f}, {-3.0f, 2.25f}, 0.3f},
          {{-2.7f, 1.8f}, {-3.0f, 1.8f}, 0.3f}}},
    Ribs{{{{-2.7f, 1.8f}, {-3.0f, 1.8f}, 0.3f},
          {{-2.7f, 1.575f}, {-3.0f, 1.35f}, 0.3f},
          {{-2.5f, 1.125f}, {-2.65f, 0.9375f}, 0.3f},
          {{-2.0f, 0.9f}, {-1.9f, 0.6f}, 0.3f}}},
};
constexpr std::array kSpout{
    Ribs{{{{1.7f, 1.425f}, {1.7f, 0.6f}, 0.66f},
          {{2.6f, 1.425f}, {3.1f, 0.825f}, 0.66f},
          {{2.3f, 2.1f}, {2.4f, 2.025f}, 0.25f},
          {{2.7f, 2.4f}, {3.3f, 2.4f}, 0.25f}}},
    Ribs{{{{2.7f, 2.4f}, {3.3f, 2.4f}, 0.25f},
          {{2.8f, 2.475f}, {3.525f, 2.49375f}, 0.25f},
          {{2.9f, 2.475f}, {3.45f, 2.5125f}, 0.15f},
          {{2.8f, 2.4f}, {3.2f, 2.4f}, 0.15f}}},
};

Rib blend(const Ribs& ribs, float t)
{
    const auto at = [&](auto value) {
        return cubicBezier(value(ribs[0]), value(ribs[1]), value(ribs[2]), value(ribs[3]), t);
    };
    return {at([](const Rib& r) { return r.a; }), at([](const Rib& r) { return r.b; }),
            at([](const Rib& r) { return vec2(r.halfWidth, 0); }).x};
}

Ring ribRing(const Rib& rib)
{
    Ring ring;
    for (int i = 0; i < kRibSides; ++i) {
        const float u = 2 * static_cast<float>(i) / kRibSides; // 0..1 one half, 1..2 the way back
        const float t = u <= 1 ? u : 2 - u;
        const vec2 middle = cubicBezier(rib.a, rib.a, rib.b, rib.b, t);
        const float out = rib.halfWidth * 3 * t * (1 - t);
        ring.push_back(kMetres * vec3(middle.x, middle.y, u <= 1 ? out : -out));
    }
    return ring;
}

std::vector<Ring> sweepRibs(std::span<const Ribs> patches)
{
    std::vector<Ring> rings;
    for (const Ribs& ribs : patches) {
        for (int step = rings.empty() ? 0 : 1; step <= kRibSteps; ++step)
            rings.push_back(ribRing(blend(ribs, static_cast<float>(step) / kRibSteps)));
    }
    return rings;
}

Rib moved(Rib rib, vec2 by)
{
    return {rib.a + by, rib.b + by, rib.halfWidth};
}

Ring pole(const Rib& rib)
{
    const vec2 middle = 0.5f * kMetres * (rib.a + rib.b);
    return {vec3(middle, 0)};
}

void addBody(MeshBuilder& builder)
{
    Profile p({0, 0}, 0.088f);
    p.curveTo({1.425f, 0}, {1.5f, 0.075f}, {1.5f, 0.15f});             // bottom
    p.curveTo({1.5f, 0.225f}, {2, 0.45f}, {2, 0.9f});                  // body
    p.curveTo({2, 1.35f}, {1.75f, 1.875f}, {1.5f, 2.4f});              //
    p.curveTo({1.4375f, 2.53125f}, {1.3375f, 2.53125f}, {1.4f, 2.4f}); // rim
    p.lineTo({1.3f, 2.4f});                                            // ours
    p.curveTo({1.3f, 2.55f}, {0.4f, 2.55f}, {0.2f, 2.7f});             // lid
    p.curveTo({0, 2.85f}, {0.8f, 3.15f}, {0, 3.15f});                  // knob
    std::vector<Ring> rings = latheRings(p.points(), 56);
    for (Ring& ring : rings) {
        for (vec3& point : ring)
            point *= kMetres;
    }
    builder.addSkin(rings, false);
}

void addHandle(MeshBuilder& builder)
{
    // 0.15 units inwards: past Newell's small gap at the lower end, still inside the body's wall.
    const Rib first = moved(kHandle.front().front(), {0.15f, 0}),
              last = moved(kHandle.back().back(), {0.15f, 0});
    std::vector<Ring> rings = sweepRibs(kHandle);
    rings.insert(rings.begin(), {pole(first), ribRing(first)});
    rings.insert(rings.end(), {ribRing(last), pole(last)});
    builder.addSkin(rings, false);
}

void addSpout(MeshBuilder& builder)
{
    std::vector<Ring> rings = sweepRibs(kSpout);
    const Rib root = moved(kSpout.front().front(), {-0.1f, 0});
    rings.insert(rings.begin(), {pole(root), ribRing(root)});
    for (const float t : {0.93f, 0.85f, 0.76f}) { // back down, inside the wall
        const Rib outer = blend(kSpout.front(), t);
        constexpr float kKeep = 0.72f; // of the outer width: a wall about as thick as the lip
        const vec2 middle = 0.5f * (outer.a + outer.b);
        const Rib inner{mix(middle, outer.a, kKeep), mix(middle, outer.b, kKeep),
                        kKeep * outer.halfWidth};
        rings.push_back(ribRing(inner));
        if (t == 0.76f)
            rings.push_back(pole(inner));
    }
    builder.addSkin(rings, false);
}

} // namespace

ContentMesh makeTeapot()
{
    MeshBuilder builder;
    addBody(builder);
    addHandle(builder);
    addSpout(builder);
    return builder.finish("teapot", 50);
}

} // namespace penumbra
