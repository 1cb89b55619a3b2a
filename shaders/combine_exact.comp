#version 460
// combine_exact: one workgroup per visible cluster, kReceivers receivers per invocation.
//   V = self-visibility of the receiver, its values at the 32 nodes
//   occluder:    V = O * V, node by node                              (triple product)
//   local light: B += integral of S T', where T' is T of V with the occluders that stand before the light (double
//                product; T = V times BRDF: shaders/shared/transfer.h), corrected as shaders/shared/emitter.h says
//   environment: B += sum over nodes of weight * L * T, after the last occluder; what the SH of L lack for sharp
//                reflections is added as shaders/shared/gloss.h says
// The nodes lie fixed in the receiver's object, so a scene that is turned as a whole looks the same.
// Source: Zhou et al. 2005, Fig. 5; the fast way is findings section 1, kernel J.
// Differs: products at quadrature nodes instead of tripling coefficients, so a chain keeps more than order 4 and is
// commutative; tetrahedral instead of trilinear sampling with weights of 1/256; entities sorted per cluster, those
// at the edge of a full list in part; an occluder comes before a light by a weight, not by a yes or no
// (shaders/shared/order.h).
//   reads   visible, clusters, lists, instances, fields, receivers, skyNodes, skyLobes
//   writes  radiance [receiver] linear RGB in W/(m² sr), a = 1
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/emitter.h"
#include "shaders/shared/gloss.h"
#include "shaders/shared/order.h"
#include "shaders/shared/visibility.h"

layout(constant_id = 0) const uint kReceivers = 4; // per invocation: amortises the loads of an occluder's constants
layout(local_size_x_id = 1) in;                    // kClusterReceivers / kReceivers
layout(constant_id = 2) const float kSelfScale = 1.0;
layout(constant_id = 3) const bool kLocalLights = true;
layout(constant_id = 4) const bool kMirrors = false; // some surface mirrors the filtered sky
layout(constant_id = 5) const bool kHiders = true;   // some occluder hides others

FieldTetrahedron tetrahedronAt(FieldEntity entity, vec3 position, out FieldCell cell)
{
    cell = fieldCell(fieldPoint(entity, position), entity.grid);
    return fieldTetrahedron(cell.fraction, entity.grid);
}

Sh4 sampleField(uint sample0, FieldTetrahedron t)
{
    return fieldBlend(texelFetch(fieldTexels, int(sample0)), texelFetch(fieldTexels, int(sample0 + t.offset.y)),
                      texelFetch(fieldTexels, int(sample0 + t.offset.z)),
                      texelFetch(fieldTexels, int(sample0 + t.offset.w)), t.weight);
}

// `weight`: 1 blocks as the field says, 0 not at all.
ShNodal occlusion(FieldEntity entity, vec3 position, float weight)
{
    FieldCell cell;
    const FieldTetrahedron t = tetrahedronAt(entity, position, cell);
    const Sh4 steps = sampleField(cell.sample0, t);
    const Sh4 visibility = fieldVisibility(steps, entity.bandScale * (weight * cell.decay * (1.0 / 256.0)));
    return shNodes(shRotate(visibility, entity.rotation));
}

// The double product, in the light's frame: one rotation for three channels.
vec3 lightThrough(ShNodal transfer, FieldEntity light, Receiver lit)
{
    FieldCell cell;
    const FieldTetrahedron t = tetrahedronAt(light, lit.position, cell);
    const vec4 scale = light.bandScale * (cell.decay * (1.0 / 256.0));
    const uint channel = light.grid.side * light.grid.side * light.grid.shells;
    const Sh4 r = sampleField(cell.sample0, t), g = sampleField(cell.sample0 + channel, t);
    const Sh4 b = sampleField(cell.sample0 + 2u * channel, t);
    const Sh4 all = fieldDeviation(shAdd(shAdd(r, g), b), scale);
    const Sh4 local = fieldDeviation(shRotate(shProject(transfer), shInverse(light.rotation)), scale);
    const float matte = irradianceCorrection(all, normalize(light.radiiFromWorld * lit.normal));
    const float correction = mix(matte, 1.0, lit.glossFraction);
    return correction * max(vec3(shDot(local, r), shDot(local, g), shDot(local, b)), vec3(0.0));
}

uint listed(uint at) { return texelFetch(listTexels, int(gl_WorkGroupID.x * kListStride + at)).x; }

Receiver receiver[kReceivers];
ShNodal visibility[kReceivers], through[kReceivers]; // `through`: with what stands before a light
float left[kReceivers];
vec3 sum[kReceivers];
mat3 axes; // object from world, of the receivers, without scale: where the nodes lie
uint firstSkyNode;

Receiver inObject(uint v) { return turnReceiver(axes, receiver[v]); }

vec3 skyNode(int n) { return texelFetch(skyNodeTexels, int(firstSkyNode) + n).rgb; }

float risen(vec4 sphere, uint v)
{
    return horizonWeight(receiver[v].normal, sphere.xyz - receiver[v].position, sphere.w);
}

// Sets `left`: what inscribed balls leave of an entity for each receiver. `hiders`: where in the lists its hiders stand.
void findShadows(vec4 sphere, uint hiders)
{
    if (!kHiders)
        return;
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v)
        left[v] = 1.0;
    for (uint bits = listed(hiders); bits != 0u; bits &= bits - 1u) {
        const uint entry = listed(kListOccluders + uint(findLSB(bits)));
        const GpuInstance hider = loadInstance(entryRow(entry));
        [[unroll]] for (uint v = 0u; v < kReceivers; ++v)
            left[v] *= unhidden(receiver[v].position, hider.inscribed, sphere,
                                entryShare(entry) * risen(hider.sphere, v));
    }
}

