#include "tests/support/spirv_offsets.h"

#include "runtime/assert.h"

#include <map>
#include <set>

namespace penumbra {
namespace {

// Opcodes and decorations: SPIR-V 1.6 specification, sections 3.42 and 3.20.
enum Opcode : std::uint32_t {
    kOpName = 5,
    kOpMemberName = 6,
    kOpTypeArray = 28,
    kOpTypeRuntimeArray = 29,
    kOpDecorate = 71,
    kOpMemberDecorate = 72,
};
constexpr std::uint32_t kArrayStride = 6;
constexpr std::uint32_t kOffset = 35;
constexpr std::uint32_t kMagic = 0x07230203;
constexpr std::size_t kHeaderWords = 5;

struct Module {
    std::map<std::uint32_t, std::string> names;                              // by type id
    std::map<std::uint32_t, std::map<std::uint32_t, SpirvMember>> members;   // by type, by index
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> offsets; // likewise
    std::map<std::uint32_t, std::uint32_t> strides;                          // by array type id
    std::map<std::uint32_t, std::uint32_t> elements; // array -> element type
};

// A string literal: bytes, little-endian, null-terminated inside its words.
std::string literal(std::span<const std::uint32_t> words)
{
    std::string text;
    for (const std::uint32_t word : words)
        for (int shift = 0; shift < 32; shift += 8) {
            const char c = static_cast<char>(word >> shift & 0xff);
            if (c == 0)
                return text;
            text += c;
        }
    return text;
}

Module parse(std::span<const std::uint32_t> code)
{
    PENUMBRA_ASSERT(code.size() >= kHeaderWords && code[0] == kMagic, "SPIR-V words");
    Module module;
    for (std::size_t at = kHeaderWords; at < code.size();) {
        const std::uint32_t length = code[at] >> 16;
        const std::uint32_t opcode = code[at] & 0xffff;
        PENUMBRA_ASSERT(length > 0 && length <= code.size() - at, "SPIR-V word {}", at);
        const std::span<const std::uint32_t> args = code.subspan(at + 1, length - 1);
        if (opcode == kOpName)
            module.names[args[0]] = literal(args.subspan(1));
        else if (opcode == kOpMemberName)
            module.members[args[0]][args[1]].name = literal(args.subspan(2));
        else if (opcode == kOpMemberDecorate && args[2] == kOffset)
            module.offsets[args[0]][args[1]] = args[3];
        else if (opcode == kOpDecorate && args[1] == kArrayStride)
            module.strides[args[0]] = args[2];
        else if (opcode == kOpTypeArray || opcode == kOpTypeRuntimeArray)
            module.elements[args[0]] = args[1];
        at += length;
    }
    return module;
}

} // namespace

std::optional<std::uint32_t> SpirvStruct::offset(std::string_view member) const
{
    for (const SpirvMember& m : members)
        if (m.name == member)
            return m.offset;
    return std::nullopt;
}

SpirvStruct spirvStruct(std::span<const std::uint32_t> code, std::string_view name)
{
    const Module module = parse(code);
    for (const auto& [type, offsets] : module.offsets) {
        const auto typeName = module.names.find(type);
        if (typeName == module.names.end() || typeName->second != name)
            continue;
        SpirvStruct result;
        for (const auto& [index, offset] : offsets)
            result.members.push_back({module.members.at(type).at(index).name, offset});
        for (const auto& [array, element] : module.elements)
            if (element == type && module.strides.contains(array))
                result.arrayStride = module.strides.at(array);
        return result;
    }
    return {};
}

std::vector<std::string> spirvStructNames(std::span<const std::uint32_t> code)
{
    const Module module = parse(code);
    std::set<std::string> names;
    for (const auto& [type, offsets] : module.offsets)
        if (module.names.contains(type))
            names.insert(module.names.at(type));
    return {names.begin(), names.end()};
}

} // namespace penumbra
