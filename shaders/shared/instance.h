// What a frame knows of an instance, a light, a field, a cluster and itself: the structs that CPU
// and GPU share, and the maths that turns a transform into the constants of the combine kernels.
// Layout: scalar; offsets checked in tests/systems.
#ifndef PENUMBRA_SHADERS_SHARED_INSTANCE_H
#define PENUMBRA_SHADERS_SHARED_INSTANCE_H
#include "shaders/shared/beam.h"
#include "shaders/shared/field.h"
PENUMBRA_BEGIN

PENUMBRA_CONST uint kNoField = 0xffffffffu;
PENUMBRA_CONST uint kNoOwner = 0xffffffffu;
PENUMBRA_CONST uint kClusterReceivers =
    64u; // receivers per cluster; a mesh's last cluster is padded to it
PENUMBRA_CONST uint kMaxClusterOccluders =
    32u; // per cluster; the least important ones beyond that are dropped and counted
PENUMBRA_CONST uint kMaxClusterLights = 16u; // local lights per cluster; likewise
// What pass entity_sort writes per visible cluster: counts of occluders and lights; entries of the
// occluders, near to far, and after them those that were dropped as hidden, which still hide
// others; of each occluder, which ones may hide it, as bits of their places; of each light, near to
// far, its entry, how many leading occluders stand before it at every receiver, which of the others
// may, and which may hide it. Hiders are there in scenes that have some.
PENUMBRA_CONST uint kListOccluders = 2u;
PENUMBRA_CONST uint kListHiders = kListOccluders + kMaxClusterOccluders;
PENUMBRA_CONST uint kListLights = kListHiders + kMaxClusterOccluders;
PENUMBRA_CONST uint kListLightStride = 4u;
PENUMBRA_CONST uint kListStride = kListLights + kListLightStride * kMaxClusterLights;
PENUMBRA_CONST uint kSortGroup = 16u;         // clusters per workgroup of entity_sort: one per lane
PENUMBRA_CONST uint kGpuInstanceTexels = 12u; // vec4 rows of a GpuInstance

// Written by the CPU when the entity changed: an instance, or a local light, which has a radiance
// field and no mesh of its own.
struct InstanceInput {
    vec3 position;       // of the object's origin, world, metres
    float scale;         // uniform
    vec4 rotation;       // quaternion x, y, z, w: world from object
    vec3 albedo;         // linear Rec. 709; of a light, the factor of its field
    float glossFraction; // part of the reflectance in the Phong lobe
    float glossExponent;
    uint field; // index of a FieldInput, kNoField: not an occluder
    uint owner; // of a light: the instance that is its surface, kNoOwner: none
    uint firstDraw;
    vec3 emission;  // radiance of the surface itself, W/(m² sr)
    uint drawCount; // draw commands from firstDraw on; of a light 0
    uint hides;     // 1: the field's inscribed ball hides others
};

// One per field asset.
struct FieldInput {
    vec3 center;      // object space, metres
    float radius;     // metres
    vec4 bandScale;   // K of band 0..3
    vec4 inscribed;   // of an occluder: a ball in it, object space, metres; radius 0: none
    uint firstSample; // in the samples of all fields
    uint side;
    uint shells;
    float innerRadius; // bounding radii
    float outerRadius; // bounding radii
    uint padding0;
    uint padding1;
    uint padding2;
};

// Written by pass instance_update, read as rows of a texel buffer by the combine kernels and as
// per-instance vertex attributes by pass raster. What a kernel needs of an occluder is in the first
// five rows, of one that hides others in the last too: on lavapipe a row takes about 60
// instructions to read (docs/decisions/0005), so angles are kept instead of matrices.
struct GpuInstance {
    vec4 sphere;    // of the field: centre and bounding radius, world, metres
    vec4 alphaBeta; // world from object = Rz(alpha) Ry(beta) Rz(gamma): cos, sin of alpha, of beta
    vec4 gammaShells; // cos gamma, sin gamma, shellScale, shellBias
    vec4 grid; // firstSample, side, shell count: whole numbers; influence radius (world, metres; 0:
               // no field)
    vec4 bandScale;
    vec4 worldFromObject0;
    vec4 worldFromObject1;
    vec4 worldFromObject2;
    vec4 material;  // albedo, glossFraction
    vec4 material1; // glossExponent, scale, of a light: owner + 1 (0: none), firstDraw
    vec4 emission;  // radiance, drawCount
    vec4 inscribed; // a ball in the occluder: centre and radius, world, metres; radius 0: hides
                    // nothing
};

