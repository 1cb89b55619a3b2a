#include "assetc/import/obj.h"

#include "assetc/byte_order_mark.h"
#include "assetc/import/image_library.h"
#include "assetc/import/obj_lines.h"
#include "assetc/import/vertex_key.h"
#include "assetc/words.h"
#include "runtime/file.h"

#include <algorithm>
#include <map>
#include <set>
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
            m_allRead = false;
            return false;
        }
        std::istringstream stream(*text);
        tinyobj::LoadMtl(indexOf, materials, &stream, warning, error);
        return true;
    }

    [[nodiscard]] bool allRead() const { return m_allRead; }

private:
    bool m_allRead = true;
    std::filesystem::path m_folder;
    std::vector<std::string>& m_warnings;
    std::vector<AskedFile>* m_asked; // may be null
};

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
                          &stream, materials, triangulate))
        return Error{"not a readable OBJ file; export it again"}; // the lines are known to be good
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
            return Error{fmt::format("group \"{}\": a face with more than 255 corners; split it",
                                     shape.name)};
        // readObjLines has said of each line that it is good; this is about what the loader made.
        for (const tinyobj::index_t& index : shape.mesh.indices)
            if (index.vertex_index < 0 || index.vertex_index >= vertexCount ||
                index.normal_index < -1 || index.normal_index >= normalCount)
                return Error{fmt::format(
                    "group \"{}\": a corner without a vertex or normal; export it again",
                    shape.name)};
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

// What a file without a face has.
std::string foundText(const ObjLines& lines)
{
    std::string text;
    for (const auto& [number, one, many] : {std::tuple{lines.vertices, "vertex", "vertices"},
                                            {lines.lines, "line", "lines"},
                                            {lines.points, "list of points", "lists of points"},
                                            {lines.surfaces, "curved surface", "curved surfaces"}})
        if (number > 0)
            text += fmt::format("{}{}", text.empty() ? "" : ", ", counted(number, one, many));
    return text.empty() ? "nor anything else of a mesh" : "only " + text;
}

// One warning, of the first.
void warnOfUnknown(const std::map<std::string, std::size_t>& lineOf,
                   const std::vector<tinyobj::material_t>& known,
                   std::vector<std::string>& warnings)
{
    std::set<std::string> names;
    for (const tinyobj::material_t& material : known)
        names.insert(material.name);
    std::size_t unknown = 0, firstLine = 0;
    std::string first;
    for (const auto& [name, line] : lineOf)
        if (!names.contains(name) && (unknown++ == 0 || line < firstLine)) {
            firstLine = line;
            first = name.substr(0, 40);
        }
    if (unknown > 0)
        warnings.push_back(fmt::format(
            "line {}: no material library has \"{}\"{}; its faces get "
            "the default material",
            firstLine, first, unknown > 1 ? fmt::format(", nor {} more", unknown - 1) : ""));
}

} // namespace

Result<ImportedMesh> importObjText(const std::string& text, const std::filesystem::path& folder,
                                   std::vector<AskedFile>* asked)
{
    const auto lines = readObjLines(text);
    if (!lines)
        return lines.error();
    if (lines->faces == 0)
        return Error{fmt::format("no triangles in the file, {}; export its surface as polygons",
                                 foundText(*lines))};
    ImportedMesh out;
    if (lines->openFace > 0)
        out.warnings.push_back(fmt::format("line {} is a face and the last, without a line end: "
                                           "check that the file is not cut off",
                                           lines->openFace));
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
            return Error{"a face could not be triangulated; export it as triangles"};
    }
    if (materials.allRead())
        warnOfUnknown(lines->materialLine, file->materials, out.warnings);
    if (const auto added = addFaces(*file, out.mesh); !added)
        return added.error();
    addMaterials(*file, folder, asked, out);
    return out;
}

} // namespace penumbra
