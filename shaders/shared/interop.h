// Lets one header compile as C++ and as GLSL 4.60. Every other file of shaders/shared includes this
// first.
//   PENUMBRA_FN         marks a function that both languages call
//   PENUMBRA_CONST      a compile-time constant
//   PENUMBRA_BEGIN/END  the namespace in C++, nothing in GLSL
// Shared functions take and return small structs by value, so that no other macro is needed; what a
// shader reads from buffers is passed in by the entry point, so that the maths knows no binding.
#ifndef PENUMBRA_SHADERS_SHARED_INTEROP_H
#define PENUMBRA_SHADERS_SHARED_INTEROP_H
#ifdef __cplusplus

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#define PENUMBRA_FN inline
#define PENUMBRA_CONST constexpr
#define PENUMBRA_BEGIN namespace penumbra {
#define PENUMBRA_END }

namespace penumbra {
using glm::clamp, glm::cross, glm::dot, glm::inversesqrt, glm::length, glm::max, glm::min, glm::mix,
    glm::normalize;
using glm::ivec2, glm::ivec3, glm::ivec4, glm::uvec2, glm::uvec3, glm::uvec4;
using glm::mat3, glm::mat4, glm::quat, glm::vec2, glm::vec3, glm::vec4;
using std::abs, std::cos, std::exp2, std::floor, std::log2, std::pow, std::sin, std::sqrt;
using uint = std::uint32_t;

inline uint floatBitsToUint(float value)
{
    return glm::floatBitsToUint(value);
}
inline float uintBitsToFloat(uint bits)
{
    return glm::uintBitsToFloat(bits);
}
} // namespace penumbra

#else

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_control_flow_attributes : require

#define PENUMBRA_FN
#define PENUMBRA_CONST const
#define PENUMBRA_BEGIN
#define PENUMBRA_END

#endif
#endif
