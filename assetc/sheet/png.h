#pragma once

#include "runtime/canvas.h"

#include <cstddef>

namespace penumbra {

std::vector<std::byte> encodePng(const Canvas& canvas);

} // namespace penumbra
