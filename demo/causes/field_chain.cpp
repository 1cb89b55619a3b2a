#include "demo/causes/field_chain.h"

#include "demo/causes/point_visibility.h"
#include "demo/reference/shade_all.h"
#include "demo/traced_scene.h"
#include "shaders/shared/visibility.h"
#include "systems/frame_constants.h"

#include <algorithm>
#include <bit>
#include <map>

namespace penumbra {

namespace {

constexpr std::uint32_t kPerCluster = 8; // receivers taken of a cluster, evenly

struct ChainReceiver {
    const ClusterEntities* cluster;
    std::uint32_t instance, index, radianceIndex; // index: of its texels
};

std::vector<ChainReceiver> chooseReceivers(const FieldChainInput& in,
                                           std::span<const ClusterEntities> visible)
{
    std::vector<ChainReceiver> chosen;
    const auto wanted = std::max<std::size_t>(in.receivers / kPerCluster, 1);
    const std::size_t every = std::max<std::size_t>(visible.size() / wanted, 1);
    for (std::size_t i = every / 2; i < visible.size(); i += every) {
        const SceneCluster& cluster = in.data.clusters[visible[i].cluster];
        const SceneInstance& instance = in.data.instances[cluster.instance];
        const MeshRange& mesh = in.data.meshes[instance.mesh];
        if (instance.emission * mesh.emission != vec3(0))
            continue;
        if (in.kernel == Kernel::Exact &&
            mirrorsSky(instance.material.glossFraction, instance.material.glossExponent))
            continue; // not by SH alone
        for (std::uint32_t v = 0; v < kClusterReceivers; v += kClusterReceivers / kPerCluster)
            if (cluster.firstReceiver + v < mesh.firstReceiver + mesh.vertexCount)
                chosen.push_back({&visible[i], cluster.instance, cluster.firstReceiver + v,
                                  cluster.firstRadiance + v});
    }
    return chosen;
}

FrameConstants withOrder4(FrameConstants constants)
{
    std::fill(std::begin(constants.light) + 16, std::end(constants.light), vec4(0));
    return constants;
}

// Visibility by instance and mesh: that of what it shows, and of what it blocks.
using Objects = std::map<std::pair<std::uint32_t, std::uint32_t>, PointVisibility>;

class Chain {
public:
    Chain(const FieldChainInput& in, const Objects& objects)
        : m_in(in), m_objects(objects), m_points(makeSamplePoints(std::bit_ceil(in.samples))),
          m_order4(withOrder4(in.constants))
    {}

    using Steps = std::array<vec3, kFieldCauses.size() + 1>;

    [[nodiscard]] Steps at(const ChainReceiver& chosen) const
    {
        const GpuInstance& self = m_in.rows.instances[chosen.instance];
        const ReceiverTexels& texels = m_in.data.receivers[chosen.index];
        const vec3 eye(m_in.constants.eye);
        const Receiver receiver = makeReceiver(self, texels.geometry, eye);
        const vec3 origin =
            receiver.position + rayOffset(m_in.traced, chosen.instance, {}) * receiver.normal;
        const std::uint32_t base = hashBits(chosen.radianceIndex + 77);
        const glm::uvec2 shift(base, hashBits(base + 0x9e3779b9u));

        const ShRotation worldFromObject = instanceRotation(self);
        const Sh4 own = m_objects.at({chosen.instance, m_in.data.instances[chosen.instance].mesh})
                            .above(origin, receiver.normal, m_points, shift);
        std::vector<Sh4> traced, plain, rounded; // [occluder] visibility, world
        std::vector<float> weights;
        const ClusterEntities& entities = *chosen.cluster;
        for (std::size_t place = 0; place < entities.occluders.size(); ++place) {
            const std::uint32_t entry = entities.occluders[place];
            const std::uint32_t row = entryRow(entry);
            const GpuInstance& g = m_in.rows.instances[row];
            const PointVisibility& object = m_objects.at({row, *m_in.data.instances[row].occluder});
            traced.push_back(object.at(origin, m_points, shift));
            const FieldEntity entity = instanceField(g);
            const FieldCell cell = fieldCell(fieldPoint(entity, receiver.position), entity.grid);
            const TracedCell nodes = traceCell(object, entity, cell, m_in.kernel, m_points, shift);
            const auto world = [&](const Sh4& steps) {
                return shRotate(fieldVisibility(steps, entity.bandScale * cell.decay),
                                entity.rotation);
            };
            plain.push_back(world(nodes.plain));
            rounded.push_back(world(nodes.rounded));
            weights.push_back(entityWeight(m_in.rows, entities, entry, entities.hiders[place],
                                           receiver.position, receiver.normal));
        }
        const Sh4 ownRounded = roundedOwn(own, worldFromObject);

        Steps steps{};
        integrate(chosen, receiver, origin, own, traced, shift, steps);
        const mat3 axes = objectFromWorld(self);
        steps[2] = product(receiver, axes, own, traced, weights, m_order4);
        steps[3] = product(receiver, axes, own, plain, weights, m_order4);
        steps[4] = product(receiver, axes, ownRounded, rounded, weights, m_order4);
        steps[5] = product(receiver, axes, ownRounded, rounded, weights, m_in.constants);
        const vec3 albedo(self.material);
        for (vec3& step : steps)
            step *= albedo;
        steps[6] = vec3(m_in.drawn[chosen.radianceIndex]);
        return steps;
    }

private:
    // Steps 0 and 1, direction by direction: all of the scene by rays, and the coefficients.
    void integrate(const ChainReceiver& chosen, const Receiver& receiver, vec3 origin,
                   const Sh4& own, const std::vector<Sh4>& occluders, glm::uvec2 shift,
                   Steps& steps) const
    {
        const Reflectance reflectance(normalize(receiver.normal),
                                      normalize(vec3(m_in.constants.eye) - receiver.position),
                                      m_in.data.instances[chosen.instance].material);
        ShadowPacket packet;
        packet.origin = origin;
        packet.distances.fill(std::numeric_limits<float>::infinity());
        std::array<vec3, ShadowPacket::kSize> light{};
        const auto flush = [&] {
            m_in.traced.occluded(packet);
            for (int i = 0; i < packet.count; ++i)
                steps[0] += packet.visible[i] ? light[i] : vec3(0);
            packet.count = 0;
        };
        for (const glm::uvec2 p : m_points) {
            const vec3 direction = reflectance.sample(scramble(p, shift));
            const Reflectance::Value r = reflectance.evaluate(direction);
            if (r.f <= 0)
                continue;
            const Sh4 basis = shBasis(direction);
            vec3 radiance(0);
            for (int k = 0; k < 16; ++k)
                radiance += basis.c[k] * vec3(m_in.constants.light[k]);
            radiance *= r.f / (r.pdf * static_cast<float>(m_points.size()));
            float through = shDot(own, basis);
            for (const Sh4& occluder : occluders)
                through *= shDot(occluder, basis);
            steps[1] += through * radiance;
            packet.directions[packet.count] = direction;
            light[static_cast<std::size_t>(packet.count)] = radiance;
            if (++packet.count == ShadowPacket::kSize)
                flush();
        }
        if (packet.count > 0)
            flush();
    }

