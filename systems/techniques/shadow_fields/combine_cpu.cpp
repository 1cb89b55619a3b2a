#include "systems/techniques/shadow_fields/combine_cpu.h"

#include "shaders/shared/emitter.h"
#include "shaders/shared/order.h"
#include "shaders/shared/visibility.h"
#include "systems/frame_constants.h"

#include <algorithm>
#include <bit>

namespace penumbra {

namespace {

struct ClusterSphere {
    vec3 center; // world
    float radius;
    vec3 faceAxis, vertexAxis;
};

ClusterSphere worldBounds(const ClusterBounds& bounds, const GpuInstance& g)
{
    ClusterSphere s;
    s.center =
        affine(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, vec3(bounds.sphere));
    const auto axis = [&](vec3 object) {
        return linear(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, object) /
               g.material1.y;
    };
    s.faceAxis = axis(vec3(bounds.faces));
    s.vertexAxis = axis(vec3(bounds.vertices));
    s.radius = bounds.sphere.w * g.material1.y;
    return s;
}

using Samples = std::vector<uvec4>;

Sh4 sampleTrilinear(const Samples& samples, std::uint32_t sample0, const FieldCell& cell,
                    const FieldGrid& grid)
{
    Sh4 sum{};
    for (uint corner = 0; corner < 8; ++corner) {
        const Sh4 steps = fieldSteps(samples[sample0 + fieldCornerOffset(corner, grid)]);
        const float weight = fieldCornerWeight(corner, cell.fraction);
        for (int k = 0; k < 16; ++k)
            sum.c[k] += weight * steps.c[k];
    }
    return sum;
}

Sh4 sampleTetrahedral(const Samples& samples, std::uint32_t sample0, const FieldTetrahedron& t)
{
    return fieldBlend(samples[sample0], samples[sample0 + t.offset.y],
                      samples[sample0 + t.offset.z], samples[sample0 + t.offset.w], t.weight);
}

// Kernel literal for one receiver.
struct LiteralProduct {
    const SceneData& scene;
    const CpuInstances& rows;
    vec3 position, normal; // of the receiver

    [[nodiscard]] Sh4 occlude(const Sh4& transfer, std::uint32_t row, float weight) const
    {
        const FieldEntity entity = instanceField(rows.instances[row]);
        const FieldCell cell = fieldCell(fieldPoint(entity, position), entity.grid);
        const Sh4 visibility =
            fieldVisibility(sampleTrilinear(scene.fieldSamples, cell.sample0, cell, entity.grid),
                            entity.bandScale * (weight * cell.decay));
        return shProduct(shRotateDense(visibility, rows.dense[row]), transfer);
    }

    [[nodiscard]] vec3 lightThrough(const Sh4& transfer, std::uint32_t row) const
    {
        const FieldEntity entity = instanceField(rows.instances[row]);
        const FieldGrid& grid = entity.grid;
        const FieldCell cell = fieldCell(fieldPoint(entity, position), grid);
        vec3 b(0);
        for (uint channel = 0; channel < 3; ++channel) {
            const std::uint32_t sample0 =
                cell.sample0 + channel * grid.side * grid.side * grid.shells;
            const Sh4 source =
                fieldDeviation(sampleTrilinear(scene.fieldSamples, sample0, cell, grid),
                               entity.bandScale * cell.decay);
            b[static_cast<int>(channel)] = shDot(shRotateDense(source, rows.dense[row]), transfer);
        }
        return b;
    }
};

// Kernel exact for one receiver. Its nodes lie in the receiver's object.
struct ExactProduct {
    const SceneData& scene;
    const CpuInstances& rows;
    Receiver receiver;
    const mat3& axes; // object from world
    vec3 position = receiver.position, normal = receiver.normal;

    [[nodiscard]] ShNodal occlude(const ShNodal& before, std::uint32_t row, float weight) const
    {
        const FieldEntity entity = instanceFieldIn(axes, rows.instances[row]);
        const FieldCell cell = fieldCell(fieldPoint(entity, position), entity.grid);
        const FieldTetrahedron t = fieldTetrahedron(cell.fraction, entity.grid);
        const Sh4 visibility =
            fieldVisibility(sampleTetrahedral(scene.fieldSamples, cell.sample0, t),
                            entity.bandScale * (weight * cell.decay * (1.0f / 256.0f)));
        return shMultiply(before, shNodes(shRotate(visibility, entity.rotation)));
    }

