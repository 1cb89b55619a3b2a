// Private to scene files: one member of a component to JSON and back.
#pragma once

#include "runtime/ecs/json_text.h"
#include "runtime/ecs/scene_file.h"

#include <functional>

namespace penumbra::ecs {

// What entities and assets are called in a file.
struct FileNames {
    std::function<Json(Entity)> entityJson;
    std::function<std::string(const Json&, Entity&)> readEntity; // returns the problem, or empty
    AssetNames* assets = nullptr;
    const AssetNames* savedAssets = nullptr;
};

// An Error has the problem, not the place.
Result<Json> fieldToJson(const Field& field, const std::byte* member, const FileNames& names);
// Writes `member` where it fits. `warning` gets what was changed in the value.
Result<void> fieldFromJson(const Field& field, const Json& json, std::byte* member,
                           const FileNames& names, std::string& warning);

} // namespace penumbra::ecs
