#include "demo/editor/editor.h"

#include "demo/editor/field_widget.h"
#include "runtime/ecs/reflection.h"

#include <fmt/format.h>
#include <imgui.h>
#include <vector>

namespace penumbra {

namespace {

std::string assetName(const AssetStore& assets, const ecs::Field& field, std::uint32_t handle)
{
    if (handle == AssetHandle{}.index)
        return "none";
    return field.kind == "environment" ? fmt::format("environment {}", handle)
                                       : assets.mesh({handle}).name;
}

// Its id, its name, and the first asset that its components name.
std::string listed(const ecs::World& world, const AssetStore& assets, ecs::Entity entity)
{
    std::string text = world.describe(entity);
    bool found = false;
    world.components(entity).forEach([&](ecs::ComponentId id) {
        for (const ecs::Field& field : ecs::componentInfo(id).fields)
            if (!found && field.type == ecs::FieldType::asset) {
                std::uint32_t handle = 0;
                ecs::readField(world, entity, id, field, &handle);
                text += "  " + assetName(assets, field, handle);
                found = true;
            }
    });
    return text;
}

} // namespace

void Editor::draw(ecs::World& world, const AssetStore& assets)
{
    if (m_selected != ecs::Entity{} && !world.alive(m_selected))
        m_selected = {};
    drawList(world, assets);
    if (m_selected != ecs::Entity{})
        drawComponents(world, assets);
    else
        ImGui::TextDisabled("select an entity to edit it");
}

void Editor::drawList(ecs::World& world, const AssetStore& assets)
{
    ImGui::InputTextWithHint("##filter", "part of a line below", m_filter, sizeof(m_filter));
    std::vector<ecs::Entity> shown;
    world.query<ecs::WithDisabled>().each([&](ecs::Entity entity) {
        if (m_filter[0] == 0 || listed(world, assets, entity).find(m_filter) != std::string::npos)
            shown.push_back(entity);
    });
    ImGui::SameLine();
    ImGui::Text("%zu of %u", shown.size(), world.count());
    if (ImGui::BeginChild("entities", {0, 9 * ImGui::GetTextLineHeightWithSpacing()}, true)) {
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(shown.size()));
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
                const ecs::Entity entity = shown[static_cast<std::size_t>(i)];
                if (ImGui::Selectable(listed(world, assets, entity).c_str(), entity == m_selected))
                    m_selected = entity;
            }
    }
    ImGui::EndChild();
}

void Editor::drawComponents(ecs::World& world, const AssetStore& assets) const
{
    const FieldNames names{world, [&](const ecs::Field& field, std::uint32_t handle) {
                               return assetName(assets, field, handle);
                           }};
    ImGui::PushItemWidth(0.55f * ImGui::GetContentRegionAvail().x);
    world.components(m_selected).forEach([&](ecs::ComponentId id) {
        const ecs::ComponentInfo& info = ecs::componentInfo(id);
        const std::string name(info.name);
        if (!info.isPlain() || info.fields.empty() ||
            !ImGui::CollapsingHeader(name.c_str(), ImGuiTreeNodeFlags_DefaultOpen))
            return;
        ImGui::PushID(name.c_str());
        ecs::ComponentValue value(id);
        ecs::readComponent(world, m_selected, id, value.data());
        bool changed = false;
        for (const ecs::Field& field : info.fields)
            changed |= fieldWidget(field, value.member(field), names);
        if (changed)
            ecs::writeComponent(world, m_selected, id, value.data());
        ImGui::PopID();
    });
    ImGui::PopItemWidth();
}

} // namespace penumbra