    [[nodiscard]] vec3 lightThrough(const ShNodal& through, std::uint32_t row) const
    {
        const ShNodal transfer = transferNodal(through, turnReceiver(axes, receiver));
        const FieldEntity light = instanceFieldIn(axes, rows.instances[row]);
        const FieldGrid& grid = light.grid;
        const FieldCell cell = fieldCell(fieldPoint(light, position), grid);
        const FieldTetrahedron t = fieldTetrahedron(cell.fraction, grid);
        const vec4 scale = light.bandScale * (cell.decay * (1.0f / 256.0f));
        const Sh4 local =
            fieldDeviation(shRotate(shProject(transfer), shInverse(light.rotation)), scale);
        Sh4 all{};
        vec3 b(0);
        for (uint channel = 0; channel < 3; ++channel) {
            const Sh4 steps =
                sampleTetrahedral(scene.fieldSamples,
                                  cell.sample0 + channel * grid.side * grid.side * grid.shells, t);
            all = shAdd(all, steps);
            b[static_cast<int>(channel)] = shDot(local, steps);
        }
        const float matte = irradianceCorrection(fieldDeviation(all, scale),
                                                 normalize(light.radiiFromWorld * normal));
        const float correction = mix(matte, 1.0f, receiver.glossFraction);
        return correction * max(b, vec3(0));
    }
};

// Through the occluders near to far, with each light where it stands. Adds the lights' part to
// `sum`; returns the transfer (kernel exact: the visibility) behind the last occluder, for the
// environment.
template <class Product, class Transfer>
Transfer walk(const Product& product, Transfer transfer, const ClusterEntities& entities, vec3& sum)
{
    const auto weight = [&](std::uint32_t entry, std::uint32_t hiders) {
        return entityWeight(product.rows, entities, entry, hiders, product.position,
                            product.normal);
    };
    const auto occluderWeight = [&](std::size_t place) {
        return weight(entities.occluders[place], entities.hiders[place]);
    };
    std::uint32_t next = 0;
    const auto occludeNext = [&] {
        transfer =
            product.occlude(transfer, entryRow(entities.occluders[next]), occluderWeight(next));
        ++next;
    };
    for (const ClusterLight& light : entities.lights) {
        while (next < light.before)
            occludeNext();
        Transfer through = transfer;
        const std::uint32_t lightRow = entryRow(light.entry);
        const GpuInstance& source = product.rows.instances[lightRow];
        for (std::uint32_t bits = light.possible; bits != 0; bits &= bits - 1) {
            const auto place = static_cast<std::size_t>(std::countr_zero(bits));
            const std::uint32_t row = entryRow(entities.occluders[place]);
            const float order =
                orderWeight(product.rows.instances[row].sphere, source.sphere, product.position);
            through = product.occlude(through, row, order * occluderWeight(place));
        }
        sum += weight(light.entry, light.hiders) * vec3(source.material) *
               product.lightThrough(through, lightRow);
    }
    while (next < entities.occluders.size())
        occludeNext();
    return transfer;
}

// `turned`: the receiver in the axes where the nodes lie.
vec3 sharpReflection(const Receiver& receiver, const Receiver& turned, const ShNodal& visibility,
                     const SkyNodes& light, const SkyLobes& sky)
{
    const ZonalPolynomial phong = phongPolynomial(receiver.glossExponent);
    GlossSums sums{};
    for (int n = 0; n < 32; ++n) {
        const float gloss = visibility.v[n] * glossAt(turned, phong, vec3(kShNodes[n]));
        sums.visible += gloss * kShNodes[n].w;
        sums.reflected += gloss * light[static_cast<std::size_t>(n)];
    }
    return skyGloss(receiver, sums,
                    filteredSky(sky, skyLobeDirection(receiver), receiver.glossExponent));
}

struct Candidate {
    float key, importance;
    std::uint32_t row;
    std::uint32_t entry = 0, hiders = 0;
    bool hidden = false;
};

// The most important ones, near to far, with their share.
void choose(std::vector<Candidate>& all, std::size_t limit)
{
    float least = 0;
    if (all.size() > limit) {
        std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
            return a.importance > b.importance;
        });
        least = all[limit].importance;
        all.resize(limit);
    }
    for (Candidate& c : all)
        c.entry = listEntry(c.row, entityShare(c.importance, least));
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.key, a.row) < std::pair(b.key, b.row);
    });
}

