// What receives light: --receivers of the demo, member "receivers" of its JSON.
#pragma once

#include <cstdint>
#include <string_view>

namespace penumbra {

enum class ReceiverKind : std::uint8_t {
    Vertex,   // vertices, between which the rasteriser interpolates; for dense meshes
    Pixel,    // pixels: also for meshes that are coarser than their shadows
    PixelHalf // a quarter of the pixels, and those that the others cannot stand for
};

constexpr std::string_view receiverKindName(ReceiverKind kind)
{
    return kind == ReceiverKind::Vertex  ? "vertex"
           : kind == ReceiverKind::Pixel ? "pixel"
                                         : "pixel-half";
}

// Of its name.
constexpr ReceiverKind receiverKindFromName(std::string_view name)
{
    return name == "pixel"        ? ReceiverKind::Pixel
           : name == "pixel-half" ? ReceiverKind::PixelHalf
                                  : ReceiverKind::Vertex;
}

} // namespace penumbra
