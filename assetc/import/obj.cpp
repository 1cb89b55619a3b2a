#include "assetc/import/obj.h"

#include "assetc/byte_order_mark.h"
#include "assetc/import/image_library.h"
#include "assetc/import/vertex_key.h"
#include "runtime/file.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <tiny_obj_loader.h>
#include <unordered_map>

namespace penumbra {

namespace {

constexpr std::uint64_t kMaxMaterialBytes = 16u << 20;

Result<std::string> readText(const std::filesystem::path& path, std::uint64_t maxBytes)
{
    const auto bytes = readFile(path, maxBytes);
    if (!bytes)
        return bytes.error();
    return std::string(
        withoutByteOrderMark({reinterpret_cast<const char*>(bytes->data()), bytes->size()}));
}

// Reads material libraries inside the folder; another one costs the colours, with a warning, not
// the mesh.
class ConfinedMaterialReader : public tinyobj::MaterialReader {
public:
    ConfinedMaterialReader(std::filesystem::path folder, std::vector<std::string>& warnings,
                           std::vector<AskedFile>* asked)
        : m_folder(std::move(folder)), m_warnings(warnings), m_asked(asked)
    {}

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* indexOf, std::string* warning,
                    std::string* error) override
    {
        const auto path = resolveInFolder(m_folder, name, m_asked);
        const auto text = path ? readText(*path, kMaxMaterialBytes) : path.error();
        if (!text) {
            m_warnings.push_back("material library not read: " + text.error().message);
            return false;
        }
        std::istringstream stream(*text);
        tinyobj::LoadMtl(indexOf, materials, &stream, warning, error);
        return true;
    }

private:
    std::filesystem::path m_folder;
    std::vector<std::string>& m_warnings;
    std::vector<AskedFile>* m_asked; // may be null
};

// An index, or two or three with slashes: "3", "3/1", "3//2", "-1/-1/-1".
bool isCorner(std::string_view word)
{
    for (std::size_t i = 0; i < word.size(); ++i) {
        const bool first = i == 0 || word[i - 1] == '/';
        const bool digit = word[i] >= '0' && word[i] <= '9';
        if (!digit && !(word[i] == '-' && first) && !(word[i] == '/' && i > 0))
            return false;
    }
    return true;
}

bool isFiniteNumber(std::string_view word)
{
    if (word.starts_with('+') && !word.starts_with("+-"))
        word.remove_prefix(1);
    double value = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && last == word.data() + word.size() && std::isfinite(value);
}

// tinyobjloader reads "v 1 a 0" as (1, 0, 0) and skips a face without corners, so a damaged file
// would compile to another mesh. Numbers of vertices and corners of faces are checked here first.
Result<void> checkLines(std::string_view text)
{
    if (text.find('\0') != std::string_view::npos)
        return Error{"a zero byte: not a text file"};
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end);
        text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
        const auto nextWord = [&] {
            line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
            const std::string_view word = line.substr(0, line.find_first_of(" \t"));
            line.remove_prefix(word.size());
            return word;
        };
        const std::string_view keyword = nextWord();
        if (keyword != "v" && keyword != "f")
            continue;
        if (line.ends_with('\\'))
            return Error{fmt::format("line {}: continues on the next, which is not supported; join "
                                     "the two",
                                     number)};
        if (keyword == "v") {
            for (int i = 1; i <= 3; ++i)
                if (const std::string_view word = nextWord(); !isFiniteNumber(word))
                    return Error{fmt::format("line {}: a vertex takes three finite numbers, number "
                                             "{} is \"{}\"",
                                             number, i, word.substr(0, 40))};
            continue;
        }
        int corners = 0;
        for (std::string_view word = nextWord(); !word.empty() && !word.starts_with('#');
             word = nextWord(), ++corners)
            if (!isCorner(word))
                return Error{fmt::format("line {}: corner \"{}\" is not an index", number,
                                         word.substr(0, 40))};
        if (corners < 3)
            return Error{fmt::format("line {}: a face with {} corners; the file may be cut off",
                                     number, corners)};
    }
    return {};
}

