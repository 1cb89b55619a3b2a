// How far a field is from the exact one, by cause.
#pragma once

#include "assetc/bake/field_samples.h"
#include "assetc/bake/probes.h"

namespace penumbra {

// `samples`: the adapted field before it became bytes; `field`: those bytes. A probe counts where
// its three points see something. The causes:
//   total         trilinear, as a reader samples the bytes, at the probe
//   angular       bilinear in the samples of a shell, on that shell in the probe's direction;
//                 includes what adaptation took away
//   radial        linear between the exact values on the two shells, at the probe; shells that
//                 adaptation left out count as there: their loss is in `angular`
//   quantisation  bytes against samples, at the probe
//   directions    half the difference between the fields of every other direction: what the other
//                 causes cannot know, since their exact values have the same directions
//   bandLimit     the blocked directions are a function B of 0 and 1, so |B|² = ∫B, and its part
//                 beyond order 4 is |B|² - sum b_i²; where far cells are blocked in part, |B|² is
//                 that of the directions, not of the cells
FieldErrors measureErrors(const FieldSamples& samples, const ShadowField& field,
                          const std::vector<Probe>& probes);

// The same of a radiance field with one frame, `probes` [point][channel] in order of the channels,
// with the radiance itself in `exact`, `low` and `high`. All points count. Errors are the root mean
// square over directions and channels as a part of `radiance` g(r), > 0 (see AdaptLimit). Lights
// end where their last shell is, so the fade that readers make of the last interval is none of
// `total`. `bandLimit` is not known and stays 0.
FieldErrors measureRadianceErrors(const FieldSamples& samples, const ShadowField& field,
                                  const std::vector<Probe>& probes, float radiance);

} // namespace penumbra
