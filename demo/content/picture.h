// The picture that the demo's flat light shows.
#pragma once

#include "demo/image/image.h"

namespace penumbra {

// Stained glass: 8 x 5 panes of saturated colours between dark leads, 160 x 100 pixels; the same
// bytes on every run.
Image8 makePicture();

} // namespace penumbra