struct ObjFile {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
};

Result<ObjFile> parse(const std::string& text, tinyobj::MaterialReader* materials, bool triangulate)
{
    ObjFile file;
    std::istringstream stream(text);
    std::string warning;
    std::string error;
    if (!tinyobj::LoadObj(&file.attributes, &file.shapes, &file.materials, &warning, &error,
                          &stream, materials, triangulate)) {
        while (!error.empty() && (error.back() == '\n' || error.back() == ' '))
            error.pop_back();
        return Error{"not a readable OBJ file: " + error.substr(0, 400)};
    }
    return file;
}

// Sets `allTriangles` where no face needs triangulation.
Result<void> checkIndices(const ObjFile& file, bool& allTriangles)
{
    const auto vertexCount = static_cast<std::int64_t>(file.attributes.vertices.size() / 3);
    const auto normalCount = static_cast<std::int64_t>(file.attributes.normals.size() / 3);
    allTriangles = true;
    for (const tinyobj::shape_t& shape : file.shapes) {
        std::size_t corners = 0;
        for (const std::size_t count : shape.mesh.num_face_vertices) {
            corners += count;
            allTriangles = allTriangles && count == 3;
        }
        if (corners != shape.mesh.indices.size()) // the loader counts corners in 8 bits
            return Error{
                fmt::format("group \"{}\": a face with more than 255 corners", shape.name)};
        for (std::size_t i = 0; i < shape.mesh.indices.size(); ++i) {
            const tinyobj::index_t& index = shape.mesh.indices[i];
            if (index.vertex_index < 0 || index.vertex_index >= vertexCount)
                return Error{fmt::format("group \"{}\": corner {} is vertex {} of {}", shape.name,
                                         i, index.vertex_index + 1, vertexCount)};
            if (index.normal_index < -1 || index.normal_index >= normalCount)
                return Error{fmt::format("group \"{}\": corner {} has normal {} of {}", shape.name,
                                         i, index.normal_index + 1, normalCount)};
        }
    }
    return {};
}

vec3 vectorAt(const std::vector<float>& values, int index)
{
    const std::size_t at = 3 * static_cast<std::size_t>(index);
    return {values[at], values[at + 1], values[at + 2]};
}

// OBJ counts v from the image's bottom, glTF from its top.
vec2 texcoordAt(const std::vector<float>& values, int index)
{
    const std::size_t at = 2 * static_cast<std::size_t>(index);
    const vec2 uv(values[at], 1 - values[at + 1]);
    return abs(uv.x) <= kMaxTextureNumber && abs(uv.y) <= kMaxTextureNumber ? uv : vec2{0};
}

// Corners alike in position, normal and texture coordinates are one vertex; a run of faces of one
// material is a submesh. A texture coordinate that does not exist is (0, 0).
Result<void> addFaces(const ObjFile& file, MeshAsset& mesh)
{
    std::unordered_map<FloatKey<3>, std::uint32_t, FloatKeyHash<3>> vertexOf;
    const auto texcoordCount = static_cast<int>(file.attributes.texcoords.size() / 2);
    const auto materialCount = static_cast<int>(file.materials.size());
    for (const tinyobj::shape_t& shape : file.shapes) {
        if (mesh.indices.size() / 3 + shape.mesh.indices.size() / 3 > kMaxMeshTriangles)
            return Error{
                fmt::format("more than {} triangles; simplify the mesh", kMaxMeshTriangles)};
        for (std::size_t i = 0; i < shape.mesh.indices.size(); ++i) {
            const tinyobj::index_t& index = shape.mesh.indices[i];
            const auto [found, isNew] =
                vertexOf.emplace(FloatKey<3>{{static_cast<std::uint32_t>(index.vertex_index),
                                              static_cast<std::uint32_t>(index.normal_index),
                                              static_cast<std::uint32_t>(index.texcoord_index)}},
                                 static_cast<std::uint32_t>(mesh.positions.size()));
            if (isNew) {
                mesh.positions.push_back(vectorAt(file.attributes.vertices, index.vertex_index));
                mesh.normals.push_back(index.normal_index < 0
                                           ? vec3{0}
                                           : vectorAt(file.attributes.normals, index.normal_index));
                mesh.texcoords0.push_back(
                    index.texcoord_index < 0 || index.texcoord_index >= texcoordCount
                        ? vec2{0}
                        : texcoordAt(file.attributes.texcoords, index.texcoord_index));
            }
            if (i % 3 == 0) {
                const std::size_t face = i / 3;
                const int id =
                    face < shape.mesh.material_ids.size() ? shape.mesh.material_ids[face] : -1;
                const auto material =
                    static_cast<std::uint32_t>(id < 0 || id >= materialCount ? materialCount : id);
                if (mesh.submeshes.empty() || mesh.submeshes.back().material != material)
                    mesh.submeshes.push_back(
                        {static_cast<std::uint32_t>(mesh.indices.size()), 0, 0, 0, material});
                mesh.submeshes.back().indexCount += 3;
            }
            mesh.indices.push_back(found->second);
        }
    }
    return {};
}

