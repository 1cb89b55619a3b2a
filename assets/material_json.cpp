#include "assets/material_json.h"

#include "assets/checksum.h"
#include "assets/mesh_format.h"

#include <algorithm>
#include <limits>

namespace penumbra {

namespace {

using nlohmann::json;

constexpr const char* kTransformExtension = "KHR_texture_transform";
constexpr const char* kStrengthExtension = "KHR_materials_emissive_strength";
constexpr std::array<const char*, 3> kAlphaModes = {"OPAQUE", "MASK", "BLEND"};

// Where a slot's texture stands: in pbrMetallicRoughness or in the material.
struct Slot {
    const char* name;
    bool inMetallicRoughness;
};
constexpr std::array<Slot, kTextureSlots> kSlots = {Slot{"baseColorTexture", true},
                                                    {"metallicRoughnessTexture", true},
                                                    {"normalTexture", false},
                                                    {"occlusionTexture", false},
                                                    {"emissiveTexture", false}};

class MaterialReader {
public:
    MaterialReader(const JsonReader& root, MaterialReading& reading)
        : m_root(root), m_reading(reading)
    {}

    SurfaceMaterial read(const JsonReader& source, const std::string& place)
    {
        SurfaceMaterial material;
        material.metallic = 1; // glTF's defaults, which a missing member means
        material.albedo = vec3{1};
        if (source.has("name"))
            material.name = source.text("name").substr(0, kMaxName);
        if (source.has("pbrMetallicRoughness")) {
            const JsonReader pbr = source.member("pbrMetallicRoughness");
            if (pbr.has("baseColorFactor")) {
                const JsonReader base = pbr.member("baseColorFactor");
                for (int c = 0; c < 3; ++c)
                    material.albedo[c] = unit(base.element(static_cast<std::size_t>(c)));
                material.alpha = unit(base.element(3));
            }
            setUnit(pbr, "metallicFactor", material.metallic);
            setUnit(pbr, "roughnessFactor", material.roughness);
        }
        if (source.has("emissiveFactor"))
            for (int c = 0; c < 3; ++c)
                material.emissive[c] =
                    unit(source.member("emissiveFactor").element(static_cast<std::size_t>(c)));
        if (source.has("alphaMode")) {
            const std::string mode = source.text("alphaMode");
            const auto found = std::find(kAlphaModes.begin(), kAlphaModes.end(), mode);
            if (found == kAlphaModes.end())
                source.refuse(fmt::format("has alphaMode \"{}\"", mode));
            else
                material.alphaMode = static_cast<AlphaMode>(found - kAlphaModes.begin());
        }
        if (source.has("alphaCutoff"))
            material.alphaCutoff = source.number("alphaCutoff", 0, kMaxTextureNumber);
        material.doubleSided = source.has("doubleSided") && source.flag("doubleSided");
        readExtensions(optionalObject(source, "extensions"), material);
        for (std::size_t slot = 0; slot < kSlots.size(); ++slot)
            readSlot(source, kSlots[slot], place, material, slot);
        return material;
    }

private:
    static constexpr std::size_t kMaxName = 256;

    // A factor from 0 to 1.
    [[nodiscard]] float unit(const JsonReader& value) const
    {
        if (!m_reading.lenient)
            return value.asNumber(0, 1);
        constexpr float kAny = std::numeric_limits<float>::max();
        return clamp(value.asNumber(-kAny, kAny), 0.0f, 1.0f);
    }

    static void readExtensions(const JsonReader& extensions, SurfaceMaterial& material)
    {
        if (extensions.has(kStrengthExtension) &&
            extensions.member(kStrengthExtension).has("emissiveStrength"))
            material.emissive *=
                extensions.member(kStrengthExtension).number("emissiveStrength", 0, kMaxEmissive);
        if (!extensions.has(kFieldExtension))
            return;
        const JsonReader ours = extensions.member(kFieldExtension);
        if (ours.has("glossFraction")) {
            material.glossFraction = ours.number("glossFraction", 0, 1);
            material.glossExponent = ours.number("glossExponent", 0, kMaxGlossExponent);
        }
        if (ours.has("emissionCone")) {
            const JsonReader cone = ours.member("emissionCone");
            material.emissionCone.x = cone.element(0).asNumber(0, kMaxEmissionAngle);
            material.emissionCone.y = cone.element(1).asNumber(0, kMaxEmissionAngle);
        }
    }

    void setUnit(const JsonReader& object, const char* key, float& value) const
    {
        if (object.has(key))
            value = unit(object.member(key));
    }

    // A member that may be missing or of another type, which then has no members.
    [[nodiscard]] static JsonReader optionalObject(const JsonReader& object, const char* key)
    {
        return object.has(key) ? object.member(key) : object.missing();
    }

