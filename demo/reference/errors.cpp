#include "demo/reference/errors.h"

#include "runtime/assert.h"

#include <algorithm>

namespace penumbra {

RadianceErrors compareRadiance(std::span<const vec3> test, std::span<const vec3> truth,
                               std::span<const vec3> unshadowed)
{
    PENUMBRA_ASSERT(test.size() == truth.size() && truth.size() == unshadowed.size(),
                    "{}, {}, {} receivers", test.size(), truth.size(), unshadowed.size());
    RadianceErrors errors;
    if (test.empty())
        return errors;
    double squares = 0.0;
    for (std::size_t i = 0; i < test.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double difference = static_cast<double>(test[i][c]) - truth[i][c];
            squares += difference * difference;
            errors.bias += difference;
            errors.maxAbs = std::max(errors.maxAbs, std::abs(difference));
            errors.meanUnshadowed += unshadowed[i][c];
        }
    }
    const double count = 3.0 * static_cast<double>(test.size());
    errors.rmse = std::sqrt(squares / count);
    errors.bias /= count;
    errors.meanUnshadowed /= count;
    errors.rmseRelative = errors.meanUnshadowed > 0.0 ? errors.rmse / errors.meanUnshadowed : 0.0;
    return errors;
}

std::vector<float> errorPerReceiver(std::span<const vec3> test, std::span<const vec3> truth)
{
    PENUMBRA_ASSERT(test.size() == truth.size(), "{}, {} receivers", test.size(), truth.size());
    std::vector<float> errors(test.size());
    for (std::size_t i = 0; i < test.size(); ++i) {
        const vec3 difference = test[i] - truth[i];
        errors[i] = sqrt(dot(difference, difference) / 3.0f);
    }
    return errors;
}

} // namespace penumbra
