#include "assets/environment.h"
#include "tests/fuzz/targets.h"

namespace penumbra {

bool fuzzEnvironmentReader(FuzzInput bytes)
{
    const auto environment = decodeEnvironment(bytes);
    if (!environment)
        return false;
    const auto encoded = encodeEnvironment(*environment);
    PENUMBRA_ASSERT(encoded, "a decoded environment that is not encoded: {}",
                    encoded.error().message);
    const auto again = decodeEnvironment(*encoded);
    PENUMBRA_ASSERT(again && again->map == environment->map && again->sh6 == environment->sh6,
                    "a round trip that changes the environment");
    const double share = environmentEnergyShare(*environment, 4);
    PENUMBRA_ASSERT(!(share < 0), "energy share {}", share);
    return true;
}

} // namespace penumbra