    void leaveOut(const JsonReader& place, const std::string& text, const std::string& why)
    {
        if (m_reading.lenient)
            m_reading.warnings.push_back(text + ": " + why + "; the texture is left out");
        else
            place.refuse(why);
    }

    void readSlot(const JsonReader& source, const Slot& slot, const std::string& place,
                  SurfaceMaterial& material, std::size_t index)
    {
        const JsonReader parent =
            slot.inMetallicRoughness ? optionalObject(source, "pbrMetallicRoughness") : source;
        if (!parent.has(slot.name))
            return;
        const JsonReader info = parent.member(slot.name);
        const std::string text = fmt::format("{}.{}", place, slot.name);
        if (info.has("scale"))
            material.normalScale = info.number("scale", -kMaxTextureNumber, kMaxTextureNumber);
        if (info.has("strength"))
            material.occlusionStrength = unit(info.member("strength"));
        MeshTexture use;
        if (info.has("texCoord"))
            use.texcoord = static_cast<std::uint32_t>(info.count("texCoord", 1000));
        if (const JsonReader extensions = optionalObject(info, "extensions");
            extensions.has(kTransformExtension))
            readTransform(extensions.member(kTransformExtension), use);
        if (use.texcoord > 1)
            return leaveOut(
                info, text,
                fmt::format("uses texture coordinates {}, kept are 0 and 1", use.texcoord));
        const JsonReader textures = m_root.member("textures");
        const JsonReader texture = textures.element(info.count("index", kMaxGltfElements));
        if (texture.has("sampler"))
            readSampler(
                m_root.member("samplers").element(texture.count("sampler", kMaxGltfElements)), use);
        if (!texture.has("source"))
            return leaveOut(texture, text, "has no PNG or JPEG image");
        const std::uint64_t image = texture.count("source", kMaxGltfElements);
        static_cast<void>(m_root.member("images").element(image)); // a problem where missing
        use.image = static_cast<std::uint32_t>(image);
        material.textures[index] = use;
    }

    static void readTransform(const JsonReader& transform, MeshTexture& use)
    {
        const auto number = [](const JsonReader& value) {
            return value.asNumber(-kMaxTextureNumber, kMaxTextureNumber);
        };
        for (const auto& [key, target] : {std::pair{"offset", &use.offset}, {"scale", &use.scale}})
            if (transform.has(key))
                *target = {number(transform.member(key).element(0)),
                           number(transform.member(key).element(1))};
        if (transform.has("rotation"))
            use.rotation = number(transform.member("rotation"));
        if (transform.has("texCoord"))
            use.texcoord = static_cast<std::uint32_t>(transform.count("texCoord", 1000));
    }

    static void readSampler(const JsonReader& sampler, MeshTexture& use)
    {
        const auto read = [&](const char* key, std::uint32_t& value,
                              std::initializer_list<std::uint32_t> allowed) {
            if (!sampler.has(key))
                return;
            value = static_cast<std::uint32_t>(sampler.count(key, 65535));
            if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
                sampler.refuse(fmt::format("has {} {}, which glTF does not know", key, value));
        };
        read("wrapS", use.wrapS, {10497, 33071, 33648});
        read("wrapT", use.wrapT, {10497, 33071, 33648});
        read("magFilter", use.magFilter, {9728, 9729});
        read("minFilter", use.minFilter, {9728, 9729, 9984, 9985, 9986, 9987});
    }

