#include "demo/editor/field_widget.h"

#include "runtime/ecs/reflection.h"
#include "shaders/shared/interop.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <imgui.h>

namespace penumbra {

namespace {

using ecs::Field;
using ecs::FieldType;

constexpr float kDragPixels = 300; // over the whole range of a bounded field

bool isBounded(const Field& field)
{
    return std::isfinite(field.min) && std::isfinite(field.max);
}

// Change per pixel: a small range is crossed in kDragPixels, a large one is not.
float dragSpeed(const Field& field)
{
    const double range = field.max - field.min;
    return isBounded(field) && range <= 1000 ? static_cast<float>(range) / kDragPixels : 0.01f;
}

std::string label(const Field& field)
{
    return field.unit.empty() ? std::string(field.name)
                              : fmt::format("{} [{}]", field.name, field.unit);
}

bool realWidget(const Field& field, std::byte* member)
{
    const bool isDouble = field.bytes == sizeof(double);
    const double min = field.min, max = field.max;
    const float minFloat = static_cast<float>(min), maxFloat = static_cast<float>(max);
    return ImGui::DragScalar(
        label(field).c_str(), isDouble ? ImGuiDataType_Double : ImGuiDataType_Float, member,
        dragSpeed(field), isDouble ? static_cast<const void*>(&min) : &minFloat,
        isDouble ? static_cast<const void*>(&max) : &maxFloat, "%.4g",
        ImGuiSliderFlags_AlwaysClamp);
}

bool wholeWidget(const Field& field, std::byte* member)
{
    const bool isSigned = field.type == FieldType::integer;
    static constexpr std::array kSigned{ImGuiDataType_S8, ImGuiDataType_S16, ImGuiDataType_S32,
                                        ImGuiDataType_S64};
    static constexpr std::array kUnsigned{ImGuiDataType_U8, ImGuiDataType_U16, ImGuiDataType_U32,
                                          ImGuiDataType_U64};
    const auto size = static_cast<std::size_t>(std::countr_zero(field.bytes));
    return ImGui::InputScalar(label(field).c_str(), isSigned ? kSigned[size] : kUnsigned[size],
                              member);
}

bool vectorWidget(const Field& field, std::byte* member)
{
    auto* values = reinterpret_cast<float*>(member);
    const auto count = static_cast<int>(field.bytes / sizeof(float));
    if (count == 3 && field.min == 0 && field.max == 1) // a reflectance: linear, as it is stored
        return ImGui::ColorEdit3(label(field).c_str(), values, ImGuiColorEditFlags_Float);
    const float min = static_cast<float>(field.min), max = static_cast<float>(field.max);
    return ImGui::DragScalarN(label(field).c_str(), ImGuiDataType_Float, values, count,
                              dragSpeed(field), &min, &max, "%.4g", ImGuiSliderFlags_AlwaysClamp);
}

// As three angles about the world's axes. A drag turns about that axis from where the entity is, so
// there is no place where it gets stuck.
bool rotationWidget(const Field& field, std::byte* member)
{
    auto* values = reinterpret_cast<float*>(member);
    glm::quat rotation(values[3], values[0], values[1], values[2]);
    const vec3 shown = glm::degrees(glm::eulerAngles(rotation));
    vec3 degrees = shown;
    if (!ImGui::DragFloat3(fmt::format("{} [deg]", field.name).c_str(), &degrees.x, 0.5f, 0, 0,
                           "%.1f"))
        return false;
    const vec3 turn = glm::radians(degrees - shown);
    for (int axis = 0; axis < 3; ++axis) {
        vec3 about(0);
        about[axis] = 1;
        rotation = glm::angleAxis(turn[axis], about) * rotation;
    }
    rotation = glm::normalize(rotation);
    values[0] = rotation.x;
    values[1] = rotation.y;
    values[2] = rotation.z;
    values[3] = rotation.w;
    return true;
}

bool choiceWidget(const Field& field, std::byte* member)
{
    const std::uint64_t now = ecs::readNatural(field, member);
    bool changed = false;
    const std::string shown(now < field.names.size() ? field.names[now] : "?");
    if (!ImGui::BeginCombo(label(field).c_str(), shown.c_str()))
        return false;
    for (std::uint64_t i = 0; i < field.names.size(); ++i)
        if (ImGui::Selectable(std::string(field.names[i]).c_str(), i == now)) {
            std::memcpy(member, &i, field.bytes); // little-endian, as all that Vulkan runs on
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

std::string shownText(const Field& field, const std::byte* member, const FieldNames& names)
{
    if (field.type == FieldType::entity) {
        ecs::Entity entity;
        std::memcpy(&entity, member, sizeof(entity));
        return entity == ecs::Entity{} ? "none" : names.world.describe(entity);
    }
    const std::uint64_t handle = ecs::readNatural(field, member);
    return field.type == FieldType::asset && names.asset
               ? names.asset(field, static_cast<std::uint32_t>(handle))
               : fmt::format("{} {}", field.kind, handle);
}

bool edit(const Field& field, std::byte* member, const FieldNames& names)
{
    if (field.type == FieldType::entity || field.type == FieldType::asset || !field.kind.empty()) {
        ImGui::LabelText(label(field).c_str(), "%s", shownText(field, member, names).c_str());
        return false;
    }
    switch (field.type) {
    case FieldType::real:
        return realWidget(field, member);
    case FieldType::integer:
    case FieldType::natural:
        return wholeWidget(field, member);
    case FieldType::flag:
        return ImGui::Checkbox(label(field).c_str(), reinterpret_cast<bool*>(member));
    case FieldType::vector:
        return vectorWidget(field, member);
    case FieldType::rotation:
        return rotationWidget(field, member);
    case FieldType::choice:
        return choiceWidget(field, member);
    case FieldType::text:
        return ImGui::InputText(label(field).c_str(), reinterpret_cast<char*>(member), field.bytes);
    case FieldType::automatic:
    case FieldType::entity:
    case FieldType::asset:
        break;
    }
    return false;
}

} // namespace

bool fieldWidget(const Field& field, std::byte* member, const FieldNames& names)
{
    if (!edit(field, member, names))
        return false;
    const std::string problem = ecs::fieldProblem(field, member);
    if (problem.empty())
        return true;
    ImGui::TextColored({1, 0.5f, 0.4f, 1}, "%s %s", std::string(field.name).c_str(),
                       problem.c_str());
    return false;
}

} // namespace penumbra
