#include "assets/light_json.h"

#include "assets/shadow_field.h"

#include <algorithm>

namespace penumbra {

namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> kTypes = {"directional", "point", "spot"};
constexpr float kQuarter = 1.5707964f; // pi / 2, rounded up as doubles of it are

// Turns -z, along which glTF's lights shine, to `direction`.
quat turnTo(vec3 direction)
{
    const vec3 from(0, 0, -1);
    const float cosine = dot(from, direction);
    if (cosine < -0.99999f)
        return {0, 0, 1, 0};
    const vec3 axis = cross(from, direction);
    return normalize(quat(1 + cosine, axis.x, axis.y, axis.z));
}

} // namespace

MeshLight readLight(const JsonReader& source)
{
    MeshLight light;
    const std::string type = source.text("type");
    const auto found = std::find(kTypes.begin(), kTypes.end(), type);
    if (found == kTypes.end())
        source.refuse(fmt::format("has type \"{}\", known are directional, point and spot", type));
    else
        light.type = static_cast<LightType>(found - kTypes.begin());
    if (source.has("name"))
        light.name = source.text("name").substr(0, 256);
    if (source.has("color"))
        for (int c = 0; c < 3; ++c)
            light.color[c] =
                source.member("color").element(static_cast<std::size_t>(c)).asNumber(0, 1);
    if (source.has("intensity"))
        light.intensity = source.number("intensity", 0, kMaxLightIntensity);
    if (source.has("range"))
        light.range = source.number("range", 1e-9f, kMaxCoordinate);
    if (light.type == LightType::Spot && source.has("spot")) {
        const JsonReader spot = source.member("spot");
        if (spot.has("innerConeAngle"))
            light.innerCone = spot.number("innerConeAngle", 0, kQuarter);
        if (spot.has("outerConeAngle"))
            light.outerCone = spot.number("outerConeAngle", 0, kQuarter);
        if (!(light.innerCone < light.outerCone))
            spot.refuse(fmt::format("has an inner cone of {} and an outer of {}", light.innerCone,
                                    light.outerCone));
    }
    return light;
}

std::vector<MeshLight> readLights(const JsonReader& root)
{
    std::vector<MeshLight> lights;
    if (!root.has("extensions") || !root.member("extensions").has(kLightExtension))
        return lights;
    const JsonReader sources = root.member("extensions").member(kLightExtension).member("lights");
    const std::size_t count = sources.length(kMaxMeshLights);
    for (std::size_t i = 0; i < count; ++i)
        lights.push_back(readLight(sources.element(i)));
    return lights;
}

std::optional<std::size_t> lightOfNode(const JsonReader& node, std::size_t count)
{
    if (!node.has("extensions") || !node.member("extensions").has(kLightExtension))
        return std::nullopt;
    const JsonReader extension = node.member("extensions").member(kLightExtension);
    const std::uint64_t light = extension.count("light", kMaxMeshLights);
    if (light < count)
        return light;
    extension.refuse(fmt::format("names light {} of {}", light, count));
    return std::nullopt;
}

json lightJson(const MeshLight& light)
{
    json result = {{"type", kTypes[static_cast<std::size_t>(light.type)]},
                   {"color", {light.color.r, light.color.g, light.color.b}},
                   {"intensity", light.intensity}};
    if (!light.name.empty())
        result["name"] = light.name;
    if (light.range > 0)
        result["range"] = light.range;
    if (light.type == LightType::Spot)
        result["spot"] = {{"innerConeAngle", light.innerCone}, {"outerConeAngle", light.outerCone}};
    return result;
}

void writeLights(const std::vector<MeshLight>& lights, GltfWriter& out)
{
    if (lights.empty())
        return;
    out.useExtension(kLightExtension);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const MeshLight& light = lights[i];
        const quat turn = turnTo(light.direction);
        out.document["extensions"][kLightExtension]["lights"].push_back(lightJson(light));
        out.document["scenes"][0]["nodes"].push_back(out.document["nodes"].size());
        out.document["nodes"].push_back(
            {{"name", light.name},
             {"translation", {light.position.x, light.position.y, light.position.z}},
             {"rotation", {turn.x, turn.y, turn.z, turn.w}},
             {"extensions", {{kLightExtension, {{"light", i}}}}}});
    }
}

std::vector<MeshLight> readPlacedLights(const JsonReader& root)
{
    std::vector<MeshLight> placed;
    const std::vector<MeshLight> lights = readLights(root);
    if (lights.empty() || !root.has("nodes"))
        return placed;
    const JsonReader nodes = root.member("nodes");
    const std::size_t count = nodes.length(kMaxGltfElements);
    for (std::size_t i = 0; i < count; ++i) {
        const JsonReader node = nodes.element(i);
        const std::optional<std::size_t> index = lightOfNode(node, lights.size());
        if (!index)
            continue;
        if (placed.size() == kMaxMeshLights) {
            nodes.refuse(fmt::format("have more than {} lights", kMaxMeshLights));
            break;
        }
        MeshLight light = lights[*index];
        std::array<float, 4> turn{};
        for (std::size_t k = 0; k < 4; ++k)
            turn[k] = node.member("rotation").element(k).asNumber(-1, 1);
        for (int axis = 0; axis < 3; ++axis)
            light.position[axis] = node.member("translation")
                                       .element(static_cast<std::size_t>(axis))
                                       .asNumber(-kMaxCoordinate, kMaxCoordinate);
        const quat rotation(turn[3], turn[0], turn[1], turn[2]);
        if (std::abs(dot(rotation, rotation) - 1) > 0.01f)
            node.refuse("has a rotation that is no unit quaternion");
        light.direction = rotation * vec3(0, 0, -1);
        placed.push_back(light);
    }
    return placed;
}

} // namespace penumbra
