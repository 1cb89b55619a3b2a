#include "assetc/scene_file.h"

#include "assetc/import/folder.h"
#include "assetc/json_input.h"
#include "assets/light_json.h"
#include "assets/mesh_codec.h"
#include "assets/shadow_field.h"
#include "runtime/ecs/scene_file.h"
#include "runtime/file.h"

#include <limits>

namespace penumbra {

namespace {

constexpr std::uint64_t kSceneVersion = 1;
using ecs::kMaxSceneBytes; // the same bounds as the reader of the runtime
constexpr std::size_t kMaxEntities = ecs::kMaxSceneEntities;

template <std::size_t Count>
std::array<float, Count> numbers(const JsonReader& array, float max)
{
    std::array<float, Count> values{};
    if (array.length(Count) != Count)
        array.refuse(fmt::format("does not have {} numbers", Count));
    else
        for (std::size_t i = 0; i < Count; ++i)
            values[i] = array.element(i).asNumber(-max, max);
    return values;
}

void checkTransform(const JsonReader& transform)
{
    transform.refuseOthers({"position", "rotation", "scale"});
    static_cast<void>(numbers<3>(transform.member("position"), kMaxCoordinate));
    float norm = 0;
    for (const float q : numbers<4>(transform.member("rotation"), 1.001f))
        norm += q * q;
    if (transform.has("rotation") && std::abs(norm - 1) > 0.01f)
        transform.member("rotation").refuse("is no unit quaternion");
    static_cast<void>(transform.number("scale", std::numeric_limits<float>::min(), kMaxCoordinate));
}

// The file of a part is whole.
void checkPart(const JsonReader& asset, const std::string& name, const std::filesystem::path& file)
{
    const auto bytes = readFile(file, kMaxMeshAssetBytes);
    if (!bytes) {
        asset.refuse("names a file that cannot be used: " + bytes.error().message);
        return;
    }
    if (const RecognisedFile part = recogniseFile(*bytes, file); part.type != FileType::MeshAsset) {
        asset.refuse(
            fmt::format("names \"{}\", which is no compiled mesh: {}", name, fileTypeText(part)));
        return;
    }
    for (const Error& problem : checkMeshAsset(*bytes))
        asset.refuse(fmt::format("names \"{}\", which is damaged: {}", name, problem.message));
}

void readAsset(const JsonReader& component, const std::filesystem::path& folder, SceneFile& scene)
{
    component.refuseOthers({"asset"});
    const JsonReader asset = component.member("asset");
    const std::string name = asset.asText();
    if (!asset.isText() || !scene.assets.insert(name).second)
        return;
    if (name.empty())
        asset.refuse("is empty; name a compiled mesh beside the scene");
    else if (const auto found = resolveInFolder(folder, name); !found)
        asset.refuse("names a file that cannot be used: " + found.error().message);
    else
        checkPart(asset, name, *found);
}

void readEntity(const JsonReader& entity, std::size_t index, const std::filesystem::path& folder,
                SceneFile& scene)
{
    if (entity.has("Name"))
        static_cast<void>(entity.member("Name").text("value"));
    if (entity.has("Parent")) {
        const JsonReader parent = entity.member("Parent");
        if (parent.count("entity", kMaxEntities) >= index)
            parent.member("entity").refuse("is no earlier entity");
    }
    if (const JsonReader transform = entity.member("Transform"); entity.has("Transform"))
        checkTransform(transform);
    if (entity.has("MeshInstance")) {
        ++scene.meshes;
        readAsset(entity.member("MeshInstance"), folder, scene);
    }
    if (entity.has("ShadowFieldOccluder")) {
        ++scene.occluders;
        readAsset(entity.member("ShadowFieldOccluder"), folder, scene);
    }
}

} // namespace

std::optional<SceneFile> readSceneFile(const std::filesystem::path& file, JsonProblems& problems)
{
    const auto read = [&](const nlohmann::json& document, JsonProblems& found) {
        const JsonReader root(document, "", found);
        root.checkVersion(kSceneVersion);
        SceneFile scene;
        const JsonReader entities = root.member("entities");
        scene.entities = entities.length(kMaxEntities);
        for (std::size_t i = 0; i < scene.entities; ++i)
            readEntity(entities.element(i), i, file.parent_path(), scene);
        if (!root.has("lights"))
            return scene;
        const JsonReader lights = root.member("lights");
        scene.lights = lights.length(kMaxEntities);
        for (std::size_t i = 0; i < scene.lights; ++i) {
            const JsonReader light = lights.element(i);
            static_cast<void>(readLight(light));
            if (light.count("entity", kMaxEntities) >= scene.entities)
                light.member("entity").refuse(
                    fmt::format("is none of the {} entities", scene.entities));
        }
        return scene;
    };
    return readJsonInput<SceneFile>(file, FileType::Scene, kMaxSceneBytes, problems, read);
}

} // namespace penumbra