    // As systems/techniques/shadow_fields/combine_cpu.cpp walks the occluders. `axes`: object from
    // world.
    [[nodiscard]] vec3 product(const Receiver& receiver, const mat3& axes, const Sh4& own,
                               const std::vector<Sh4>& occluders, const std::vector<float>& weights,
                               const FrameConstants& constants) const
    {
        const auto weighted = [](Sh4 visibility, float weight) {
            for (float& c : visibility.c)
                c *= weight;
            visibility.c[0] += (1 - weight) * kSqrt4Pi;
            return visibility;
        };
        vec3 sum(0);
        if (m_in.kernel == Kernel::Literal) {
            Sh4 transfer = transferSh(own, receiver);
            for (std::size_t i = 0; i < occluders.size(); ++i)
                transfer = shProduct(weighted(occluders[i], weights[i]), transfer);
            for (int k = 0; k < 16; ++k)
                sum += transfer.c[k] * vec3(constants.light[k]);
            return sum;
        }
        const ShRotation toObject = shRotation(axes);
        ShNodal through = shNodes(shRotate(own, toObject));
        for (std::size_t i = 0; i < occluders.size(); ++i)
            through = shMultiply(through,
                                 shNodes(shRotate(weighted(occluders[i], weights[i]), toObject)));
        const ShNodal transfer = transferNodal(through, turnReceiver(axes, receiver));
        const SkyNodes light = skyNodes(constants, glm::transpose(axes));
        for (std::size_t n = 0; n < light.size(); ++n)
            sum += transfer.v[n] * light[n];
        return sum;
    }

    [[nodiscard]] static Sh4 roundedOwn(const Sh4& own, const ShRotation& worldFromObject)
    {
        Sh4 local = shRotate(own, shInverse(worldFromObject));
        local.c[0] -= kSqrt4Pi;
        for (float& c : local.c)
            c = kSelfVisibilityScale *
                std::clamp(std::round(c / kSelfVisibilityScale), -128.0f, 127.0f);
        local.c[0] += kSqrt4Pi;
        return shRotate(local, worldFromObject);
    }

    const FieldChainInput& m_in;
    const Objects& m_objects;
    std::vector<glm::uvec2> m_points;
    FrameConstants m_order4;
};

} // namespace

Result<FieldChain> traceFieldChain(const FieldChainInput& in)
{
    FrameConstants constants = in.constants;
    constants.culls &= ~kCullHidden; // they have no weight, but each is a step of its own
    const std::vector<ClusterEntities> visible = cullAndSort(in.data, in.rows, constants);
    const std::vector<ChainReceiver> receivers = chooseReceivers(in, visible);
    Objects objects;
    const auto need = [&](std::uint32_t row, std::uint32_t mesh) -> Result<void> {
        if (objects.contains({row, mesh}))
            return {};
        const GpuInstance& g = in.rows.instances[row];
        Result<PointVisibility> made =
            PointVisibility::make(*in.meshes[mesh], worldFromObject(g), g.sphere);
        if (!made)
            return made.error();
        objects.emplace(std::pair(row, mesh), std::move(*made));
        return {};
    };
    Result<void> done;
    for (const ChainReceiver& receiver : receivers) {
        if (done)
            done = need(receiver.instance, in.data.instances[receiver.instance].mesh);
        for (const std::uint32_t entry : receiver.cluster->occluders)
            if (done)
                done = need(entryRow(entry), *in.data.instances[entryRow(entry)].occluder);
    }
    if (!done)
        return done.error();

    FieldChain out;
    for (std::vector<vec3>& step : out.steps)
        step.resize(receivers.size());
    const Chain chain(in, objects);
    tbb::parallel_for(std::size_t{0}, receivers.size(), [&](std::size_t i) {
        const Chain::Steps steps = chain.at(receivers[i]);
        for (std::size_t s = 0; s < steps.size(); ++s)
            out.steps[s][i] = steps[s];
    });
    return out;
}

} // namespace penumbra