// Sets `hiders` (bits of places in `occluders`) and, with `drops`, `hidden` of a list.
void findHidden(std::vector<Candidate>& list, std::span<const Candidate> occluders,
                const CpuInstances& rows, const ClusterSphere& s, float cutoff, bool drops)
{
    const vec4 cluster(s.center, s.radius);
    for (std::size_t j = 0; j < occluders.size(); ++j) {
        const std::uint32_t row = occluders[j].row;
        const GpuInstance& hider = rows.instances[row];
        const ClusterShadow shadow = clusterShadow(cluster, hider.inscribed);
        const bool whole =
            entryShare(occluders[j].entry) == 1 &&
            lowestOver(vec3(hider.sphere) - s.center, s.vertexAxis, cutoff) >= s.radius;
        for (Candidate& entity : list) {
            const GpuInstance& g = rows.instances[entity.row];
            const auto surface = static_cast<std::uint32_t>(g.material1.z);
            if (entity.row == row || surface == row + 1)
                continue;
            const ShadowBounds bounds =
                shadowBounds(shadow, vec3(g.sphere) - vec3(cluster), g.sphere.w);
            entity.hiders |= bounds.touched ? 1u << j : 0u;
            entity.hidden |= drops && whole && bounds.hidden;
        }
    }
}

// The lists of pass entity_sort for one cluster.
ClusterEntities sortEntities(const SceneData& scene, const CpuInstances& rows,
                             std::uint32_t clusterIndex, const ClusterSphere& s,
                             std::uint32_t culls)
{
    const SceneCluster& cluster = scene.clusters[clusterIndex];
    const float cutoff = scene.bounds[cluster.bounds].vertices.w;
    std::vector<Candidate> occluders, lights;
    for (std::uint32_t i = 0; i < rows.instances.size(); ++i) {
        const GpuInstance& g = rows.instances[i];
        const vec3 to = vec3(g.sphere) - s.center;
        if (g.grid.w == 0 || length(to) - s.radius > g.grid.w)
            continue;
        const float highest = highestOver(to, s.vertexAxis, cutoff);
        if ((culls & kCullHorizon) != 0 && belowHorizon(highest, g.sphere.w, s.radius))
            continue;
        const float key = powerDistance(g.sphere, s.center);
        const float importance = entityImportance(to, highest, g.sphere.w, g.grid.w, s.radius);
        if (i < scene.instances.size()) {
            if (i != cluster.instance)
                occluders.push_back({key, importance, i});
        } else if (static_cast<std::uint32_t>(g.material1.z) != cluster.instance + 1) {
            lights.push_back({key, importance * lightStrength(g), i});
        }
    }
    choose(occluders, kMaxClusterOccluders);
    choose(lights, kMaxClusterLights);

    const std::vector<Candidate> all = occluders;
    const bool drops = (culls & kCullHidden) != 0;
    findHidden(occluders, all, rows, s, cutoff, drops);
    findHidden(lights, all, rows, s, cutoff, drops);
    std::vector<Candidate> placed = occluders;
    std::stable_partition(placed.begin(), placed.end(),
                          [](const Candidate& occluder) { return !occluder.hidden; });
    const auto places = [&](std::uint32_t hiders) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < placed.size(); ++i)
            for (std::size_t j = 0; j < all.size(); ++j)
                bits |= (hiders >> j & 1u) != 0 && all[j].row == placed[i].row ? 1u << i : 0u;
        return bits;
    };

    ClusterEntities out{clusterIndex};
    for (const Candidate& occluder : placed) {
        (occluder.hidden ? out.hidden : out.occluders).push_back(occluder.entry);
        if (!occluder.hidden)
            out.hiders.push_back(places(occluder.hiders));
    }
    std::erase_if(lights, [](const Candidate& light) { return light.hidden; });
    out.lights.resize(lights.size());
    auto before = static_cast<std::uint32_t>(out.occluders.size());
    for (std::size_t l = lights.size(); l-- > 0;) {
        const GpuInstance& g = rows.instances[lights[l].row];
        std::uint32_t certain = 0, possible = 0;
        for (std::uint32_t i = 0; i < out.occluders.size(); ++i) {
            const std::uint32_t row = placed[i].row;
            const bool own = row + 1 == static_cast<std::uint32_t>(g.material1.z);
            const float weight =
                own ? 0
                    : orderWeightAround(rows.instances[row].sphere, g.sphere, s.center, s.radius);
            possible |= weight > 0 ? 1u << i : 0u;
            certain += certain == i && weight == 1 ? 1u : 0u;
        }
        before = std::min(before, certain);
        out.lights[l] = {lights[l].entry, before, before < 32 ? possible >> before << before : 0u,
                         places(lights[l].hiders)};
    }
    return out;
}

} // namespace

