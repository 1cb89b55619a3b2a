#include "assets/glb.h"
#include "demo/content/painted.h"
#include "runtime/file.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedByte = 5121; // glTF's component types

class Writer {
public:
    // The accessor's index.
    template <class T>
    std::size_t add(const std::vector<T>& values, int componentType, const char* type,
                    bool normalized = false)
    {
        const std::size_t view = addView(std::as_bytes(std::span(values)));
        m_document["accessors"].push_back({{"bufferView", view},
                                           {"componentType", componentType},
                                           {"count", values.size()},
                                           {"type", type}});
        if (normalized)
            m_document["accessors"].back()["normalized"] = true;
        return m_document["accessors"].size() - 1;
    }

    std::size_t addView(std::span<const std::byte> bytes)
    {
        m_bin.resize((m_bin.size() + 3) / 4 * 4);
        m_document["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", m_bin.size()}, {"byteLength", bytes.size()}});
        m_bin.insert(m_bin.end(), bytes.begin(), bytes.end());
        return m_document["bufferViews"].size() - 1;
    }

    json& document() { return m_document; }

    Result<std::vector<std::byte>> finish()
    {
        m_document["buffers"] = json::array({{{"byteLength", m_bin.size()}}});
        return writeGlb(m_document.dump(), m_bin);
    }

private:
    json m_document;
    std::vector<std::byte> m_bin;
};

} // namespace

Result<void> writePainted(const std::filesystem::path& path, const PaintedMesh& painted)
{
    const ContentMesh& mesh = painted.mesh;
    Writer out;
    json& document = out.document();
    document["asset"] = {{"version", "2.0"}, {"generator", "penumbra-content"}};
    json primitive{{"indices", out.add(mesh.indices, kUnsignedInt, "SCALAR")}, {"material", 0}};
    json& attributes = primitive["attributes"];
    attributes["POSITION"] = out.add(mesh.positions, kFloat, "VEC3");
    vec3 low = mesh.positions.front(), high = low;
    for (const vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    document["accessors"].back()["min"] = {low.x, low.y, low.z};
    document["accessors"].back()["max"] = {high.x, high.y, high.z};
    attributes["NORMAL"] = out.add(mesh.normals, kFloat, "VEC3");
    if (!painted.texcoords.empty())
        attributes["TEXCOORD_0"] = out.add(painted.texcoords, kFloat, "VEC2");
    if (!painted.colors.empty())
        attributes["COLOR_0"] = out.add(painted.colors, kUnsignedByte, "VEC4", true);
    json material{{"name", mesh.name}};
    material["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    if (painted.picture) {
        const std::size_t view = out.addView(encodePng(*painted.picture));
        document["images"] = json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
        document["textures"] = json::array({{{"source", 0}}});
        material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    }
    document["materials"] = json::array({material});
    document["meshes"] =
        json::array({{{"name", mesh.name}, {"primitives", json::array({primitive})}}});
    document["nodes"] = json::array({{{"name", mesh.name}, {"mesh", 0}}});
    document["scenes"] = json::array({{{"nodes", {0}}}});
    document["scene"] = 0;
    const Result<std::vector<std::byte>> bytes = out.finish();
    return bytes ? writeFile(path, *bytes) : Result<void>(fail(bytes.error(), mesh.name));
}

} // namespace penumbra
