#include "runtime/ecs/field_json.h"

#include "runtime/ecs/reflection.h"

#include <charconv>
#include <fmt/format.h>

namespace penumbra::ecs {

namespace {

// The double with the fewest digits that is this float: 0.1f is written 0.1.
double shortest(float value)
{
    std::array<char, 64> text;
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
    double number = 0;
    std::from_chars(text.data(), written.ptr, number);
    return static_cast<float>(number) == value ? number : static_cast<double>(value);
}

template <class T>
void store(const Field& field, T value, std::byte* member)
{
    const auto put = [&](auto narrow) { std::memcpy(member, &narrow, sizeof(narrow)); };
    if constexpr (std::is_floating_point_v<T>) {
        field.bytes == 8 ? put(value) : put(static_cast<float>(value));
    } else {
        if (field.bytes == 8)
            put(static_cast<uint64_t>(value));
        else if (field.bytes == 4)
            put(static_cast<uint32_t>(value));
        else if (field.bytes == 2)
            put(static_cast<uint16_t>(value));
        else
            put(static_cast<uint8_t>(value));
    }
}

Result<void> readNumbers(const Field& field, const Json& json, std::byte* member)
{
    const size_t count = field.bytes / sizeof(float);
    if (!json.is_array() || json.size() != count)
        return Error{fmt::format("is no array of {} numbers; write it as one", count)};
    for (size_t i = 0; i < count; ++i) {
        if (!json[i].is_number())
            return Error{fmt::format("has an element {} that is no number", i)};
        const auto number = static_cast<float>(json[i].get<double>());
        std::memcpy(member + i * sizeof(float), &number, sizeof(float));
    }
    return {};
}

Result<void> readWhole(const Field& field, const Json& json, std::byte* member)
{
    const uint32_t bits = 8 * field.bytes;
    if (field.type == FieldType::integer && json.is_number_integer()) {
        const bool tooLarge =
            json.is_number_unsigned() && json.get<uint64_t>() > uint64_t{INT64_MAX};
        const int64_t value = json.get<int64_t>();
        const int64_t least = bits == 64 ? INT64_MIN : -(int64_t{1} << (bits - 1));
        const int64_t most = bits == 64 ? INT64_MAX : (int64_t{1} << (bits - 1)) - 1;
        if (!tooLarge && value >= least && value <= most) {
            store(field, value, member);
            return {};
        }
    } else if (field.type == FieldType::natural && json.is_number_unsigned()) {
        const uint64_t value = json.get<uint64_t>();
        if (bits == 64 || value >> bits == 0) {
            store(field, value, member);
            return {};
        }
    }
    return Error{fmt::format("is no whole number of {} bits{}; write one", bits,
                             field.type == FieldType::natural ? ", 0 or more" : "")};
}

Result<void> readChoice(const Field& field, const Json& json, std::byte* member)
{
    std::string known;
    for (size_t i = 0; i < field.names.size(); ++i) {
        if (json.is_string() && json.get_ref<const std::string&>() == field.names[i]) {
            store(field, uint64_t{i}, member);
            return {};
        }
        known += (i == 0 ? "" : ", ") + std::string(field.names[i]);
    }
    return Error{"is none of: " + known + "; choose one"};
}

Result<void> readText(const Field& field, const Json& json, std::byte* member, std::string& warning)
{
    if (!json.is_string())
        return Error{"is no text; put it in quotes"};
    const std::string& text = json.get_ref<const std::string&>();
    if (text.find('\0') != std::string::npos)
        return Error{"has the character U+0000; remove it"};
    size_t length = text.size();
    if (length >= field.bytes) {
        length = field.bytes - 1;
        while (length > 0 && (static_cast<uint8_t>(text[length]) & 0xc0) == 0x80)
            --length; // not within a character
        warning = fmt::format("is longer than {} bytes and was cut", field.bytes - 1);
    }
    std::memset(member, 0, field.bytes);
    std::memcpy(member, text.data(), length);
    return {};
}

Result<void> readAsset(const Field& field, const Json& json, std::byte* member, AssetNames* assets)
{
    uint32_t handle = AssetNames::kNoAsset;
    if (!json.is_null()) {
        if (!json.is_string())
            return Error{"is no asset's name; write it in quotes, or null for none"};
        if (assets == nullptr)
            return Error{"names an asset, but nothing is here to look it up; load with AssetNames"};
        const Result<uint32_t> found = assets->handleOf(field, json.get<std::string>());
        if (!found)
            return fail(found.error(), "names an asset that is not to be had");
        handle = *found;
    }
    std::memcpy(member, &handle, sizeof(handle));
    return {};
}

} // namespace

Result<Json> fieldToJson(const Field& field, const std::byte* member, const FileNames& names)
{
    if (const std::string problem = fieldProblem(field, member); !problem.empty())
        return Error{problem};
    switch (field.type) {
    case FieldType::real:
        if (field.bytes == 8)
            return Json(readReal(field, member));
        return Json(shortest(static_cast<float>(readReal(field, member))));
    case FieldType::integer:
        return Json(readInteger(field, member));
    case FieldType::natural:
        return Json(readNatural(field, member));
    case FieldType::flag:
        return Json(*member != std::byte{0});
    case FieldType::vector:
    case FieldType::rotation: {
        Json list = Json::array();
        for (size_t i = 0; i < field.bytes / sizeof(float); ++i) {
            float number = 0;
            std::memcpy(&number, member + i * sizeof(float), sizeof(number));
            list.push_back(shortest(number));
        }
        return list;
    }
    case FieldType::entity: {
        Entity entity;
        std::memcpy(&entity, member, sizeof(entity));
        return names.entityJson(entity);
    }
    case FieldType::choice:
        return Json(field.names[readNatural(field, member)]);
    case FieldType::text:
        return Json(std::string(reinterpret_cast<const char*>(member)));
    case FieldType::asset: {
        uint32_t handle = 0;
        std::memcpy(&handle, member, sizeof(handle));
        if (handle == AssetNames::kNoAsset)
            return Json(nullptr);
        const std::string name =
            names.savedAssets == nullptr ? "" : names.savedAssets->nameOf(field, handle);
        if (name.empty() || !isUtf8(name))
            return Error{fmt::format("is the asset {}, which has no name in UTF-8; save with "
                                     "AssetNames that know it",
                                     handle)};
        return Json(name);
    }
    case FieldType::automatic:
        break;
    }
    return Json(nullptr);
}

Result<void> fieldFromJson(const Field& field, const Json& json, std::byte* member,
                           const FileNames& names, std::string& warning)
{
    Result<void> read;
    switch (field.type) {
    case FieldType::real:
        if (!json.is_number())
            return Error{"is no number; write one"};
        store(field, json.get<double>(), member);
        break;
    case FieldType::integer:
    case FieldType::natural:
        read = readWhole(field, json, member);
        break;
    case FieldType::flag:
        if (!json.is_boolean())
            return Error{"is neither true nor false; write one of them"};
        *member = std::byte{json.get<bool>()};
        break;
    case FieldType::vector:
    case FieldType::rotation:
        read = readNumbers(field, json, member);
        break;
    case FieldType::entity: {
        Entity entity;
        if (const std::string problem = names.readEntity(json, entity); !problem.empty())
            return Error{problem};
        std::memcpy(member, &entity, sizeof(entity));
        break;
    }
    case FieldType::choice:
        read = readChoice(field, json, member);
        break;
    case FieldType::text:
        read = readText(field, json, member, warning);
        break;
    case FieldType::asset:
        read = readAsset(field, json, member, names.assets);
        break;
    case FieldType::automatic:
        break;
    }
    if (!read)
        return read;
    if (const std::string problem = fieldProblem(field, member); !problem.empty())
        return Error{problem};
    return {};
}

} // namespace penumbra::ecs