// Kd, d and map_Kd of every material, and one more for faces without.
void addMaterials(const ObjFile& file, const std::filesystem::path& folder,
                  std::vector<AskedFile>* asked, ImportedMesh& out)
{
    ImageLibrary library;
    for (const tinyobj::material_t& source : file.materials) {
        SurfaceMaterial material;
        material.name = source.name.substr(0, kMaxNameBytes);
        const auto unit = [](double value) { return value > 0 ? std::min(value, 1.0) : 0.0; };
        for (int c = 0; c < 3; ++c)
            material.albedo[c] = static_cast<float>(unit(source.diffuse[c]));
        material.alpha = static_cast<float>(unit(source.dissolve));
        material.alphaMode = material.alpha < 1 ? AlphaMode::Blend : AlphaMode::Opaque;
        if (!source.diffuse_texname.empty()) {
            const auto path = resolveInFolder(folder, source.diffuse_texname, asked);
            auto bytes = path ? readFile(*path, kMaxImageBytes) : path.error();
            const auto image = bytes ? library.add(std::move(*bytes)) : bytes.error();
            if (image)
                material.textures[kBaseColorTexture] = MeshTexture{.image = *image};
            else
                out.warnings.push_back(fmt::format("map_Kd of material \"{}\": {}; left out",
                                                   material.name, image.error().message));
        }
        out.mesh.materials.push_back(material);
    }
    out.mesh.materials.push_back({});
    out.mesh.images = library.take();
    out.mesh.material = out.mesh.materials[largestMaterial(out.mesh)];
}

} // namespace

Result<ImportedMesh> importObjText(const std::string& text, const std::filesystem::path& folder,
                                   std::vector<AskedFile>* asked)
{
    if (const auto lines = checkLines(text); !lines)
        return lines.error();
    ImportedMesh out;
    ConfinedMaterialReader materials(folder, out.warnings, asked);
    auto file = parse(text, &materials, false);
    if (!file)
        return file.error();
    bool allTriangles = true;
    if (const auto checked = checkIndices(*file, allTriangles); !checked)
        return checked.error();
    if (!allTriangles) {
        // The loader's triangulation reads vertices unchecked, so it runs on a file whose indices
        // are known to be good.
        std::vector<std::string> repeated;
        ConfinedMaterialReader again(folder, repeated, nullptr);
        file = parse(text, &again, true);
        if (!file)
            return file.error();
        if (const auto checked = checkIndices(*file, allTriangles); !checked)
            return checked.error();
        if (!allTriangles)
            return Error{"a face could not be triangulated"};
    }
    if (const auto added = addFaces(*file, out.mesh); !added)
        return added.error();
    addMaterials(*file, folder, asked, out);
    return out;
}

} // namespace penumbra
