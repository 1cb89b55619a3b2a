#include "demo/editor/editor.h"
#include "demo/editor/field_widget.h"
#include "runtime/ecs/reflection.h"
#include "systems/scene_components.h"

#include <gtest/gtest.h>
#include <imgui.h>

namespace penumbra {
namespace {

enum class Shape : std::uint8_t { Disc, Square };
constexpr std::string_view kShapes[] = {"disc", "square"};

struct Everything {
    static constexpr std::string_view kName = "Everything";
    float power = 40;
    double mass = 1;
    std::int32_t steps = -3;
    std::uint8_t count = 7;
    bool lit = false;
    vec3 place{1, 2, 3};
    vec3 albedo{0.5f};
    vec4 rotation{0, 0, 0, 1};
    Shape shape = Shape::Disc;
    char text[16] = "abc";
    ecs::Entity target;
    std::uint64_t body = 5;
};

} // namespace

template <>
inline constexpr auto ecs::kFields<Everything> = ecs::fields(
    PENUMBRA_FIELD(Everything, power, .unit = "W", .min = 0, .max = 100),
    PENUMBRA_FIELD(Everything, mass), PENUMBRA_FIELD(Everything, steps),
    PENUMBRA_FIELD(Everything, count), PENUMBRA_FIELD(Everything, lit),
    PENUMBRA_FIELD(Everything, place, .unit = "m"),
    PENUMBRA_FIELD(Everything, albedo, .min = 0, .max = 1),
    PENUMBRA_FIELD(Everything, rotation, .type = ecs::FieldType::rotation),
    PENUMBRA_FIELD(Everything, shape, .names = kShapes), PENUMBRA_FIELD(Everything, text),
    PENUMBRA_FIELD(Everything, target), PENUMBRA_FIELD(Everything, body, .kind = "body"));

namespace {

// ImGui without a window: frames of 1/60 s, a mouse that the test moves.
class Panel : public testing::Test {
protected:
    Panel()
    {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {800, 600};
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    ~Panel() override { ImGui::DestroyContext(); }

    template <class Draw>
    void frame(Draw&& draw, float seconds = 1.0f / 60)
    {
        ImGui::GetIO().DeltaTime = seconds;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({780, 580});
        ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoMove);
        draw();
        ImGui::End();
        ImGui::Render();
    }

    // Presses at the middle left part of the widget, drags by `pixels` and lets go. The number of
    // frames in which fieldWidget() said that the value changed.
    int drag(const ecs::Field& field, std::byte* member, float pixels)
    {
        const FieldNames names{m_world, nullptr};
        int changes = 0;
        ImVec2 min{}, max{};
        const auto draw = [&] {
            changes += fieldWidget(field, member, names) ? 1 : 0;
            min = ImGui::GetItemRectMin();
            max = ImGui::GetItemRectMax();
        };
        frame(draw);
        drag(ImVec2{min.x + 12, 0.5f * (min.y + max.y)}, pixels, draw);
        return changes;
    }

    template <class Draw>
    void drag(ImVec2 from, float pixels, Draw&& draw)
    {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = from;
        frame(draw, 1); // long ago: no second click of a double click
        io.MouseDown[0] = true;
        frame(draw);
        for (int step = 0; step < 10; ++step) {
            io.MousePos.x += pixels / 10;
            frame(draw);
        }
        io.MouseDown[0] = false;
        frame(draw);
    }

    static const ecs::Field& field(std::string_view name)
    {
        ecs::registerComponents<Everything>();
        const ecs::Field* found =
            ecs::findField(static_cast<ecs::ComponentId>(ecs::findComponent("Everything")), name);
        EXPECT_NE(found, nullptr) << name;
        return *found;
    }