// Bounds of a cluster of a mesh asset, object space. Meaning: assets/mesh_asset.h.
struct ClusterBounds {
    vec4 sphere;   // centre, radius
    vec4 faces;    // cone of the face normals: axis, cutoff
    vec4 vertices; // cone of the vertex normals: axis, cutoff
};

// A cluster of an instance.
struct SceneCluster {
    uint instance;
    uint bounds;        // index of ClusterBounds
    uint firstReceiver; // in the receivers of all meshes
    uint firstRadiance; // in the radiance buffer
};

// Tests that drop what cannot matter: each may be turned off, and the picture stays.
PENUMBRA_CONST uint kCullFrustum = 1u;   // clusters outside the view
PENUMBRA_CONST uint kCullBackfaces = 2u; // clusters that look away from the eye
PENUMBRA_CONST uint kCullHorizon = 4u;   // entities under the horizon of a whole cluster
PENUMBRA_CONST uint kCullHidden = 8u;    // entities that inscribed spheres of nearer ones hide
PENUMBRA_CONST uint kCullAll = 15u;

PENUMBRA_CONST uint kLightCoefficients = 36u; // order 6
PENUMBRA_CONST uint kSkyNodes = 32u;          // of kShNodes
PENUMBRA_CONST uint kSkyMaps = 2u;            // environment maps drawn at once, for a cross-fade

// Header that passes cluster_cull and entity_sort fill for the passes after them.
struct CullResult {
    uint sortGroups[3]; // VkDispatchIndirectCommand of entity_sort
    uint
        combineGroups[3]; // VkDispatchIndirectCommand of combine: one workgroup per visible cluster
    uint pairs;           // cluster-occluder pairs that are combined
    uint dropped;         // pairs beyond kMaxClusterOccluders or kMaxClusterLights
};

// Constants of one frame.
struct FrameConstants {
    mat4 clipFromWorld;
    mat4 worldFromClip;
    vec4 eye;                       // world; w unused
    vec4 frustum[6];                // planes, normals inwards, world
    vec4 light[kLightCoefficients]; // environment radiance in SH of order 6
    vec4 skyRotation[kSkyMaps];     // quaternion x, y, z, w: map from world
    uint clusterCount;
    uint instanceCount; // the rows of lights follow those of instances
    uint lightCount;
    uint literal;              // 1: pass instance_update writes denseRotations, for kernel literal;
                               // 0: skyNodes, for kernel exact
    float backgroundIntensity; // factor of both maps
    uint culls;                // kCull… bits
    float skyIntensity[kSkyMaps];
    GpuBeam beams[kMaxBeams];
    uint beamCount;
    uint mirrors; // 1: the combine kernel has sharp surfaces mirror the filtered sky, which holds
                  // the beams
    uint padding0;
    uint padding1;
};

// A 16 x 16 block-diagonal rotation of SH vectors without its first entry, which is 1: rows of band
// 1, 2, 3, 83 numbers packed in order. Vectors of 4, because a storage buffer read costs the same
// for 1 number as for 4.
struct DenseRotation {
    vec4 m[21];
};

// What a combine kernel needs of an occluder.
struct FieldEntity {
    vec3 center;         // world, metres
    mat3 radiiFromWorld; // rotation and scale to the field's axes and bounding radii
    ShRotation rotation;
    FieldGrid grid;
    vec4 bandScale;
};

// An entry of a cluster's lists: the row of an instance or light, below 2^24, and its share in
// 1/255: less than 1 where the list is full and the entity is hardly more important than one left
// out.
PENUMBRA_FN uint listEntry(uint row, float share)
{
    return row | (uint(share * 255.0f + 0.5f) << 24u);
}

PENUMBRA_FN uint entryRow(uint entry)
{
    return entry & 0xffffffu;
}

PENUMBRA_FN float entryShare(uint entry)
{
    return float(entry >> 24u) * (1.0f / 255.0f);
}

// Of a light: how bright its field is, about, compared with that of others.
PENUMBRA_FN float lightStrength(GpuInstance g)
{
    return g.bandScale.x * (g.material.x + g.material.y + g.material.z);
}

PENUMBRA_FN vec3 rotate(vec4 q, vec3 v)
{
    const vec3 u = vec3(q.x, q.y, q.z);
    return v + 2.0f * cross(u, cross(u, v) + q.w * v);
}

