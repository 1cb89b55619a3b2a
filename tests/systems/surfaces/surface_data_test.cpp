// Which meshes have a surface, and what the receivers and draws of a scene then know.
#include "systems/extract.h"
#include "tests/systems/surfaces/quad.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

SceneData sceneOf(const MeshAsset& mesh, SceneInstance instance = {})
{
    const MeshAsset* const meshes[] = {&mesh};
    instance.material = mesh.material;
    return buildSceneData(meshes, {instance, instance});
}

TEST(SurfaceData, AMeshOfOneColourIsPlain)
{
    MeshAsset mesh = makeQuad();
    mesh.material.albedo = mesh.materials[0].albedo = vec3(0.25f, 0.5f, 1);
    const SceneData scene = sceneOf(mesh);
    EXPECT_TRUE(scene.meshes[0].surface.plain());
    EXPECT_TRUE(scene.surfaces.vertices.empty());
    EXPECT_EQ(rowInput(scene, 1).albedo, vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(scene.firstDraw, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(SurfaceData, ReceiversOfASurfaceAreWhiteAndKeepTheirGloss)
{
    MeshAsset mesh = makeQuad();
    mesh.colors.assign(4, {10, 20, 30, 255});
    mesh.materials[0].emissive = vec3(5);
    mesh.material = {vec3(0.2f), 0.5f, 8};
    const SceneData scene = sceneOf(mesh, {.emission = vec3(1)});
    EXPECT_FALSE(scene.meshes[0].surface.plain());
    EXPECT_EQ(scene.surfaces.vertices.size(), kClusterReceivers); // as many as receivers
    EXPECT_EQ(scene.surfaces.vertices[3].color, 0xff1e140au);
    const InstanceInput input = rowInput(scene, 0);
    EXPECT_EQ(input.albedo, vec3(1));
    EXPECT_EQ(input.glossFraction, 0.5f);
    EXPECT_EQ(input.glossExponent, 8);
    EXPECT_EQ(input.emission, vec3(0)); // added by the rasteriser instead
}

TEST(SurfaceData, AnImageIsKeptOnceHoweverManyUses)
{
    MeshAsset mesh = makeQuad();
    mesh.materials[0].emissive = vec3(1);
    mesh.images.push_back(makePng(1, 1, {{1, 2, 3, 255}}));
    mesh.images.push_back(makePng(1, 1, {{3, 2, 1, 255}})); // of a slot that nobody draws
    mesh.materials[0].textures[kBaseColorTexture] = MeshTexture{.image = 0};
    mesh.materials[0].textures[kEmissiveTexture] = MeshTexture{.image = 0, .wrapS = 33071};
    mesh.materials[0].textures[kNormalTexture] = MeshTexture{.image = 1};
    const SceneData scene = sceneOf(mesh);
    EXPECT_EQ(scene.surfaces.images.size(), 1u);
    EXPECT_EQ(scene.surfaces.textures.size(), 2u);
    EXPECT_EQ(scene.surfaces.parts.size(), 1u);
}

TEST(SurfaceData, ATextureWithoutCoordinatesFallsBack)
{
    MeshAsset mesh = makeQuad();
    mesh.texcoords0.clear();
    setTexture(mesh, kBaseColorTexture, makePng(1, 1, {{1, 2, 3, 255}}));
    EXPECT_EQ(sceneOf(mesh).surfaces.vertices[0].baseColorUv, vec2(0));
}

// An entity without an emitter shows what its mesh sends; a Material takes the place of factors.
TEST(SurfaceData, EntitiesPaintTheirInstances)
{
    AssetStore store;
    MeshAsset mesh = makeQuad();
    mesh.colors.assign(4, {10, 20, 30, 255});
    mesh.materials[0].emissive = vec3(5, 6, 7);
    mesh.materials[0].albedo = vec3(0.5f);
    const AssetHandle asset = store.addMesh(mesh);
    ecs::World world;
    world.create(Transform{}, MeshInstance{asset});
    world.create(Transform{}, MeshInstance{asset}, Material{vec3(0.1f), 0.3f, 9});
    const Result<SceneData> scene = extractScene(world, store);
    ASSERT_TRUE(scene) << scene.error().message;
    for (const SceneInstance& instance : scene->instances) {
        const SurfacePush push = surfacePush(instance, scene->surfaces.parts[0]);
        const bool own = instance.material.glossExponent == 9;
        EXPECT_EQ(push.baseColor, vec3(own ? 0.1f : 0.5f));
        EXPECT_EQ(push.emission, vec3(5, 6, 7));
    }
}

// KHR_texture_transform: a quarter turn counter-clockwise as seen, with v downwards.
TEST(SurfaceData, TransformsScaleThenTurnThenMove)
{
    MeshTexture texture;
    texture.rotation = 1.57079633f;
    texture.scale = vec2(2, 3);
    texture.offset = vec2(10, 20);
    const vec2 uv = transformedUv(texture, vec2(1, 0));
    EXPECT_NEAR(uv.x, 10, 1e-5f);
    EXPECT_NEAR(uv.y, 18, 1e-5f);
}

} // namespace
} // namespace penumbra
