// Textures, vertex colours and materials from asset to picture: a square that fills the picture,
// its receivers at a given radiance, so that each pixel is known.
#include "runtime/vk/transfer.h"
#include "systems/frame.h"
#include "tests/support/gpu_fixture.h"
#include "tests/systems/surfaces/quad.h"

#include <glm/gtc/packing.hpp>
#include <optional>

namespace penumbra {
namespace {

constexpr std::uint32_t kSide = 64;

float linear(int srgb)
{
    return linearFromSrgb(static_cast<float>(srgb) / 255);
}

class RasterSurface : public GpuTest {
protected:
    Result<GpuScene> makeScene(const MeshAsset& mesh, const SceneInstance& instance)
    {
        const MeshAsset* const meshes[] = {&mesh};
        return GpuScene::create(device(), buildSceneData(meshes, {instance}),
                                makeEnvironment(8, 4, std::vector<vec3>(32, vec3(0))), 2);
    }

    // Pixels of the square; `zoom` 0.5: it covers the middle quarter of the picture.
    std::vector<vec3> draw(const MeshAsset& mesh, const SceneInstance& instance = {},
                           vec3 radiance = vec3(1), bool surfaces = true, float zoom = 1)
    {
        GpuScene scene = take(makeScene(mesh, instance));
        if (!m_passes)
            m_passes = take(createFramePasses(device(), {}));
        const FramePasses& passes = *m_passes;
        FrameTargets targets = take(createFrameTargets(device(), passes, {kSide, kSide}));
        const std::vector<vec4> receivers(scene.data().radianceCount, vec4(radiance, 1));
        take(upload(device(), scene.buffers().radiance, std::as_bytes(std::span(receivers))));
        View view;
        view.eye = vec3(0, 0, 10);
        view.clipFromWorld = mat4(zoom, 0, 0, 0, 0, zoom, 0, 0, 0, 0, -0.25f, 0, 0, 0, 0.5f, 1);
        FrameRing ring(device());
        const GpuFrame frame = take(ring.beginFrame());
        recordFrame(frame, passes, scene, frameConstants(view, LightSh{}, 0),
                    {Kernel::Exact, false, 1, surfaces}, targets);
        take(ring.endFrame());
        take(ring.waitIdle());
        const std::vector<std::byte> bytes =
            take(readBack(device(), targets.radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
        std::vector<std::uint64_t> halves(bytes.size() / 8);
        std::memcpy(halves.data(), bytes.data(), bytes.size());
        std::vector<vec3> pixels;
        for (const std::uint64_t half : halves)
            pixels.push_back(vec3(glm::unpackHalf4x16(half)));
        return pixels;
    }

    // At parts of the picture's width and height, from the upper left.
    static vec3 at(const std::vector<vec3>& pixels, float x, float y)
    {
        return pixels[static_cast<std::size_t>(y * kSide) * kSide +
                      static_cast<std::size_t>(x * kSide)];
    }

    static void expectColor(vec3 actual, vec3 expected, float tolerance = 0.002f)
    {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(actual[c], expected[c], tolerance) << "channel " << c;
    }

    void TearDown() override
    {
        m_passes.reset();
        GpuTest::TearDown();
    }

private:
    std::optional<FramePasses> m_passes;
};

const std::vector<std::array<std::uint8_t, 4>> kFour = {
    {255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {128, 188, 64, 255}};

TEST_F(RasterSurface, ATextureLiesUprightAndIsMadeLinear)
{
    MeshAsset mesh = makeQuad();
    setTexture(mesh, kBaseColorTexture, makePng(2, 8, kFour));
    const std::vector<vec3> pixels = draw(mesh);
    expectColor(at(pixels, 0.25f, 0.25f), vec3(1, 0, 0));
    expectColor(at(pixels, 0.75f, 0.25f), vec3(0, 1, 0));
    expectColor(at(pixels, 0.25f, 0.75f), vec3(0, 0, 1));
    expectColor(at(pixels, 0.75f, 0.75f), vec3(linear(128), linear(188), linear(64)));
}

TEST_F(RasterSurface, RadianceTextureFactorAndVertexColourMultiply)
{
    MeshAsset mesh = makeQuad();
    setTexture(mesh, kBaseColorTexture, makePng(1, 4, {{188, 188, 188, 255}}));
    mesh.materials[0].albedo = vec3(0.5f, 1, 0.25f);
    mesh.colors.assign(4, {255, 128, 51, 255});
    const float texture = linear(188);
    expectColor(at(draw(mesh, {}, vec3(2, 1, 4)), 0.5f, 0.5f),
                texture * vec3(2 * 0.5f, 128.0f / 255, 4 * 0.25f * 51 / 255), 0.003f);
}

TEST_F(RasterSurface, VertexColoursAreLinearAndBlend)
{
    MeshAsset mesh = makeQuad();
    mesh.colors = {{0, 0, 0, 255}, {255, 0, 0, 255}, {255, 255, 0, 255}, {0, 255, 0, 255}};
    const std::vector<vec3> pixels = draw(mesh);
    for (const float x : {0.1f, 0.5f, 0.9f})
        for (const float y : {0.2f, 0.7f}) {
            const vec2 middle = (glm::floor(vec2(x, y) * float(kSide)) + 0.5f) / float(kSide);
            expectColor(at(pixels, x, y), vec3(middle.x, 1 - middle.y, 0), 0.003f);
        }
}

TEST_F(RasterSurface, EmissionIsAddedByTextureFactorAndIntensity)
{
    MeshAsset mesh = makeQuad();
    setTexture(mesh, kEmissiveTexture, makePng(2, 8, kFour));
    mesh.materials[0].emissive = vec3(3, 2, 1);
    mesh.materials[0].albedo = vec3(0.25f);
    const std::vector<vec3> pixels = draw(mesh, {.emission = vec3(0.5f, 1, 2)}, vec3(1));
    expectColor(at(pixels, 0.25f, 0.25f), vec3(1.75f, 0.25f, 0.25f));
    expectColor(at(pixels, 0.75f, 0.25f), vec3(0.25f, 2.25f, 0.25f));
    expectColor(at(pixels, 0.25f, 0.75f), vec3(0.25f, 0.25f, 2.25f));
    expectColor(at(draw(mesh, {}, vec3(1)), 0.25f, 0.25f), vec3(0.25f)); // turned off
}

// Two halves of one mesh, the left red, the right green with a texture.
MeshAsset makeTwoMaterials()
{
    MeshAsset mesh = makeQuad();
    const MeshAsset half = mesh;
    for (vec3& p : mesh.positions)
        p.x = p.x * 0.5f - 0.5f;
    for (std::uint32_t v = 0; v < 4; ++v) {
        mesh.positions.push_back(half.positions[v] * vec3(0.5f, 1, 1) + vec3(0.5f, 0, 0));
        mesh.normals.push_back(half.normals[v]);
        mesh.texcoords0.push_back(half.texcoords0[v]);
        mesh.selfVisibility.push_back(half.selfVisibility[v]);
    }
    for (std::uint32_t i = 0; i < 6; ++i)
        mesh.indices.push_back(half.indices[i] + 4);
    mesh.materials.emplace_back();
    mesh.materials[0].albedo = vec3(0.8f, 0.1f, 0.1f);
    mesh.materials[1].albedo = vec3(0.1f, 0.8f, 0.1f);
    mesh.materials[1].textures[kBaseColorTexture] = MeshTexture{.image = 0};
    mesh.images.push_back(makePng(1, 4, {{188, 188, 188, 255}}));
    mesh.submeshes = {{0, 6, 0, 4, 0}, {6, 6, 4, 4, 1}};
    updateDerived(mesh);
    return mesh;
}

TEST_F(RasterSurface, EachMaterialHasItsColour)
{
    const MeshAsset mesh = makeTwoMaterials();
    take(validateMesh(mesh));
    const std::vector<vec3> pixels = draw(mesh);
    expectColor(at(pixels, 0.25f, 0.5f), vec3(0.8f, 0.1f, 0.1f));
    expectColor(at(pixels, 0.75f, 0.5f), linear(188) * vec3(0.1f, 0.8f, 0.1f));
}

TEST_F(RasterSurface, AMaterialOfTheEntityReplacesFactorsAndKeepsTextures)
{
    SceneInstance instance;
    instance.material.albedo = vec3(0.2f, 0.3f, 0.4f);
    instance.repainted = true;
    const std::vector<vec3> pixels = draw(makeTwoMaterials(), instance);
    expectColor(at(pixels, 0.25f, 0.5f), vec3(0.2f, 0.3f, 0.4f));
    expectColor(at(pixels, 0.75f, 0.5f), linear(188) * vec3(0.2f, 0.3f, 0.4f));
}

TEST_F(RasterSurface, WithoutSurfacesThePictureIsTheRadiance)
{
    const std::vector<vec3> pixels = draw(makeTwoMaterials(), {}, vec3(0.5f, 0.25f, 2), false);
    expectColor(at(pixels, 0.25f, 0.5f), vec3(0.5f, 0.25f, 2));
    expectColor(at(pixels, 0.75f, 0.5f), vec3(0.5f, 0.25f, 2));
}

TEST_F(RasterSurface, SamplersWrapAsGltfSays)
{
    MeshAsset mesh = makeQuad();
    for (vec2& uv : mesh.texcoords0)
        uv *= 2.0f; // the picture is the upper left quarter
    setTexture(mesh, kBaseColorTexture, makePng(2, 8, kFour));
    MeshTexture& texture = *mesh.materials[0].textures[kBaseColorTexture];
    expectColor(at(draw(mesh), 0.625f, 0.125f), vec3(1, 0, 0)); // repeats
    texture.wrapS = 33648;
    expectColor(at(draw(mesh), 0.625f, 0.125f), vec3(0, 1, 0)); // mirrors
    texture.wrapS = 33071;
    expectColor(at(draw(mesh), 0.95f, 0.125f), vec3(0, 1, 0)); // its last column
    texture.wrapS = 10497;
    texture.scale = vec2(0.5f); // KHR_texture_transform brings it back
    texture.offset = vec2(0.5f, 0);
    const std::vector<vec3> moved = draw(mesh);
    expectColor(at(moved, 0.25f, 0.25f), vec3(0, 1, 0));
    expectColor(at(moved, 0.75f, 0.25f), vec3(1, 0, 0));
}

// Columns of black and white, one pixel each, 16 to a pixel of the picture.
TEST_F(RasterSurface, AFarTextureShowsItsMeanLight)
{
    MeshAsset mesh = makeQuad();
    setTexture(mesh, kBaseColorTexture, makePng(2, 1, {{0, 0, 0, 255}, {255, 255, 255, 255}}));
    for (vec2& uv : mesh.texcoords0)
        uv *= 512.0f;
    expectColor(at(draw(mesh), 0.4f, 0.6f), vec3(0.5f), 0.01f);
    mesh.materials[0].textures[kBaseColorTexture]->minFilter = 9728; // no mipmaps: one or the other
    const float value = at(draw(mesh), 0.4f, 0.6f).x;
    EXPECT_TRUE(value == 0 || value == 1) << value;
}

TEST_F(RasterSurface, AMaskCutsOut)
{
    MeshAsset mesh = makeQuad();
    setTexture(mesh, kBaseColorTexture, makePng(2, 8, {{255, 255, 255, 255}, {255, 255, 255, 0}}));
    mesh.materials[0].alphaMode = AlphaMode::Mask;
    const std::vector<vec3> pixels = draw(mesh);
    expectColor(at(pixels, 0.25f, 0.5f), vec3(1));
    expectColor(at(pixels, 0.75f, 0.5f), vec3(0)); // the background
}

// All draws of the mesh are dropped and kept with it.
TEST_F(RasterSurface, AMeshOutOfSightIsNotDrawn)
{
    const SceneInstance away{.position = vec3(50, 0, 0)};
    for (const vec3& pixel : draw(makeTwoMaterials(), away))
        ASSERT_EQ(pixel, vec3(0));
}

TEST_F(RasterSurface, DamagedTexturesAreRefusedByName)
{
    MeshAsset mesh = makeQuad();
    setTexture(mesh, kBaseColorTexture, makePng(2, 8, kFour));
    mesh.images[0].bytes.resize(mesh.images[0].bytes.size() / 2);
    const Result<GpuScene> cut = makeScene(mesh, {});
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().message.find("image 0 of 'quad'"), std::string::npos)
        << cut.error().message;
    EXPECT_NE(cut.error().message.find("export it again"), std::string::npos);
}

} // namespace
} // namespace penumbra