// How much an entity counts for a receiver, after findShadows().
float entityWeight(uint entry, vec4 sphere, uint v)
{
    return (kHiders ? left[v] : 1.0) * entryShare(entry) * risen(sphere, v);
}

void occlude(uint place)
{
    const uint entry = listed(kListOccluders + place);
    const GpuInstance occluder = loadInstance(entryRow(entry));
    findShadows(occluder.sphere, kListHiders + place);
    const FieldEntity entity = instanceFieldIn(axes, occluder);
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v)
        visibility[v] = shMultiply(visibility[v], occlusion(entity, receiver[v].position,
                                                            entityWeight(entry, occluder.sphere, v)));
}

// Adds the light at `at` of the lists to `sum`. The loops over receivers stand inside the one over occluders: Mesa
// unrolls no loop that holds another, and would keep `visibility` in memory (docs/benchmarks.md, Local lights).
void localLight(uint at)
{
    const uint lightEntry = listed(at);
    const GpuInstance light = loadInstance(entryRow(lightEntry));
    const FieldEntity field = instanceFieldIn(axes, light);
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v)
        through[v] = visibility[v];
    // Occluders that `visibility` has not got yet and that may stand before the light.
    for (uint bits = listed(at + 2u); bits != 0u; bits &= bits - 1u) {
        const uint place = uint(findLSB(bits));
        const uint entry = listed(kListOccluders + place);
        const GpuInstance occluder = loadInstance(entryRow(entry));
        findShadows(occluder.sphere, kListHiders + place);
        const FieldEntity entity = instanceFieldIn(axes, occluder);
        [[unroll]] for (uint v = 0u; v < kReceivers; ++v) {
            const vec3 position = receiver[v].position;
            const float weight =
                entityWeight(entry, occluder.sphere, v) * orderWeight(occluder.sphere, light.sphere, position);
            through[v] = shMultiply(through[v], occlusion(entity, position, weight));
        }
    }
    findShadows(light.sphere, at + 3u);
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v)
        sum[v] += entityWeight(lightEntry, light.sphere, v) * light.material.rgb *
                  lightThrough(transferNodal(through[v], inObject(v)), field, receiver[v]);
}

vec4 lobeTexel(uint at) { return texelFetch(skyLobeTexels, int(at)); }

vec3 filteredSky(vec3 direction, float exponent)
{
    const float level = skyLobeLevel(exponent);
    const uint lower = min(uint(level), kSkyLobeLevels - 2u);
    vec3 sky[2];
    for (uint k = 0u; k < 2u; ++k) {
        const SkyLobeCell c = skyLobeCell(direction, lower + k);
        const vec4 low = mix(lobeTexel(c.texel), lobeTexel(c.texel + 1u), c.fraction.x);
        const vec4 high = mix(lobeTexel(c.texel + c.side), lobeTexel(c.texel + c.side + 1u), c.fraction.x);
        sky[k] = mix(low, high, c.fraction.y).rgb;
    }
    return mix(sky[0], sky[1], level - float(lower));
}

vec3 sharpReflection(uint v)
{
    const ZonalPolynomial phong = phongPolynomial(receiver[v].glossExponent);
    const Receiver turned = inObject(v);
    GlossSums sums = GlossSums(0.0, vec3(0.0));
    [[unroll]] for (int n = 0; n < 32; ++n) { // as a loop, it would keep the nodes in memory
        const float gloss = visibility[v].v[n] * glossAt(turned, phong, kShNodes[n].xyz);
        sums.visible += gloss * kShNodes[n].w;
        sums.reflected += gloss * skyNode(n);
    }
    return skyGloss(receiver[v], sums, filteredSky(skyLobeDirection(receiver[v]), receiver[v].glossExponent));
}

void main()
{
    const uint lanes = kClusterReceivers / kReceivers;
    const SceneCluster cluster = clusters[texelFetch(visibleTexels, int(gl_WorkGroupID.x)).x];
    const uint occluders = listed(0u);

    const GpuInstance self = loadInstance(cluster.instance);
    axes = objectFromWorld(self);
    firstSkyNode = kSkyNodes * cluster.instance;
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v) {
        const int texel = 2 * int(cluster.firstReceiver + gl_LocalInvocationID.x + v * lanes);
        receiver[v] = makeReceiver(self, texelFetch(receiverTexels, texel), frame.eye.xyz);
        visibility[v] = shNodes(selfVisibility(texelFetch(receiverTexels, texel + 1), kSelfScale));
        sum[v] = vec3(0.0);
    }

    uint next = 0u;
    if (kLocalLights) {
        const uint lights = listed(1u);
        for (uint l = 0u; l < lights; ++l) {
            const uint at = kListLights + kListLightStride * l;
            for (const uint before = listed(at + 1u); next < before; ++next)
                occlude(next);
            localLight(at);
        }
    }
    for (; next < occluders; ++next)
        occlude(next);

    const bool sharp = kMirrors && mirrorsSky(self.material.w, self.material1.x);
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v) {
        const ShNodal transfer = transferNodal(visibility[v], inObject(v));
        for (int n = 0; n < 32; ++n)
            sum[v] += transfer.v[n] * skyNode(n);
        if (sharp)
            sum[v] += sharpReflection(v);
        radiance[cluster.firstRadiance + gl_LocalInvocationID.x + v * lanes] =
            vec4(self.material.rgb * sum[v] + self.emission.rgb, 1.0);
    }
}