PENUMBRA_FN mat3 rotationMatrix(vec4 q)
{
    return mat3(rotate(q, vec3(1.0f, 0.0f, 0.0f)), rotate(q, vec3(0.0f, 1.0f, 0.0f)),
                rotate(q, vec3(0.0f, 0.0f, 1.0f)));
}

PENUMBRA_FN GpuInstance makeInstance(InstanceInput i, FieldInput f)
{
    const mat3 r = rotationMatrix(i.rotation); // columns: object axes in world
    const vec3 center = i.position + i.scale * (r * f.center);
    const float octaves = log2(f.outerRadius / f.innerRadius);
    const float shellScale = float(f.shells - 1u) / octaves;
    const ShRotation s = shRotation(r);

    GpuInstance g;
    g.sphere = vec4(center, i.scale * f.radius);
    g.alphaBeta = vec4(s.alpha.c.x, s.alpha.s.x, s.beta.c.x, s.beta.s.x);
    g.gammaShells = vec4(s.gamma.c.x, s.gamma.s.x, shellScale, -shellScale * log2(f.innerRadius));
    g.grid = vec4(float(f.firstSample), float(f.side), float(f.shells),
                  i.field == kNoField ? 0.0f : i.scale * f.radius * f.outerRadius);
    g.bandScale = f.bandScale;
    g.worldFromObject0 =
        vec4(i.scale * r[0][0], i.scale * r[1][0], i.scale * r[2][0], i.position.x);
    g.worldFromObject1 =
        vec4(i.scale * r[0][1], i.scale * r[1][1], i.scale * r[2][1], i.position.y);
    g.worldFromObject2 =
        vec4(i.scale * r[0][2], i.scale * r[1][2], i.scale * r[2][2], i.position.z);
    g.material = vec4(i.albedo, i.glossFraction);
    g.material1 = vec4(i.glossExponent, i.scale, i.owner == kNoOwner ? 0.0f : float(i.owner + 1u),
                       float(i.firstDraw));
    g.emission = vec4(i.emission, float(i.drawCount));
    g.inscribed = vec4(i.position + i.scale * (r * vec3(f.inscribed)),
                       i.hides != 0u ? i.scale * f.inscribed.w : 0.0f);
    return g;
}

PENUMBRA_FN ShRotation instanceRotation(GpuInstance g)
{
    ShRotation r;
    r.gamma = shTurn(g.gammaShells.x, g.gammaShells.y);
    r.beta = shTurn(g.alphaBeta.z, g.alphaBeta.w);
    r.alpha = shTurn(g.alphaBeta.x, g.alphaBeta.y);
    return r;
}

PENUMBRA_FN FieldEntity instanceField(GpuInstance g)
{
    const float cosAlpha = g.alphaBeta.x, sinAlpha = g.alphaBeta.y;
    const float cosBeta = g.alphaBeta.z, sinBeta = g.alphaBeta.w;
    const float toRadii = 1.0f / g.sphere.w;
    const float cosGamma = g.gammaShells.x * toRadii, sinGamma = g.gammaShells.y * toRadii;
    FieldEntity e;
    e.center = vec3(g.sphere.x, g.sphere.y, g.sphere.z);
    // Column by column: the field's coordinates of the world's axes.
    e.radiiFromWorld = mat3(
        vec3(cosAlpha * cosBeta * cosGamma - sinAlpha * sinGamma,
             -cosAlpha * cosBeta * sinGamma - sinAlpha * cosGamma, cosAlpha * sinBeta * toRadii),
        vec3(sinAlpha * cosBeta * cosGamma + cosAlpha * sinGamma,
             cosAlpha * cosGamma - sinAlpha * cosBeta * sinGamma, sinAlpha * sinBeta * toRadii),
        vec3(-sinBeta * cosGamma, sinBeta * sinGamma, cosBeta * toRadii));
    e.rotation = instanceRotation(g);
    e.grid.firstSample = uint(int(g.grid.x));
    e.grid.side = uint(int(g.grid.y));
    e.grid.shells = uint(int(g.grid.z));
    e.grid.shellScale = g.gammaShells.z;
    e.grid.shellBias = g.gammaShells.w;
    e.grid.lastShell = g.grid.z - 1.0f;
    e.bandScale = g.bandScale;
    return e;
}

