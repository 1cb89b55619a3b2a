// The shells of a field for the eye: what each says, and how far it is from the truth.
#pragma once

#include "assetc/embree_scene.h"
#include "assets/shadow_field.h"
#include "runtime/canvas.h"

namespace penumbra {

class Shells {
public:
    explicit Shells(const ShadowField& field); // keeps a reference; the first frame

    // The octahedral map of a shell at its own side, a square per node: mean visibility from black
    // 0 to white 1, grey = 1 - sqrt(blocked part); of a radiance field, mean radiance over the
    // brightest of the shell.
    [[nodiscard]] Canvas draw(std::size_t shell, int size) const;

    struct Range {
        float low = 0, high = 0;
    };
    // Of what `draw` shows: visibility, or the luminance in W/(m² sr).
    [[nodiscard]] Range range(std::size_t shell) const;

    // Rms error of an occlusion field at random points of a shell, against rays in as many
    // directions as the bake had; unit: visibility. Negative where all points see nothing.
    [[nodiscard]] float tracedError(std::size_t shell, const EmbreeScene& scene) const;

private:
    [[nodiscard]] const std::uint8_t* texel(std::size_t channel, std::size_t shell, std::size_t x,
                                            std::size_t y) const;
    [[nodiscard]] vec3 mean(std::size_t shell, std::size_t x, std::size_t y) const;

    const ShadowField& m_field;
    std::size_t m_side;
    std::vector<std::vector<std::uint8_t>> m_texels; // [channel], of refineField
};

// About `count` shells spread from the first to the last; one that is left out is among them where
// there is one.
std::vector<std::size_t> shellsToShow(const ShadowField& field, std::size_t count);

} // namespace penumbra
