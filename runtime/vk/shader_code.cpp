#include "runtime/vk/shader_code.h"

#include "runtime/assert.h"

#include <map>

namespace penumbra {
namespace {

using Registry = std::map<std::string, std::span<const std::uint32_t>, std::less<>>;

// Filled before main() by generated code, read only afterwards.
Registry& registry()
{
    static Registry shaders;
    return shaders;
}

} // namespace

std::span<const std::uint32_t> shaderCode(std::string_view name)
{
    const auto found = registry().find(name);
    PENUMBRA_ASSERT(found != registry().end(), "no shader '{}' among: {}", name,
                    fmt::join(shaderNames(), ", "));
    return found->second;
}

std::vector<std::string> shaderNames()
{
    std::vector<std::string> names;
    for (const auto& [name, code] : registry())
        names.push_back(name);
    return names;
}

bool registerShaders(std::span<const EmbeddedShader> shaders)
{
    for (const EmbeddedShader& shader : shaders) {
        const bool isNew = registry().try_emplace(shader.name, shader.begin, shader.end).second;
        PENUMBRA_ASSERT(isNew, "two shaders are called '{}'", shader.name);
    }
    return true;
}

} // namespace penumbra
