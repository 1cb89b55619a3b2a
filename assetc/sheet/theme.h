// Colours and distances that all contact sheets share.
#pragma once

#include "runtime/canvas.h"

namespace penumbra {

inline constexpr Color kBackground{22, 24, 28}, kPanel{33, 36, 42}, kLine{62, 66, 74},
    kText{222, 224, 228}, kFaintText{140, 146, 156}, kAccent{240, 176, 84}, kBar{98, 112, 136};
inline constexpr int kSheetWidth = 1296, kMargin = 32, kGap = 16;
inline constexpr int kLineHeight = 24; // of text at scale 2

} // namespace penumbra