    ecs::World m_world;
};

template <class T>
std::byte* bytes(T& value)
{
    return reinterpret_cast<std::byte*>(&value);
}

TEST_F(Panel, ADragChangesANumberWithinItsRange)
{
    float power = 40;
    EXPECT_GT(drag(field("power"), bytes(power), 60), 0);
    EXPECT_GT(power, 50);
    EXPECT_LE(power, 100);
    EXPECT_GT(drag(field("power"), bytes(power), 4000), 0);
    EXPECT_EQ(power, 100);
    EXPECT_GT(drag(field("power"), bytes(power), -8000), 0);
    EXPECT_EQ(power, 0);
}

TEST_F(Panel, AClickChangesAFlag)
{
    bool lit = false;
    EXPECT_EQ(drag(field("lit"), bytes(lit), 0), 1);
    EXPECT_TRUE(lit);
}

TEST_F(Panel, ARotationStaysAUnitQuaternionAndTurnsAboutTheAxisThatIsDragged)
{
    vec4 rotation{0, 0, 0, 1};
    const int changes = drag(field("rotation"), bytes(rotation), 90); // the first number: about x
    EXPECT_GT(changes, 0);
    EXPECT_NEAR(length(rotation), 1, 1e-6);
    EXPECT_GT(rotation.x, 0.1f);
    EXPECT_NEAR(rotation.y, 0, 1e-5);
    EXPECT_NEAR(rotation.z, 0, 1e-5);
    // On past 90 degrees about y, where Euler angles turn over.
    rotation = {0, std::sin(0.7f), 0, std::cos(0.7f)};
    for (int i = 0; i < 20; ++i)
        drag(field("rotation"), bytes(rotation), 40);
    EXPECT_NEAR(length(rotation), 1, 1e-6);
}

TEST_F(Panel, HandlesAndEntitiesAreShownAndNotEdited)
{
    std::uint64_t body = 5;
    EXPECT_EQ(drag(field("body"), bytes(body), 50), 0);
    EXPECT_EQ(body, 5u);
    ecs::Entity target = m_world.create();
    const ecs::Entity before = target;
    EXPECT_EQ(drag(field("target"), bytes(target), 50), 0);
    EXPECT_EQ(target, before);
}

TEST_F(Panel, EveryComponentOfASceneHasItsWidgetsAndLookingChangesNothing)
{
    registerSceneComponents();
    AssetStore assets;
    Editor editor;
    const ecs::Entity parent = m_world.create(ecs::Name("base"));
    const ecs::Entity entity =
        m_world.create(ecs::Name("arm"), Transform{}, Material{}, MeshInstance{},
                       ShadowFieldOccluder{}, ShadowFieldEmitter{}, Camera{}, Everything{});
    ASSERT_TRUE(m_world.setParent(entity, parent));
    editor.select(entity);
    m_world.advance();
    const std::uint64_t before = m_world.version();
    int vertices = 0;
    for (int i = 0; i < 3; ++i) {
        frame([&] { editor.draw(m_world, assets); });
        vertices = ImGui::GetDrawData()->TotalVtxCount;
    }
    EXPECT_GT(vertices, 1000); // labels, boxes and numbers are there
    EXPECT_EQ(editor.selected(), entity);
    int changed = 0;
    m_world.query<const Transform, ecs::Changed<Transform>>()
        .since(before - 1)
        .each([&](const Transform&) { ++changed; });
    EXPECT_EQ(changed, 0);
}

TEST_F(Panel, AClickOnAnEntityInTheListSelectsItAndADestroyedOneIsForgotten)
{
    AssetStore assets;
    Editor editor;
    const ecs::Entity first = m_world.create(ecs::Name("first"));
    ImVec2 below{}; // the line under the list
    const auto draw = [&] {
        editor.draw(m_world, assets);
        below = ImGui::GetItemRectMin();
    };
    frame(draw);
    const float line = ImGui::GetTextLineHeightWithSpacing();
    drag({below.x + 20, below.y - ImGui::GetStyle().ItemSpacing.y - 9 * line +
                            ImGui::GetStyle().WindowPadding.y + 0.4f * line},
         0, draw);
    EXPECT_EQ(editor.selected(), first);
    m_world.destroy(first);
    frame(draw);
    EXPECT_EQ(editor.selected(), ecs::Entity{});
}

TEST_F(Panel, AnEditIsAChangeThatSystemsSee)
{
    const ecs::Entity entity = m_world.create(Material{});
    AssetStore assets;
    Editor editor;
    editor.select(entity);
    ImVec2 last{}; // the last field of the last component: glossExponent
    const auto draw = [&] {
        editor.draw(m_world, assets);
        last = ImGui::GetItemRectMin();
    };
    frame(draw);
    const std::uint64_t before = m_world.version();
    m_world.advance();
    drag({last.x + 12, last.y + 6}, 60, draw);
    EXPECT_GT(std::as_const(m_world).get<Material>(entity).glossExponent, 0);
    int changed = 0;
    m_world.query<const Material, ecs::Changed<Material>>().since(before).each(
        [&](const Material&) { ++changed; });
    EXPECT_EQ(changed, 1);
}

} // namespace
} // namespace penumbra
