// Private to scene files: untrusted JSON text to a document, and places in it.
#pragma once

#include "runtime/result.h"

#include <nlohmann/json.hpp>
#include <string_view>

namespace penumbra::ecs {

using Json = nlohmann::ordered_json; // members stay in the order of the file

// A JSON pointer as a list on the stack: text is made only for messages.
struct JsonPlace {
    const JsonPlace* parent = nullptr;
    std::string_view key; // of a member
    size_t index = 0;     // of an element, where the key is empty
    bool element = false;

    [[nodiscard]] JsonPlace operator/(std::string_view member) const { return {this, member}; }
    [[nodiscard]] JsonPlace at(size_t i) const { return {this, {}, i, true}; }
    [[nodiscard]] std::string text() const; // "/entities/3/Parent"
};

// Bounded in size, nesting and members per object (scene_file.h); a member that stands twice is
// refused. The error names the place, or line and column.
Result<Json> parseSceneJson(std::string_view text);

} // namespace penumbra::ecs