    const JsonReader& m_root;
    MaterialReading& m_reading;
};

// Index in `array` of an element equal to `value`, added where there is none.
std::size_t indexOf(json& array, const json& value)
{
    const auto found = std::find(array.begin(), array.end(), value);
    if (found != array.end())
        return static_cast<std::size_t>(found - array.begin());
    array.push_back(value);
    return array.size() - 1;
}

json textureJson(const MeshTexture& use, GltfWriter& out)
{
    json sampler = {{"wrapS", use.wrapS}, {"wrapT", use.wrapT}};
    if (use.magFilter != 0)
        sampler["magFilter"] = use.magFilter;
    if (use.minFilter != 0)
        sampler["minFilter"] = use.minFilter;
    const json texture = {{"source", use.image},
                          {"sampler", indexOf(out.document["samplers"], sampler)}};
    json info = {{"index", indexOf(out.document["textures"], texture)}};
    if (use.texcoord != 0)
        info["texCoord"] = use.texcoord;
    if (use.offset != vec2{0} || use.scale != vec2{1} || use.rotation != 0) {
        out.useExtension(kTransformExtension);
        info["extensions"][kTransformExtension] = {{"offset", {use.offset.x, use.offset.y}},
                                                   {"scale", {use.scale.x, use.scale.y}},
                                                   {"rotation", use.rotation}};
    }
    return info;
}

json materialJson(const SurfaceMaterial& material, GltfWriter& out)
{
    json result = {{"pbrMetallicRoughness",
                    {{"baseColorFactor",
                      {material.albedo.r, material.albedo.g, material.albedo.b, material.alpha}},
                     {"metallicFactor", material.metallic},
                     {"roughnessFactor", material.roughness}}}};
    if (!material.name.empty())
        result["name"] = material.name;
    if (material.emissive != vec3{0}) {
        const float strength =
            std::max({1.0f, material.emissive.r, material.emissive.g, material.emissive.b});
        const vec3 factor = material.emissive / strength;
        result["emissiveFactor"] = {factor.r, factor.g, factor.b};
        if (strength > 1) {
            out.useExtension(kStrengthExtension);
            result["extensions"][kStrengthExtension] = {{"emissiveStrength", strength}};
        }
    }
    if (material.alphaMode != AlphaMode::Opaque)
        result["alphaMode"] = kAlphaModes[static_cast<std::size_t>(material.alphaMode)];
    if (material.alphaMode == AlphaMode::Mask)
        result["alphaCutoff"] = material.alphaCutoff;
    if (material.doubleSided)
        result["doubleSided"] = true;
    if (material.glossFraction > 0)
        result["extensions"][kFieldExtension] = {{"glossFraction", material.glossFraction},
                                                 {"glossExponent", material.glossExponent}};
    if (material.emissionCone.y > 0)
        result["extensions"][kFieldExtension]["emissionCone"] = {material.emissionCone.x,
                                                                 material.emissionCone.y};
    for (std::size_t slot = 0; slot < kSlots.size(); ++slot) {
        if (!material.textures[slot])
            continue;
        json info = textureJson(*material.textures[slot], out);
        if (slot == kNormalTexture)
            info["scale"] = material.normalScale;
        if (slot == kOcclusionTexture)
            info["strength"] = material.occlusionStrength;
        (kSlots[slot].inMetallicRoughness ? result["pbrMetallicRoughness"]
                                          : result)[kSlots[slot].name] = info;
    }
    return result;
}

} // namespace

std::string imageChecksum(const std::vector<MeshImage>& images)
{
    std::vector<std::byte> all;
    for (const MeshImage& image : images)
        all.insert(all.end(), image.bytes.begin(), image.bytes.end());
    return checksumText(all);
}

const char* imageMimeType(ImageType type)
{
    return type == ImageType::Png ? "image/png" : "image/jpeg";
}

std::vector<SurfaceMaterial> readMaterials(const JsonReader& root, MaterialReading& reading,
                                           JsonProblems& problems)
{
    std::vector<SurfaceMaterial> materials;
    if (!root.has("materials"))
        return materials;
    MaterialReader reader(root, reading);
    const JsonReader sources = root.member("materials");
    const std::size_t count =
        sources.length(reading.lenient ? kMaxGltfElements : kMaxMeshMaterials);
    for (std::size_t i = 0; i < count && problems.size() < 100; ++i)
        materials.push_back(reader.read(sources.element(i), fmt::format("materials[{}]", i)));
    return materials;
}

void writeMaterials(const std::vector<SurfaceMaterial>& materials,
                    const std::vector<MeshImage>& images, GltfWriter& out)
{
    for (const SurfaceMaterial& material : materials)
        out.document["materials"].push_back(materialJson(material, out));
    for (const MeshImage& image : images) {
        const std::size_t view = out.addView(image.bytes);
        out.document["images"].push_back(
            {{"bufferView", view}, {"mimeType", imageMimeType(image.type)}});
    }
}

std::vector<MeshImage> readImages(const JsonReader& root, std::span<const std::byte> bin)
{
    std::vector<MeshImage> images;
    if (!root.has("images"))
        return images;
    const JsonReader sources = root.member("images");
    const std::size_t count = sources.length(kMaxMeshImages);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const JsonReader source = sources.element(i);
        const auto bytes = readView(root, source.count("bufferView", kMaxGltfElements), bin);
        sum += bytes.size();
        if (bytes.size() > kMaxImageBytes || sum > kMaxImagesBytes) { // views may overlap
            source.refuse(fmt::format("has {} bytes, allowed are {}, and {} in all", bytes.size(),
                                      kMaxImageBytes, kMaxImagesBytes));
            return images;
        }
        MeshImage image{ImageType::Png, {bytes.begin(), bytes.end()}};
        const std::optional<ImageType> type = imageType(image.bytes);
        if (!type || source.text("mimeType") != imageMimeType(*type))
            source.refuse("is not the PNG or JPEG that its mimeType says");
        image.type = type.value_or(ImageType::Png);
        images.push_back(std::move(image));
    }
    return images;
}

} // namespace penumbra