// Rotation and no scale: the axes of an instance from those of the world.
PENUMBRA_FN mat3 objectFromWorld(GpuInstance g)
{
    return mat3(vec3(g.worldFromObject0), vec3(g.worldFromObject1), vec3(g.worldFromObject2)) *
           (1.0f / g.material1.y);
}

// instanceField with the field's SH turned into another frame than the world's.
PENUMBRA_FN FieldEntity instanceFieldIn(mat3 frameFromWorld, GpuInstance g)
{
    FieldEntity e = instanceField(g);
    e.rotation = shRotation(frameFromWorld * (g.sphere.w * transpose(e.radiiFromWorld)));
    return e;
}

// A point of the world relative to the field's centre, field axes, unit: bounding radii.
PENUMBRA_FN vec3 fieldPoint(FieldEntity e, vec3 world)
{
    return e.radiiFromWorld * (world - e.center);
}

PENUMBRA_FN vec3 affine(vec4 row0, vec4 row1, vec4 row2, vec3 p)
{
    const vec4 h = vec4(p, 1.0f);
    return vec3(dot(row0, h), dot(row1, h), dot(row2, h));
}

PENUMBRA_FN vec3 linear(vec4 row0, vec4 row1, vec4 row2, vec3 v)
{
    const vec4 h = vec4(v, 0.0f);
    return vec3(dot(row0, h), dot(row1, h), dot(row2, h));
}

// The matrix of a rotation, column by column: the image of each basis function.
PENUMBRA_FN DenseRotation denseRotation(ShRotation r)
{
    DenseRotation d;
    d.m[20].w = 0.0f;
    for (int j = 1; j < 16; ++j) {
        Sh4 unit;
        for (int i = 0; i < 16; ++i)
            unit.c[i] = i == j ? 1.0f : 0.0f;
        const Sh4 image = shRotate(unit, r);
        const int band = j < 4 ? 1 : (j < 9 ? 2 : 3);
        const int first = band * band, width = 2 * band + 1;
        const int base = band == 1 ? 0 : (band == 2 ? 9 : 34);
        for (int i = 0; i < width; ++i)
            d.m[(base + i * width + (j - first)) / 4][(base + i * width + (j - first)) % 4] =
                image.c[first + i];
    }
    return d;
}

PENUMBRA_FN Sh4 shRotateDense(Sh4 f, DenseRotation d)
{
    Sh4 g;
    g.c[0] = f.c[0];
    for (int i = 0; i < 3; ++i) {
        float sum = 0.0f;
        for (int j = 0; j < 3; ++j)
            sum += d.m[(3 * i + j) / 4][(3 * i + j) % 4] * f.c[1 + j];
        g.c[1 + i] = sum;
    }
    for (int i = 0; i < 5; ++i) {
        float sum = 0.0f;
        for (int j = 0; j < 5; ++j)
            sum += d.m[(9 + 5 * i + j) / 4][(9 + 5 * i + j) % 4] * f.c[4 + j];
        g.c[4 + i] = sum;
    }
    for (int i = 0; i < 7; ++i) {
        float sum = 0.0f;
        for (int j = 0; j < 7; ++j)
            sum += d.m[(34 + 7 * i + j) / 4][(34 + 7 * i + j) % 4] * f.c[9 + j];
        g.c[9 + i] = sum;
    }
    return g;
}

PENUMBRA_END

#ifdef __cplusplus
static_assert(sizeof(penumbra::InstanceInput) == 84 &&
              offsetof(penumbra::InstanceInput, emission) == 64);
static_assert(sizeof(penumbra::FieldInput) == 80 &&
              offsetof(penumbra::FieldInput, firstSample) == 48);
static_assert(sizeof(penumbra::GpuInstance) == 16 * penumbra::kGpuInstanceTexels);
static_assert(offsetof(penumbra::GpuInstance, worldFromObject0) == 80);
static_assert(penumbra::kMaxClusterOccluders <= 32); // a light's occluders are bits
static_assert(sizeof(penumbra::CullResult) == 32 &&
              offsetof(penumbra::CullResult, combineGroups) == 12);
static_assert(sizeof(penumbra::FrameConstants) == 880 + 96 * penumbra::kMaxBeams + 16 &&
              offsetof(penumbra::FrameConstants, clusterCount) == 848);
static_assert(sizeof(penumbra::DenseRotation) == 336);
#endif
#endif
