#include "assetc/light/spec.h"

#include "assetc/import/folder.h"
#include "runtime/assert.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::uint64_t kMaxSpecBytes = 64 << 10;
constexpr float kMaxEmission = 1e12f; // of power and intensity; their radiance is checked later

struct ShapeMembers {
    const char* type;
    EmitterShape shape;
    std::vector<std::string_view> members; // besides the common ones
};

const std::vector<ShapeMembers>& shapes()
{
    static const std::vector<ShapeMembers> kShapes = {
        {"sphere", EmitterShape::Sphere, {"radius"}},
        {"rectangle", EmitterShape::Rectangle, {"size", "texture", "twoSided"}},
        {"disc", EmitterShape::Disc, {"radius", "texture", "twoSided"}},
        {"spot", EmitterShape::Spot, {"radius", "innerAngle", "outerAngle", "intensity"}},
        {"mesh", EmitterShape::Mesh, {"source", "twoSided"}},
    };
    return kShapes;
}

const ShapeMembers* findShape(const JsonReader& root)
{
    const JsonReader type = root.member("type");
    const std::string name = type.asText();
    for (const ShapeMembers& shape : shapes())
        if (name == shape.type)
            return &shape;
    if (type.isText())
        type.refuse(
            fmt::format("is {}, not one of sphere, rectangle, disc, spot, mesh", type.quoted()));
    return nullptr;
}

void refuseUnknown(const ShapeMembers& shape, const JsonReader& root)
{
    std::vector<std::string_view> known = {"version", "type", "radiance", "power", "reach"};
    known.insert(known.end(), shape.members.begin(), shape.members.end());
    root.refuseOthers(known);
}

vec3 color(const JsonReader& reader, float max)
{
    vec3 result{0};
    if (!reader.isArrayOf(3))
        reader.refuse(fmt::format("is {}, not three numbers [r, g, b]", reader.quoted()));
    else
        for (int i = 0; i < 3; ++i)
            result[i] = reader.element(static_cast<std::size_t>(i)).asNumber(0, max);
    return result;
}

void readEmission(const JsonReader& root, LightSpec& spec)
{
    struct Unit {
        const char* key;
        EmissionUnit unit;
        float max;
    };
    int given = 0;
    for (const Unit& u : {Unit{"radiance", EmissionUnit::Radiance, kMaxRadiance},
                          Unit{"power", EmissionUnit::Power, kMaxEmission},
                          Unit{"intensity", EmissionUnit::Intensity, kMaxEmission}}) {
        if (!root.has(u.key))
            continue;
        ++given;
        spec.unit = u.unit;
        spec.emission = color(root.member(u.key), u.max);
        if (spec.emission == vec3(0))
            root.member(u.key).refuse("is black; a light emits something");
    }
    if (given != 1)
        root.refuse(fmt::format("has {} of \"radiance\", \"power\" and, for a spot, "
                                "\"intensity\"; it needs exactly one",
                                given));
}

float length(const JsonReader& reader)
{
    return reader.asNumber(kMinEmitterSize, kMaxEmitterSize);
}

void readShape(const JsonReader& root, LightSpec& spec)
{
    switch (spec.shape) {
    case EmitterShape::Sphere:
    case EmitterShape::Disc:
        spec.radius = length(root.member("radius"));
        break;
    case EmitterShape::Rectangle: {
        const JsonReader size = root.member("size");
        if (size.isArrayOf(2))
            spec.size = vec2(length(size.element(0)), length(size.element(1)));
        else
            size.refuse(fmt::format("is {}, not two lengths [width, height]", size.quoted()));
        if (size.isArrayOf(2) &&
            std::max(spec.size.x, spec.size.y) > 1000 * std::min(spec.size.x, spec.size.y))
            size.refuse(fmt::format("is {} by {}, more than 1000 times as long as wide",
                                    spec.size.x, spec.size.y));
        break;
    }
    case EmitterShape::Spot:
        spec.radius = length(root.member("radius"));
        spec.outerAngle = root.number("outerAngle", kMinOuterAngle, kMaxOuterAngle);
        spec.innerAngle = root.number("innerAngle", 0, kMaxOuterAngle);
        if (spec.innerAngle > spec.outerAngle - kMinFalloffAngle)
            root.member("innerAngle")
                .refuse(fmt::format("is {}, not {} degrees below the outerAngle of {}",
                                    spec.innerAngle, kMinFalloffAngle, spec.outerAngle));
        break;
    case EmitterShape::Mesh:
        break;
    }
}

std::filesystem::path confined(const JsonReader& reader, const std::filesystem::path& folder,
                               std::vector<AskedFile>* asked)
{
    const std::string name = reader.asText();
    if (!reader.isText())
        return {};
    if (name.empty()) {
        reader.refuse("names no file");
        return {};
    }
    const auto file = resolveInFolder(folder, name, asked);
    if (!file) {
        reader.refuse(file.error().message);
        return {};
    }
    return *file;
}

} // namespace

const char* shapeName(EmitterShape shape)
{
    for (const ShapeMembers& known : shapes())
        if (known.shape == shape)
            return known.type;
    PENUMBRA_ASSERT(false, "shape {}", static_cast<int>(shape));
    return "";
}

const char* unitName(EmissionUnit unit)
{
    return unit == EmissionUnit::Radiance ? "W/(m² sr)"
           : unit == EmissionUnit::Power  ? "W"
                                          : "W/sr";
}

std::optional<LightSpec> readLightSpec(const std::filesystem::path& path, JsonProblems& problems,
                                       std::vector<AskedFile>* asked)
{
    const auto read = [&](const nlohmann::json& document, JsonProblems& found) {
        const JsonReader root(document, "light", found);
        root.checkVersion(1);
        LightSpec spec;
        readEmission(root, spec);
        if (root.has("reach"))
            spec.reach = root.number("reach", kMinEmitterSize, 1000 * kMaxEmitterSize);
        if (root.has("twoSided"))
            spec.twoSided = root.flag("twoSided");
        if (root.has("texture"))
            spec.texture = confined(root.member("texture"), path.parent_path(), asked);
        if (const ShapeMembers* shape = findShape(root)) {
            refuseUnknown(*shape, root);
            spec.shape = shape->shape;
            readShape(root, spec);
            if (spec.shape == EmitterShape::Mesh)
                spec.mesh = confined(root.member("source"), path.parent_path(), asked);
        }
        return spec;
    };
    return readJsonInput<LightSpec>(path, FileType::LightSpec, kMaxSpecBytes, problems, read);
}

} // namespace penumbra
