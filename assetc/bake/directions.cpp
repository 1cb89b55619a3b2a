#include "assetc/bake/directions.h"

#include "runtime/assert.h"

namespace penumbra {

std::vector<vec3> bakeDirections(std::uint32_t count)
{
    PENUMBRA_ASSERT(count % 2 == 0, "{} directions: antipodal pairs need an even number", count);
    const std::uint32_t half = count / 2;
    const double goldenAngle = 2.399963229728653; // pi (3 - sqrt 5)
    std::vector<vec3> directions(count);
    for (std::uint32_t i = 0; i < half; ++i) {
        const double z = 1 - (i + 0.5) / half;
        const double s = std::sqrt(1 - z * z), phi = goldenAngle * i;
        directions[i] = vec3(s * std::cos(phi), s * std::sin(phi), z);
        directions[half + i] = -directions[i];
    }
    return directions;
}

} // namespace penumbra