CpuInstances updateInstances(const SceneData& scene)
{
    CpuInstances out;
    for (std::uint32_t row = 0; row < rowCount(scene); ++row) {
        const InstanceInput input = rowInput(scene, row);
        out.instances.push_back(
            makeInstance(input, scene.fields[input.field == kNoField ? 0 : input.field]));
        out.dense.push_back(denseRotation(instanceRotation(out.instances.back())));
    }
    return out;
}

float entityWeight(const CpuInstances& rows, const ClusterEntities& entities, std::uint32_t entry,
                   std::uint32_t hiders, vec3 position, vec3 normal)
{
    const auto counts = [&](std::uint32_t of) {
        const vec4 sphere = rows.instances[entryRow(of)].sphere;
        return entryShare(of) * horizonWeight(normal, vec3(sphere) - position, sphere.w);
    };
    float weight = counts(entry);
    for (std::uint32_t bits = hiders; bits != 0; bits &= bits - 1) {
        const auto place = static_cast<std::size_t>(std::countr_zero(bits));
        const std::size_t kept = entities.occluders.size();
        const std::uint32_t hider =
            place < kept ? entities.occluders[place] : entities.hidden[place - kept];
        weight *= unhidden(position, rows.instances[entryRow(hider)].inscribed,
                           rows.instances[entryRow(entry)].sphere, counts(hider));
    }
    return weight;
}

std::vector<ClusterEntities> cullAndSort(const SceneData& scene, const CpuInstances& instances,
                                         const FrameConstants& frame)
{
    std::vector<ClusterEntities> visible;
    for (std::uint32_t c = 0; c < scene.clusters.size(); ++c) {
        const SceneCluster& cluster = scene.clusters[c];
        const ClusterBounds& bounds = scene.bounds[cluster.bounds];
        const ClusterSphere s = worldBounds(bounds, instances.instances[cluster.instance]);
        const bool outside =
            (frame.culls & kCullFrustum) != 0 &&
            std::any_of(std::begin(frame.frustum), std::end(frame.frustum), [&](const vec4& plane) {
                return sphereOutside(plane, s.center, s.radius);
            });
        const bool away =
            (frame.culls & kCullBackfaces) != 0 &&
            facesAway(s.center - vec3(frame.eye), s.faceAxis, bounds.faces.w, s.radius);
        if (!outside && !away)
            visible.push_back(sortEntities(scene, instances, c, s, frame.culls));
    }
    return visible;
}

void combineCluster(Kernel kernel, const SceneData& scene, const CpuInstances& instances,
                    const FrameConstants& frame, const ClusterEntities& entities,
                    std::span<vec4> radiance, const SkyLobes* sky)
{
    const SceneCluster& cluster = scene.clusters[entities.cluster];
    const GpuInstance& self = instances.instances[cluster.instance];
    const mat3 axes = objectFromWorld(self);
    const SkyNodes light =
        kernel == Kernel::Exact ? skyNodes(frame, glm::transpose(axes)) : SkyNodes{};
    for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
        const ReceiverTexels& texels = scene.receivers[cluster.firstReceiver + v];
        const Receiver receiver = makeReceiver(self, texels.geometry, vec3(frame.eye));
        const Sh4 ownVisibility = selfVisibility(texels.selfVisibility, kSelfVisibilityScale);
        vec3 sum(0);
        if (kernel == Kernel::Literal) {
            const Sh4 transfer =
                walk(LiteralProduct{scene, instances, receiver.position, receiver.normal},
                     transferSh(shRotateDense(ownVisibility, instances.dense[cluster.instance]),
                                receiver),
                     entities, sum);
            for (int k = 0; k < 16; ++k)
                sum += transfer.c[k] * vec3(frame.light[k]);
        } else {
            const ShNodal visibility = walk(ExactProduct{scene, instances, receiver, axes},
                                            shNodes(ownVisibility), entities, sum);
            const Receiver turned = turnReceiver(axes, receiver);
            const ShNodal transfer = transferNodal(visibility, turned);
            for (std::size_t n = 0; n < light.size(); ++n)
                sum += transfer.v[n] * light[n];
            if (sky != nullptr && mirrorsSky(receiver.glossFraction, receiver.glossExponent))
                sum += sharpReflection(receiver, turned, visibility, light, *sky);
        }
        radiance[cluster.firstRadiance + v] =
            vec4(vec3(self.material) * sum + vec3(self.emission), 1);
    }
}

} // namespace penumbra
