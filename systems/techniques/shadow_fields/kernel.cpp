#include "systems/techniques/shadow_fields/kernel.h"

namespace penumbra {

std::string_view kernelName(Kernel kernel)
{
    return kernel == Kernel::Literal ? "literal" : "exact";
}

std::optional<Kernel> kernelFromName(std::string_view name)
{
    for (const Kernel kernel : {Kernel::Literal, Kernel::Exact})
        if (name == kernelName(kernel))
            return kernel;
    return std::nullopt;
}

} // namespace penumbra
