#include "assetc/sheet/mesh_picture.h"

#include "shaders/shared/sh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr int kSamples = 3; // along a pixel's edge
constexpr float kFill = 0.9f;

struct View {
    vec3 eye{0}, right{0}, up{0}; // unit; `eye` points from the object to the viewer
    vec3 corner{0};               // of the picture, left and upper, before the object
    float step = 1;               // metres per pixel
};

View fitView(const MeshGeometry& mesh, int width, int height)
{
    View view;
    view.eye = normalize(vec3(0.45f, 0.55f, 1.0f));
    view.right = normalize(cross(vec3(0, 1, 0), view.eye));
    view.up = cross(view.eye, view.right);
    vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const std::uint32_t index : mesh.indices) {
        const vec3 p = mesh.positions[index];
        const vec3 seen(dot(p, view.right), dot(p, view.up), dot(p, view.eye));
        low = min(low, seen);
        high = max(high, seen);
    }
    const vec3 size = high - low, middle = 0.5f * (low + high);
    const float w = static_cast<float>(width), h = static_cast<float>(height);
    view.step = std::max({size.x / (kFill * w), size.y / (kFill * h), 1e-9f});
    view.corner = (middle.x - 0.5f * w * view.step) * view.right +
                  (middle.y + 0.5f * h * view.step) * view.up +
                  (high.z + 0.1f * (size.x + size.y + size.z) + view.step) * view.eye;
    return view;
}

// The part of a white sky's light that reaches a place with this normal: visibility against the
// cosine (Ramamoorthi and Hanrahan 2001).
float ambient(const Sh4& visibility, vec3 normal)
{
    const Sh4 cosine = shZonal(normal, vec4(1, 2.0f / 3, 0.25f, 0));
    return std::clamp(shDot(visibility, cosine), 0.0f, 1.0f);
}

vec3 shade(const MeshGeometry& mesh, const View& view, std::uint32_t triangle, vec3 weights)
{
    vec3 normal(0);
    Sh4 visibility{};
    visibility.c[0] = kSqrt4Pi;
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex =
            mesh.indices[std::size_t{3} * triangle + static_cast<std::size_t>(corner)];
        normal += weights[corner] * mesh.normals[vertex];
        for (std::size_t i = 0; i < 16; ++i)
            visibility.c[i] += weights[corner] * kSelfVisibilityScale *
                               (static_cast<float>(mesh.selfVisibility[vertex][i]) - 128.0f);
    }
    normal = dot(normal, normal) > 1e-12f ? normalize(normal) : view.eye;
    const float sky = ambient(visibility, normal) * (0.75f + 0.25f * normal.y);
    if (dot(normal, view.eye) < 0) // seen from behind
        normal = -normal;
    const float headlight =
        std::max(dot(normal, normalize(view.eye - 0.45f * view.right + 0.35f * view.up)), 0.0f);
    return vec3(0.80f, 0.77f, 0.72f) * (0.42f * sky + 0.55f * headlight * headlight);
}

} // namespace

Canvas drawMesh(const MeshGeometry& mesh, const EmbreeScene& scene, int width, int height,
                Color background)
{
    Canvas canvas(width, height, background);
    const View view = fitView(mesh, width, height);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            vec3 sum(0);
            int hits = 0;
            for (int sample = 0; sample < kSamples * kSamples; ++sample) {
                const int column = sample % kSamples, row = sample / kSamples;
                const float dx = (static_cast<float>(column) + 0.5f) / kSamples;
                const float dy = (static_cast<float>(row) + 0.5f) / kSamples;
                const vec3 origin = view.corner +
                                    (static_cast<float>(x) + dx) * view.step * view.right -
                                    (static_cast<float>(y) + dy) * view.step * view.up;
                RTCRayHit ray{};
                ray.ray.org_x = origin.x;
                ray.ray.org_y = origin.y;
                ray.ray.org_z = origin.z;
                ray.ray.dir_x = -view.eye.x;
                ray.ray.dir_y = -view.eye.y;
                ray.ray.dir_z = -view.eye.z;
                ray.ray.tfar = std::numeric_limits<float>::infinity();
                ray.ray.mask = ~0u;
                ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                rtcIntersect1(scene.handle(), &context, &ray);
                if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
                    continue;
                sum += shade(mesh, view, ray.hit.primID,
                             vec3(1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v));
                ++hits;
            }
            if (hits == 0)
                continue;
            const Color color = displayColor(sum / static_cast<float>(hits));
            Color& pixel = canvas.at(x, y);
            for (std::size_t i = 0; i < 3; ++i)
                pixel[i] = static_cast<std::uint8_t>(
                    (color[i] * hits + pixel[i] * (kSamples * kSamples - hits)) /
                    (kSamples * kSamples));
        }
    });
    return canvas;
}

} // namespace penumbra
